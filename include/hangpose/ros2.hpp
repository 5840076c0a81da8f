// hangpose for ROS 2: conversions between messages and the types of hangpose.hpp. Header-only; throws nothing
// of its own and needs neither exceptions nor RTTI. It includes no header of ROS, because each function takes
// or makes any type with the fields of the message that its comment names.
//
//   auto cloud = hangpose::ros2::cloud_points::create(point_cloud2);
//   auto supporter = hangpose::supporter::create({cloud->points(), cloud->normals()}, params);
//   auto best = hangpose::ros2::to_pose_stamped<geometry_msgs::msg::PoseStamped>(point_cloud2.header,
//   poses[0]);
//
// Units and frames are those of REP 103 and of hangpose.h alike: metres, radians, right-handed, quaternions
// x, y, z, w. What a conversion from a pose gives is in supporter coordinates: in the frame of the cloud,
// whose header the message takes. ros2/ is a node that uses all of this.
#ifndef HANGPOSE_ROS2_HPP
#define HANGPOSE_ROS2_HPP

#include <cmath>
#include <cstring>
#include <limits>

#include "hangpose.hpp"

namespace hangpose {
namespace ros2 {

// A position, metres, and the rotation from one frame to another.
struct placement {
  vec3 position{};
  quaternion rotation{{0.0f, 0.0f, 0.0f, 1.0f}};
};

namespace internal {

// sensor_msgs/PointField.FLOAT32 and FLOAT64, and visualization_msgs/Marker.TRIANGLE_LIST.
inline constexpr int float32 = 7, float64 = 8, triangle_list = 11;

// Greatest difference between 1 and the length of a quaternion that is a rotation.
inline constexpr double unit_tolerance = 1e-3;

// An error at an element of an array, with the value that is wrong.
inline error error_at(hangpose_status status, const char *field, const char *message, std::size_t index,
                      double value) noexcept {
  error made = error::of(status, field, message);
  made.out()->index = hangpose::internal::count(index);
  made.out()->value = value;
  return made;
}

// The nearest float. What no float can hold becomes the greatest one, so that the library reports it.
inline float to_float(double value) noexcept {
  constexpr double most = std::numeric_limits<float>::max();
  if (std::isfinite(value) && std::fabs(value) > most) value = value > 0.0 ? most : -most;
  return static_cast<float>(value);
}

// A geometry_msgs/Point or Vector3.
template <class Point>
vec3 to_vec3(const Point &at) noexcept {
  return {to_float(at.x), to_float(at.y), to_float(at.z)};
}

inline bool is_finite(const vec3 &at) noexcept {
  return std::isfinite(at[0]) && std::isfinite(at[1]) && std::isfinite(at[2]);
}

// v rotated by q: v + 2 w (u x v) + 2 u x (u x v), where u is the vector part of q.
inline vec3 rotate(const quaternion &q, const vec3 &v) noexcept {
  const float tx = 2.0f * (q[1] * v[2] - q[2] * v[1]);
  const float ty = 2.0f * (q[2] * v[0] - q[0] * v[2]);
  const float tz = 2.0f * (q[0] * v[1] - q[1] * v[0]);
  return {v[0] + q[3] * tx + (q[1] * tz - q[2] * ty), v[1] + q[3] * ty + (q[2] * tx - q[0] * tz),
          v[2] + q[3] * tz + (q[0] * ty - q[1] * tx)};
}

template <class Point, class Quaternion>
result<placement> placement_of(const Point &at, const Quaternion &turned) noexcept {
  placement made;
  made.position = to_vec3(at);
  if (!is_finite(made.position)) {
    return error::of(HANGPOSE_ERROR_VALUE, "position", "the position is not finite: pass numbers of metres");
  }
  const double x = turned.x, y = turned.y, z = turned.z, w = turned.w;
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(std::fabs(length - 1.0) <= unit_tolerance)) {
    return error_at(HANGPOSE_ERROR_VALUE, "orientation",
                    "the quaternion has not the length 1: set x, y, z, w of a rotation, such as 0, 0, 0, 1",
                    HANGPOSE_NO_INDEX, length);
  }
  made.rotation = {to_float(x / length), to_float(y / length), to_float(z / length), to_float(w / length)};
  return made;
}

// Where a number of each point of a sensor_msgs/PointCloud2 is.
struct scalar {
  std::size_t offset = 0;
  bool is_double = false;
  bool is_there = false;
};

// Finds the field `name`; is_there is false if the cloud has none.
template <class PointCloud2>
result<scalar> find_scalar(const PointCloud2 &message, const char *name) noexcept {
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const auto &field = message.fields[i];
    if (std::strcmp(field.name.c_str(), name) != 0) continue;
    if (field.datatype != float32 && field.datatype != float64) {
      return error_at(HANGPOSE_ERROR_VALUE, "cloud.fields.datatype",
                      "a coordinate or normal is not of floating-point numbers: publish FLOAT32 or FLOAT64, "
                      "metres",
                      i, field.datatype);
    }
    // Some drivers leave the count of a single number at 0.
    if (field.count > 1) {
      return error_at(HANGPOSE_ERROR_COUNT, "cloud.fields.count",
                      "a coordinate or normal is an array: publish x, y and z as fields of one number each",
                      i, field.count);
    }
    const bool is_double = field.datatype == float64;
    if (std::uint64_t{field.offset} + (is_double ? 8u : 4u) > message.point_step) {
      return error_at(HANGPOSE_ERROR_VALUE, "cloud.fields.offset",
                      "a field ends after its point: correct its offset or point_step", i, field.offset);
    }
    return scalar{field.offset, is_double, true};
  }
  return scalar{};
}

// Finds three fields: all or none.
template <class PointCloud2>
result<std::array<scalar, 3>> find_row(const PointCloud2 &message, const char *const (&names)[3],
                                       const char *incomplete) noexcept {
  std::array<scalar, 3> row;
  for (std::size_t i = 0; i < 3; ++i) {
    auto found = find_scalar(message, names[i]);
    if (!found) return found.error();
    row[i] = *found;
  }
  if (row[0].is_there != row[1].is_there || row[0].is_there != row[2].is_there)
    return error::of(HANGPOSE_ERROR_VALUE, "cloud.fields", incomplete);
  return std::array<scalar, 3>(row);
}

// The number at `bytes`, whatever the byte order of this machine.
inline float number_at(const unsigned char *bytes, bool is_double, bool is_big_endian) noexcept {
  const std::size_t size = is_double ? 8 : 4;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) bits = bits << 8 | bytes[is_big_endian ? i : size - 1 - i];
  if (is_double) {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return to_float(value);
  }
  const auto low = static_cast<std::uint32_t>(bits);
  float value;
  std::memcpy(&value, &low, sizeof value);
  return value;
}

