// The node: takes the cloud of a supporter and the mesh of an object, gives poses and a path.
#ifndef HANGPOSE_ROS_HANG_NODE_HPP
#define HANGPOSE_ROS_HANG_NODE_HPP

#include <geometry_msgs/msg/pose_array.hpp>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <hangpose/ros2.hpp>
#include <nav_msgs/msg/path.hpp>
#include <optional>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <shape_msgs/msg/mesh.hpp>
#if __has_include(<tf2_ros/buffer.hpp>)
#include <tf2_ros/buffer.hpp>
#include <tf2_ros/transform_listener.hpp>
#else
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#endif
#include <vector>

#include "settings.hpp"

namespace hangpose_ros {

class HangNode : public rclcpp::Node {
 public:
  // Throws std::invalid_argument if a parameter is wrong or the object cannot be analysed.
  explicit HangNode(const rclcpp::NodeOptions &options = rclcpp::NodeOptions());

 private:
  void take_object(const shape_msgs::msg::Mesh &message);
  void take_cloud(const sensor_msgs::msg::PointCloud2 &message);
  // The placement of the frame `from` in the frame `to`, or nothing, which is logged.
  std::optional<hangpose::ros2::placement> look_up(const std::string &to, const std::string &from,
                                                   const builtin_interfaces::msg::Time &stamp);
  hangpose::result<hangpose::done> hang(const sensor_msgs::msg::PointCloud2 &message);
  void publish(const std_msgs::msg::Header &header, const hangpose::prediction &found);
  void say(const hangpose::error &why);

  Settings settings_;
  std::vector<hangpose::pose> poses_;
  std::vector<hangpose::waypoint> waypoints_;
  std::optional<hangpose::object> object_;
  std::optional<rclcpp::Time> last_;

  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  rclcpp::Publisher<geometry_msgs::msg::PoseArray>::SharedPtr poses_publisher_;
  rclcpp::Publisher<geometry_msgs::msg::PoseStamped>::SharedPtr best_publisher_;
  rclcpp::Publisher<nav_msgs::msg::Path>::SharedPtr path_publisher_;
  rclcpp::Subscription<shape_msgs::msg::Mesh>::SharedPtr object_subscription_;
  rclcpp::Subscription<sensor_msgs::msg::PointCloud2>::SharedPtr cloud_subscription_;
};

}  // namespace hangpose_ros

#endif
