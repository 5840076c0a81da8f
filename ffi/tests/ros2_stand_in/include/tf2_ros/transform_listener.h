// Stands for tf2_ros: see buffer.h.
#ifndef STAND_IN_TF2_ROS_TRANSFORM_LISTENER_H
#define STAND_IN_TF2_ROS_TRANSFORM_LISTENER_H

#include "buffer.h"

namespace tf2_ros {
class TransformListener {
 public:
  explicit TransformListener(Buffer &) {}
};
}  // namespace tf2_ros

#endif