inline vec3 row_at(const unsigned char *point, const std::array<scalar, 3> &row,
                   bool is_big_endian) noexcept {
  vec3 made{};
  for (std::size_t i = 0; i < 3; ++i)
    made[i] = number_at(point + row[i].offset, row[i].is_double, is_big_endian);
  return made;
}

// Sets a geometry_msgs/Point or Vector3 and a Quaternion.
template <class Point, class Quaternion>
void set(Point &at, Quaternion &turned, const float (&position)[3], const float (&rotation)[4]) noexcept {
  at.x = position[0];
  at.y = position[1];
  at.z = position[2];
  turned.x = rotation[0];
  turned.y = rotation[1];
  turned.z = rotation[2];
  turned.w = rotation[3];
}

// Adds seconds to a builtin_interfaces/Time or Duration, whose nanoseconds stay within 0 and 999999999.
template <class Time>
void add_seconds(Time &time, float seconds) noexcept {
  constexpr std::int64_t second = 1000000000;
  const std::int64_t sum = std::int64_t{time.nanosec} + std::llround(double{seconds} * double{second});
  std::int64_t whole = sum / second, rest = sum % second;
  if (rest < 0) whole -= 1, rest += second;
  time.sec = static_cast<std::int32_t>(time.sec + whole);
  time.nanosec = static_cast<std::uint32_t>(rest);
}

}  // namespace internal

// The placement of a geometry_msgs/Pose, such as the one for hangpose::motion::start_at.
template <class Pose>
result<placement> from_pose(const Pose &message) noexcept {
  return internal::placement_of(message.position, message.orientation);
}

