// The parameters of the node.
#ifndef HANGPOSE_ROS_SETTINGS_HPP
#define HANGPOSE_ROS_SETTINGS_HPP

#include <hangpose.hpp>
#include <rclcpp/rclcpp.hpp>
#include <string>
#include <vector>

namespace hangpose_ros {

// Values of the parameters, read once when the node starts. config/hang_node.yaml describes them.
struct Settings {
  // Declares the parameters and reads them. Throws std::invalid_argument with a sentence on how to mend it if
  // one is wrong.
  explicit Settings(rclcpp::Node &node);

  std::string object_file;
  std::string frame, sensor_frame;
  double transform_timeout = 0.0, min_period = 0.0;
  std::size_t poses = 0;
  bool has_path = false;
  hangpose::params params;
  // Points and boxes of the request are in the arrays below.
  hangpose::request request;
  hangpose::motion motion;
  bool has_region = false;
  hangpose::box region{};

  Settings(const Settings &) = delete;
  Settings &operator=(const Settings &) = delete;

 private:
  hangpose::vec3 here_{}, by_{};
};

}  // namespace hangpose_ros

#endif
