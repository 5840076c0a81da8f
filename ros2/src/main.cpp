#include <cstdio>
#include <exception>
#include <memory>

#include "hang_node.hpp"

int main(int count, char **arguments) {
  rclcpp::init(count, arguments);
  try {
    rclcpp::spin(std::make_shared<hangpose_ros::HangNode>());
  } catch (const std::exception &why) {
    std::fprintf(stderr, "hang_node: %s\n", why.what());
    rclcpp::shutdown();
    return 1;
  }
  rclcpp::shutdown();
  return 0;
}