// The placement of a geometry_msgs/Transform. The position of that from a camera is a viewpoint.
template <class Transform>
result<placement> from_transform(const Transform &message) noexcept {
  return internal::placement_of(message.translation, message.rotation);
}

// The points of a sensor_msgs/PointCloud2, and their normals if it has the fields normal_x, normal_y and
// normal_z, in memory from the heap that it owns: the cloud of a supporter.
class cloud_points {
 public:
  // Copies the points that have a position. Points whose x, y or z is NaN or infinite, as a camera marks
  // pixels without depth, are dropped. A normal that is not finite becomes zero, which marks it as unknown.
  template <class PointCloud2>
  static result<cloud_points> create(const PointCloud2 &message) noexcept {
    const auto at = internal::find_row(message, {"x", "y", "z"}, "of x, y and z one or two are missing");
    if (!at) return at.error();
    if (!(*at)[0].is_there) {
      return error::of(HANGPOSE_ERROR_VALUE, "cloud.fields",
                       "the cloud has no fields x, y and z: publish the positions of the points");
    }
    const auto facing =
        internal::find_row(message, {"normal_x", "normal_y", "normal_z"},
                           "of normal_x, normal_y and normal_z one or two are missing: publish "
                           "all three, or none");
    if (!facing) return facing.error();
    const bool has_normals = (*facing)[0].is_there;

    // A width and a height below 2^32 keep every product below 2^64, but the sum of a row and all others not.
    const std::uint64_t row_bytes = std::uint64_t{message.width} * message.point_step;
    const std::uint64_t count = std::uint64_t{message.width} * message.height;
    if (message.height > 1 && message.row_step < row_bytes) {
      return internal::error_at(HANGPOSE_ERROR_VALUE, "cloud.row_step",
                                "the rows overlap: set row_step to width * point_step, or more with padding",
                                HANGPOSE_NO_INDEX, message.row_step);
    }
    const std::uint64_t before_last =
        message.height > 1 ? std::uint64_t{message.row_step} * (message.height - 1) : 0;
    if (count != 0 && (message.data.size() < row_bytes || message.data.size() - row_bytes < before_last)) {
      return internal::error_at(
          HANGPOSE_ERROR_COUNT, "cloud.data",
          "the data are shorter than height rows of width points: the message is cut off", HANGPOSE_NO_INDEX,
          static_cast<double>(message.data.size()));
    }

    cloud_points made;
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(vec3))
      return hangpose::internal::no_memory();
    const auto room = static_cast<std::size_t>(count) * sizeof(vec3);
    made.points_ = memory::own(room);
    made.normals_ = memory::own(has_normals ? room : 0);
    if (made.points_.data() == nullptr || made.normals_.data() == nullptr)
      return hangpose::internal::no_memory();
    auto *points = static_cast<vec3 *>(made.points_.data());
    auto *normals = static_cast<vec3 *>(made.normals_.data());
    const bool is_big_endian = message.is_bigendian;
    std::size_t kept = 0;
    for (std::size_t row = 0; row < message.height; ++row) {
      for (std::size_t column = 0; column < message.width; ++column) {
        const unsigned char *point =
            message.data.data() + row * message.row_step + column * message.point_step;
        const vec3 position = internal::row_at(point, *at, is_big_endian);
        if (!internal::is_finite(position)) continue;
        points[kept] = position;
        if (has_normals) {
          const vec3 normal = internal::row_at(point, *facing, is_big_endian);
          normals[kept] = internal::is_finite(normal) ? normal : vec3{};
        }
        ++kept;
      }
    }
    made.count_ = kept;
    made.normal_count_ = has_normals ? kept : 0;
    made.dropped_ = static_cast<std::size_t>(count) - kept;
    return made;
  }

  view<const vec3> points() const noexcept { return {static_cast<const vec3 *>(points_.data()), count_}; }
  // One for each point, or none.
  view<const vec3> normals() const noexcept {
    return {static_cast<const vec3 *>(normals_.data()), normal_count_};
  }
  // Number of points without a position.
  std::size_t dropped() const noexcept { return dropped_; }

  // Takes the cloud to another frame, of which `to` is the placement of this one: that of a
  // geometry_msgs/TransformStamped whose child frame is the frame of the cloud.
  void transform(const placement &to) noexcept {
    auto *points = static_cast<vec3 *>(points_.data());
    auto *normals = static_cast<vec3 *>(normals_.data());
    for (std::size_t i = 0; i < count_; ++i) {
      points[i] = internal::rotate(to.rotation, points[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) points[i][axis] += to.position[axis];
    }
    for (std::size_t i = 0; i < normal_count_; ++i) normals[i] = internal::rotate(to.rotation, normals[i]);
  }

 private:
  cloud_points() noexcept = default;
  memory points_, normals_;
  std::size_t count_ = 0, normal_count_ = 0, dropped_ = 0;
};

