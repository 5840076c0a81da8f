// Stands for the C++ headers that ROS 2 generates from its message definitions: the same names, fields, types
// and initial values, in the same order. Only what hangpose/ros2.hpp and the node in ros2/ use is here.
#ifndef STAND_IN_MESSAGES_HPP
#define STAND_IN_MESSAGES_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace builtin_interfaces::msg {
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
struct Duration {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
}  // namespace builtin_interfaces::msg

namespace std_msgs::msg {
struct Header {
  builtin_interfaces::msg::Time stamp;
  std::string frame_id;
};
struct ColorRGBA {
  float r = 0, g = 0, b = 0, a = 0;
};
}  // namespace std_msgs::msg

namespace geometry_msgs::msg {
struct Point {
  double x = 0, y = 0, z = 0;
};
struct Vector3 {
  double x = 0, y = 0, z = 0;
};
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
struct Pose {
  Point position;
  Quaternion orientation;
};
struct PoseStamped {
  std_msgs::msg::Header header;
  Pose pose;
};
struct PoseArray {
  std_msgs::msg::Header header;
  std::vector<Pose> poses;
};
struct Transform {
  Vector3 translation;
  Quaternion rotation;
};
struct TransformStamped {
  std_msgs::msg::Header header;
  std::string child_frame_id;
  Transform transform;
};
struct Twist {
  Vector3 linear, angular;
};
}  // namespace geometry_msgs::msg

namespace nav_msgs::msg {
struct Path {
  std_msgs::msg::Header header;
  std::vector<geometry_msgs::msg::PoseStamped> poses;
};
}  // namespace nav_msgs::msg

namespace trajectory_msgs::msg {
struct MultiDOFJointTrajectoryPoint {
  std::vector<geometry_msgs::msg::Transform> transforms;
  std::vector<geometry_msgs::msg::Twist> velocities, accelerations;
  builtin_interfaces::msg::Duration time_from_start;
};
struct MultiDOFJointTrajectory {
  std_msgs::msg::Header header;
  std::vector<std::string> joint_names;
  std::vector<MultiDOFJointTrajectoryPoint> points;
};
}  // namespace trajectory_msgs::msg

namespace sensor_msgs::msg {
struct PointField {
  static constexpr std::uint8_t INT8 = 1, UINT8 = 2, INT16 = 3, UINT16 = 4, INT32 = 5, UINT32 = 6,
                                FLOAT32 = 7, FLOAT64 = 8;
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
};
struct PointCloud2 {
  std_msgs::msg::Header header;
  std::uint32_t height = 0, width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = false;
};
}  // namespace sensor_msgs::msg

namespace shape_msgs::msg {
struct MeshTriangle {
  std::array<std::uint32_t, 3> vertex_indices{};
};
struct Mesh {
  std::vector<MeshTriangle> triangles;
  std::vector<geometry_msgs::msg::Point> vertices;
};
}  // namespace shape_msgs::msg

namespace visualization_msgs::msg {
struct Marker {
  static constexpr std::int32_t CUBE = 1, TRIANGLE_LIST = 11;
  std_msgs::msg::Header header;
  std::string ns;
  std::int32_t id = 0, type = 0, action = 0;
  geometry_msgs::msg::Pose pose;
  geometry_msgs::msg::Vector3 scale;
  std_msgs::msg::ColorRGBA color;
  builtin_interfaces::msg::Duration lifetime;
  bool frame_locked = false;
  std::vector<geometry_msgs::msg::Point> points;
  std::vector<std_msgs::msg::ColorRGBA> colors;
};
}  // namespace visualization_msgs::msg

#endif
