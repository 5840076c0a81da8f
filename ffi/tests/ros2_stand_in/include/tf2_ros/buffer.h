// Stands for tf2_ros: a buffer whose transforms the test sets.
#ifndef STAND_IN_TF2_ROS_BUFFER_H
#define STAND_IN_TF2_ROS_BUFFER_H

#include <map>
#include <rclcpp/rclcpp.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace tf2 {
class TransformException : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
}  // namespace tf2

namespace tf2_ros {
class Buffer {
 public:
  explicit Buffer(rclcpp::Clock::SharedPtr) {}
  geometry_msgs::msg::TransformStamped lookupTransform(const std::string &target, const std::string &source,
                                                       const rclcpp::Time &, const rclcpp::Duration &) const {
    const auto found = transforms().find({target, source});
    if (found == transforms().end())
      throw tf2::TransformException("\"" + source + "\" does not exist in \"" + target + "\"");
    return found->second;
  }
  // Set by the test.
  static std::map<std::pair<std::string, std::string>, geometry_msgs::msg::TransformStamped> &transforms() {
    static std::map<std::pair<std::string, std::string>, geometry_msgs::msg::TransformStamped> all;
    return all;
  }
};
}  // namespace tf2_ros

#endif