// The triangles of a message, in memory from the heap that it owns: the mesh of an object.
class mesh_triangles {
 public:
  // Copies a shape_msgs/Mesh. hangpose::object::create checks its indices and coordinates.
  template <class Mesh>
  static result<mesh_triangles> from_mesh(const Mesh &message) noexcept {
    mesh_triangles made;
    if (!made.reserve(message.vertices.size(), message.triangles.size()))
      return hangpose::internal::no_memory();
    for (std::size_t i = 0; i < message.vertices.size(); ++i)
      made.vertex_rows()[i] = internal::to_vec3(message.vertices[i]);
    for (std::size_t i = 0; i < message.triangles.size(); ++i) {
      const auto &corners = message.triangles[i].vertex_indices;
      made.triangle_rows()[i] = {corners[0], corners[1], corners[2]};
    }
    return made;
  }

  // Copies a visualization_msgs/Marker of the type TRIANGLE_LIST, with its pose and its scale: the object
  // coordinates are those of its header. Triangles share no vertices, which the analysis of the object mends.
  template <class Marker>
  static result<mesh_triangles> from_marker(const Marker &message) noexcept {
    if (message.type != internal::triangle_list) {
      return internal::error_at(HANGPOSE_ERROR_VALUE, "marker.type",
                                "the marker is not a list of triangles: publish the type TRIANGLE_LIST",
                                HANGPOSE_NO_INDEX, message.type);
    }
    if (message.points.size() % 3 != 0) {
      return internal::error_at(
          HANGPOSE_ERROR_COUNT, "marker.points",
          "the number of points is not a multiple of 3: publish three for each triangle", HANGPOSE_NO_INDEX,
          static_cast<double>(message.points.size()));
    }
    const auto at = from_pose(message.pose);
    if (!at) return at.error();
    const vec3 scale = internal::to_vec3(message.scale);
    const float volume = scale[0] * scale[1] * scale[2];
    if (!std::isfinite(volume) || volume == 0.0f) {
      return internal::error_at(HANGPOSE_ERROR_VALUE, "marker.scale",
                                "the scale of the marker is 0 or not finite: set x, y and z, to 1 for metres",
                                HANGPOSE_NO_INDEX, volume);
    }
    mesh_triangles made;
    const std::size_t count = message.points.size() / 3;
    if (!made.reserve(message.points.size(), count)) return hangpose::internal::no_memory();
    for (std::size_t i = 0; i < message.points.size(); ++i) {
      vec3 point = internal::to_vec3(message.points[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) point[axis] *= scale[axis];
      point = internal::rotate(at->rotation, point);
      for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += at->position[axis];
      made.vertex_rows()[i] = point;
    }
    // A reflection turns the triangles inside out.
    const std::uint32_t second = volume > 0.0f ? 1 : 2;
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = hangpose::internal::count(3 * i);
      made.triangle_rows()[i] = {first, first + second, first + 3 - second};
    }
    return made;
  }

  view<const vec3> vertices() const noexcept {
    return {static_cast<const vec3 *>(vertices_.data()), vertex_count_};
  }
  view<const triangle> triangles() const noexcept {
    return {static_cast<const triangle *>(triangles_.data()), triangle_count_};
  }

 private:
  mesh_triangles() noexcept = default;
  bool reserve(std::size_t vertices, std::size_t triangles) noexcept {
    vertices_ = memory::own(vertices * sizeof(vec3));
    triangles_ = memory::own(triangles * sizeof(triangle));
    vertex_count_ = vertices;
    triangle_count_ = triangles;
    return vertices_.data() != nullptr && triangles_.data() != nullptr;
  }
  vec3 *vertex_rows() noexcept { return static_cast<vec3 *>(vertices_.data()); }
  triangle *triangle_rows() noexcept { return static_cast<triangle *>(triangles_.data()); }

  memory vertices_, triangles_;
  std::size_t vertex_count_ = 0, triangle_count_ = 0;
};

// A geometry_msgs/Pose: the release pose.
template <class Pose>
Pose to_pose(const pose &hanging) noexcept {
  Pose message;
  internal::set(message.position, message.orientation, hanging.position, hanging.quaternion);
  return message;
}
// A geometry_msgs/Pose: the rest pose; NaN if hangpose_pose.has_rest is 0.
template <class Pose>
Pose rest_to_pose(const pose &hanging) noexcept {
  Pose message;
  internal::set(message.position, message.orientation, hanging.rest_position, hanging.rest_quaternion);
  return message;
}
// A geometry_msgs/Pose: that of a waypoint.
template <class Pose>
Pose to_pose(const waypoint &at) noexcept {
  Pose message;
  internal::set(message.position, message.orientation, at.position, at.quaternion);
  return message;
}

// A geometry_msgs/PoseStamped: the release pose.
template <class PoseStamped, class Header>
PoseStamped to_pose_stamped(const Header &header, const pose &hanging) {
  PoseStamped message;
  message.header = header;
  message.pose = to_pose<decltype(message.pose)>(hanging);
  return message;
}

// A geometry_msgs/TransformStamped for tf: the release pose as the frame `object_frame`.
template <class TransformStamped, class Header>
TransformStamped to_transform_stamped(const Header &header, const char *object_frame, const pose &hanging) {
  TransformStamped message;
  message.header = header;
  message.child_frame_id = object_frame;
  internal::set(message.transform.translation, message.transform.rotation, hanging.position,
                hanging.quaternion);
  return message;
}

// A geometry_msgs/PoseArray: the release poses in their order, best first. Those of which has_pose is 0 are
// left out.
template <class PoseArray, class Header>
PoseArray to_pose_array(const Header &header, view<const pose> poses) {
  PoseArray message;
  message.header = header;
  message.poses.reserve(poses.size());
  for (const pose &hanging : poses) {
    if (hanging.has_pose != 0)
      message.poses.push_back(to_pose<typename decltype(message.poses)::value_type>(hanging));
  }
  return message;
}

// A nav_msgs/Path: the waypoints of plan.object or plan.gripper. The stamp of each is the time at which it is
// reached by a robot that starts at the stamp of the header.
template <class Path, class Header>
Path to_path(const Header &header, view<const waypoint> waypoints) {
  Path message;
  message.header = header;
  message.poses.resize(waypoints.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    auto &stamped = message.poses[i];
    stamped.header = header;
    internal::add_seconds(stamped.header.stamp, waypoints[i].seconds);
    stamped.pose = to_pose<decltype(stamped.pose)>(waypoints[i]);
  }
  return message;
}

// A trajectory_msgs/MultiDOFJointTrajectory of one joint with six degrees of freedom, `joint`: the waypoints
// with their times from the start.
template <class MultiDOFJointTrajectory, class Header>
MultiDOFJointTrajectory to_trajectory(const Header &header, const char *joint,
                                      view<const waypoint> waypoints) {
  MultiDOFJointTrajectory message;
  message.header = header;
  message.joint_names.emplace_back(joint);
  message.points.resize(waypoints.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    auto &point = message.points[i];
    point.transforms.resize(1);
    internal::set(point.transforms[0].translation, point.transforms[0].rotation, waypoints[i].position,
                  waypoints[i].quaternion);
    point.time_from_start.sec = 0;
    point.time_from_start.nanosec = 0;
    internal::add_seconds(point.time_from_start, waypoints[i].seconds);
  }
  return message;
}

}  // namespace ros2
}  // namespace hangpose

#endif  // HANGPOSE_ROS2_HPP
