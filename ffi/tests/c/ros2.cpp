// Tests hangpose/ros2.hpp with the structs of ros2_stand_in/messages.hpp, which have the fields of the
// messages.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <hangpose/ros2.hpp>
#include <string>
#include <utility>
#include <vector>

#include "messages.hpp"
#include "shapes.h"

using geometry_msgs::msg::Pose;
using sensor_msgs::msg::PointCloud2;
using sensor_msgs::msg::PointField;
namespace ros2 = hangpose::ros2;

static int failures = 0;
#define CHECK(is_right)                                                             \
  do {                                                                              \
    if (!(is_right)) std::printf("line %d: %s\n", __LINE__, #is_right), ++failures; \
  } while (false)

// Whether the call failed with this field in its error.
template <class T>
static bool names(const hangpose::result<T> &failed, const char *field) {
  return !failed && failed.error().status() < 0 && std::strcmp(failed.error().field(), field) == 0;
}

static bool is_near(const hangpose::vec3 &a, const hangpose::vec3 &b) {
  return std::fabs(a[0] - b[0]) < 1e-6f && std::fabs(a[1] - b[1]) < 1e-6f && std::fabs(a[2] - b[2]) < 1e-6f;
}

static PointField field(const char *name, std::uint32_t offset, std::uint8_t datatype) {
  PointField made;
  made.name = name;
  made.offset = offset;
  made.datatype = datatype;
  made.count = 1;
  return made;
}

// Writes a number in the given byte order. This machine is little-endian.
template <class Number>
static void put(PointCloud2 &cloud, std::size_t at, Number number) {
  unsigned char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  for (std::size_t i = 0; i < sizeof number; ++i)
    cloud.data[at + i] = bytes[cloud.is_bigendian ? sizeof number - 1 - i : i];
}

// How a driver lays out its points.
struct Layout {
  std::uint32_t height, padding;
  bool is_big_endian, is_double, has_normals;
};

// A message with these points: x, y, z, then four bytes of colour, then the normal.
static PointCloud2 message(const Layout &as, const std::vector<hangpose::vec3> &points,
                           const std::vector<hangpose::vec3> &normals) {
  const std::uint32_t each = as.is_double ? 8 : 4;
  const std::uint8_t type = as.is_double ? PointField::FLOAT64 : PointField::FLOAT32;
  const std::uint32_t normal_at = 3 * each + 4;
  PointCloud2 made;
  made.header.frame_id = "camera";
  made.header.stamp.sec = 7;
  made.header.stamp.nanosec = 900000000;
  made.height = as.height;
  made.width = static_cast<std::uint32_t>(points.size()) / as.height;
  made.is_bigendian = as.is_big_endian;
  made.fields = {field("x", 0, type), field("y", each, type), field("z", 2 * each, type),
                 field("rgb", 3 * each, PointField::UINT32)};
  if (as.has_normals) {
    made.fields.push_back(field("normal_x", normal_at, type));
    made.fields.push_back(field("normal_y", normal_at + each, type));
    made.fields.push_back(field("normal_z", normal_at + 2 * each, type));
  }
  made.point_step = normal_at + (as.has_normals ? 3 * each : 0);
  made.row_step = made.width * made.point_step + as.padding;
  made.data.assign(std::size_t{made.row_step} * made.height, 0xff);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t at = i / made.width * made.row_step + i % made.width * made.point_step;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (as.is_double) {
        put(made, at + axis * each, static_cast<double>(points[i][axis]));
        if (as.has_normals) put(made, at + normal_at + axis * each, static_cast<double>(normals[i][axis]));
      } else {
        put(made, at + axis * each, points[i][axis]);
        if (as.has_normals) put(made, at + normal_at + axis * each, normals[i][axis]);
      }
    }
  }
  return made;
}

static void test_clouds() {
  const float nan = NAN, infinite = INFINITY;
  const std::vector<hangpose::vec3> points{{0.5f, -1.25f, 3.0f},  {nan, 0.0f, 0.0f},
                                           {0.125f, 0.0f, 1e-3f}, {0.0f, infinite, 0.0f},
                                           {-0.1f, 0.2f, -0.3f},  {7.0f, 8.0f, 9.0f}};
  const std::vector<hangpose::vec3> normals{{0.0f, 0.0f, 1.0f}, {nan, nan, nan},    {nan, 0.0f, 1.0f},
                                            {0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.6f, 0.0f, -0.8f}};
  const std::vector<hangpose::vec3> kept{points[0], points[2], points[4], points[5]};
  const std::vector<hangpose::vec3> facing{normals[0], {0.0f, 0.0f, 0.0f}, normals[4], normals[5]};
  for (int bits = 0; bits < 32; ++bits) {
    const Layout as{(bits & 1) != 0 ? 2u : 1u, (bits & 2) != 0 ? 5u : 0u, (bits & 4) != 0, (bits & 8) != 0,
                    (bits & 16) != 0};
    const auto cloud = ros2::cloud_points::create(message(as, points, normals));
    CHECK(cloud && cloud->points().size() == kept.size() && cloud->dropped() == 2);
    CHECK(cloud->normals().size() == (as.has_normals ? kept.size() : 0));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      CHECK(cloud->points()[i] == kept[i]);
      CHECK(!as.has_normals || cloud->normals()[i] == facing[i]);
    }
  }

  // The last row may lack its padding, and what a driver says about a single row does not matter.
  const Layout padded{2, 5, false, false, true}, plain{1, 0, false, false, true};
  auto cut = message(padded, points, normals);
  cut.data.resize(cut.data.size() - 5);
  CHECK(ros2::cloud_points::create(cut)->points().size() == kept.size());
  cut.data.pop_back();
  CHECK(names(ros2::cloud_points::create(cut), "cloud.data"));
  auto row = message(plain, points, normals);
  row.row_step = 0;
  CHECK(ros2::cloud_points::create(row)->points().size() == kept.size());
  auto counted = message(plain, points, normals);
  counted.fields[0].count = 0;
  CHECK(ros2::cloud_points::create(counted)->points().size() == kept.size());

  // An empty cloud is not an error of the message; the analysis reports it.
  auto empty = message(plain, points, normals);
  empty.width = 0;
  empty.data.clear();
  const auto nothing = ros2::cloud_points::create(empty);
  CHECK(nothing && nothing->points().empty() && nothing->dropped() == 0);
  const auto blank = hangpose::supporter::create({nothing->points(), nothing->normals()}, hangpose::params());
  CHECK(!blank && blank.error().status() == HANGPOSE_ERROR_COUNT);

  // What is wrong with a message.
  const auto right = message(padded, points, normals);
  auto wrong = right;
  wrong.fields[1].datatype = PointField::INT16;
  const auto integers = ros2::cloud_points::create(wrong);
  CHECK(names(integers, "cloud.fields.datatype") && integers.error().detail().index == 1);
  wrong = right;
  wrong.fields.erase(wrong.fields.begin() + 2);
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.fields"));
  wrong.fields.clear();
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.fields"));
  wrong = right;
  wrong.fields.pop_back();
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.fields"));
  wrong = right;
  wrong.fields[0].count = 3;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.fields.count"));
  wrong = right;
  wrong.point_step -= 1;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.fields.offset"));
  wrong = right;
  wrong.fields[2].offset = UINT32_MAX - 1;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.fields.offset"));
  wrong = right;
  wrong.row_step -= 6;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.row_step"));
  wrong = right;
  wrong.width = wrong.height = wrong.row_step = UINT32_MAX;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.row_step"));
  wrong.width = 1;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.data"));
  wrong = right;
  wrong.width = UINT32_MAX;
  wrong.height = 1;
  CHECK(names(ros2::cloud_points::create(wrong), "cloud.data"));

  // A quarter turn about z, then a shift.
  geometry_msgs::msg::TransformStamped base_from_camera;
  base_from_camera.transform.translation.x = 1.0;
  base_from_camera.transform.rotation.z = base_from_camera.transform.rotation.w = std::sqrt(0.5);
  const auto to = ros2::from_transform(base_from_camera.transform);
  auto moved = ros2::cloud_points::create(right);
  CHECK(to && is_near(to->position, {1.0f, 0.0f, 0.0f}));
  moved->transform(*to);
  CHECK(is_near(moved->points()[0], {1.0f + 1.25f, 0.5f, 3.0f}));
  CHECK(is_near(moved->normals()[2], {0.0f, 1.0f, 0.0f}) && is_near(moved->normals()[1], {0.0f, 0.0f, 0.0f}));

  // Rotations that are none, and positions that are none.
  Pose pose;
  CHECK(ros2::from_pose(pose) && ros2::from_pose(pose)->rotation[3] == 1.0f);
  pose.orientation.w = 0.0;
  CHECK(names(ros2::from_pose(pose), "orientation"));
  pose.orientation.w = NAN;
  CHECK(names(ros2::from_pose(pose), "orientation"));
  pose = Pose();
  pose.position.y = NAN;
  CHECK(names(ros2::from_pose(pose), "position"));
  // Numbers that no float holds stay wrong, so that the library reports them.
  pose.position.y = -1e300;
  CHECK(ros2::from_pose(pose)->position[1] < -1e38f);
}

static geometry_msgs::msg::Point point(const hangpose::vec3 &at) {
  geometry_msgs::msg::Point made;
  made.x = at[0], made.y = at[1], made.z = at[2];
  return made;
}

int main() {
  test_clouds();

  // A ring on a peg: through messages it is predicted bit by bit as without them.
  std::vector<hangpose::vec3> vertices(RING_VERTICES), points(PEG_POINTS), normals(PEG_POINTS);
  std::vector<hangpose::triangle> triangles(RING_TRIANGLES);
  make_ring(0.03f, reinterpret_cast<float(*)[3]>(vertices.data()),
            reinterpret_cast<std::uint32_t(*)[3]>(triangles.data()));
  make_peg(0.004f, reinterpret_cast<float(*)[3]>(points.data()),
           reinterpret_cast<float(*)[3]>(normals.data()));
  hangpose::params params;
  params.samples = 3000;
  params.voxels = 20000;

  shape_msgs::msg::Mesh mesh;
  visualization_msgs::msg::Marker marker;
  marker.type = visualization_msgs::msg::Marker::TRIANGLE_LIST;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  for (const auto &at : vertices) mesh.vertices.push_back(point(at));
  for (const auto &corners : triangles) {
    mesh.triangles.push_back({corners});
    for (const auto corner : corners) marker.points.push_back(point(vertices[corner]));
  }
  const auto ring_mesh = ros2::mesh_triangles::from_mesh(mesh);
  CHECK(ring_mesh && std::memcmp(ring_mesh->vertices().data(), vertices.data(), 12 * vertices.size()) == 0);
  CHECK(std::memcmp(ring_mesh->triangles().data(), triangles.data(), 12 * triangles.size()) == 0);
  const auto cloud = ros2::cloud_points::create(message({1, 0, true, false, true}, points, normals));
  const auto ring = hangpose::object::create({ring_mesh->vertices(), ring_mesh->triangles()}, params);
  const auto peg = hangpose::supporter::create({cloud->points(), cloud->normals()}, params);
  const auto ring_itself = hangpose::object::create({vertices, triangles}, params);
  const auto peg_itself = hangpose::supporter::create({points, normals}, params);
  hangpose::pose poses[3], same[3];
  const auto found = hangpose::predict(*ring, *peg, params, poses);
  const auto found_itself = hangpose::predict(*ring_itself, *peg_itself, params, same);
  CHECK(found && found->poses.size() >= 1 && found_itself->poses.size() == found->poses.size());
  CHECK(std::memcmp(poses, same, found->poses.size() * sizeof *poses) == 0);

  // A marker shares no vertices, and is the same closed object: shown, scaled, turned and mirrored.
  const auto shown = ros2::mesh_triangles::from_marker(marker);
  CHECK(shown && shown->vertices().size() == marker.points.size());
  CHECK(shown->triangles()[1] == (hangpose::triangle{3, 4, 5}));
  const auto as_shown = hangpose::object::create({shown->vertices(), shown->triangles()}, params);
  CHECK(as_shown && as_shown->info()->is_closed == 1 && ring->info()->is_closed == 1);
  marker.scale.x = -2.0;
  marker.pose.position.z = 0.5;
  marker.pose.orientation.z = marker.pose.orientation.w = std::sqrt(0.5);
  const auto mirrored = ros2::mesh_triangles::from_marker(marker);
  CHECK(mirrored->triangles()[1] == (hangpose::triangle{3, 5, 4}));
  const auto first = marker.points[0];
  CHECK(is_near(mirrored->vertices()[0], {static_cast<float>(-first.y), static_cast<float>(-2.0 * first.x),
                                          static_cast<float>(first.z + 0.5)}));
  const auto as_mirrored = hangpose::object::create({mirrored->vertices(), mirrored->triangles()}, params);
  CHECK(as_mirrored && as_mirrored->info()->is_closed == 1);
  auto wrong = marker;
  wrong.type = visualization_msgs::msg::Marker::CUBE;
  CHECK(names(ros2::mesh_triangles::from_marker(wrong), "marker.type"));
  wrong = marker;
  wrong.points.pop_back();
  CHECK(names(ros2::mesh_triangles::from_marker(wrong), "marker.points"));
  wrong = marker;
  wrong.scale.y = 0.0;
  CHECK(names(ros2::mesh_triangles::from_marker(wrong), "marker.scale"));
  wrong = marker;
  wrong.pose.orientation.w = 0.0;
  CHECK(names(ros2::mesh_triangles::from_marker(wrong), "orientation"));
  mesh.triangles[2].vertex_indices[1] = RING_VERTICES;
  const auto dangling = ros2::mesh_triangles::from_mesh(mesh);
  const auto refused = hangpose::object::create({dangling->vertices(), dangling->triangles()}, params);
  CHECK(!refused && refused.error().status() == HANGPOSE_ERROR_INDEX && refused.error().detail().index == 2);

  // Poses become messages with the header of the cloud.
  const auto header = message({1, 0, false, false, false}, points, normals).header;
  const auto best = ros2::to_pose_stamped<geometry_msgs::msg::PoseStamped>(header, poses[0]);
  CHECK(best.header.frame_id == "camera" && best.header.stamp.nanosec == 900000000);
  CHECK(best.pose.position.x == poses[0].position[0] && best.pose.position.z == poses[0].position[2]);
  CHECK(best.pose.orientation.x == poses[0].quaternion[0] &&
        best.pose.orientation.w == poses[0].quaternion[3]);
  const auto rest = ros2::rest_to_pose<Pose>(poses[0]);
  CHECK(rest.position.z == poses[0].rest_position[2] && rest.orientation.y == poses[0].rest_quaternion[1]);
  const auto frame =
      ros2::to_transform_stamped<geometry_msgs::msg::TransformStamped>(header, "ring", poses[0]);
  CHECK(frame.header.frame_id == "camera" && frame.child_frame_id == "ring");
  CHECK(frame.transform.translation.y == poses[0].position[1]);
  CHECK(frame.transform.rotation.z == poses[0].quaternion[2]);
  // What the message does with a point of the object is what hangpose.h says that the pose does.
  const auto back = ros2::from_pose(best.pose);
  CHECK(back && is_near(back->position, {poses[0].position[0], poses[0].position[1], poses[0].position[2]}));
  hangpose::pose two[2] = {poses[0], poses[0]};
  two[0].has_pose = 0;
  const auto array = ros2::to_pose_array<geometry_msgs::msg::PoseArray>(header, two);
  CHECK(array.poses.size() == 1 && array.header.frame_id == "camera");
  CHECK(array.poses[0].orientation.w == poses[0].quaternion[3]);

  // A path: stamps carry over into the next second, durations begin at 0.
  std::vector<hangpose::waypoint> waypoints(200);
  hangpose::motion motion;
  const auto plan =
      hangpose::plan_path(*ring, *peg, hangpose::request(), params, motion, poses[0], waypoints);
  CHECK(plan && plan->status == HANGPOSE_OK && plan->object.size() >= 2);
  const auto path = ros2::to_path<nav_msgs::msg::Path>(header, plan->object);
  const auto trajectory =
      ros2::to_trajectory<trajectory_msgs::msg::MultiDOFJointTrajectory>(header, "ring", plan->object);
  CHECK(path.poses.size() == plan->object.size() && trajectory.points.size() == path.poses.size());
  CHECK(path.header.frame_id == "camera" && path.poses[1].header.frame_id == "camera");
  CHECK(trajectory.joint_names.size() == 1 && trajectory.joint_names[0] == "ring");
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const hangpose::waypoint &at = plan->object[i];
    const auto &stamp = path.poses[i].header.stamp;
    const auto &since = trajectory.points[i].time_from_start;
    CHECK(stamp.nanosec < 1000000000 && since.nanosec < 1000000000);
    CHECK(std::fabs(stamp.sec + 1e-9 * stamp.nanosec - 7.9 - double{at.seconds}) < 1e-8);
    CHECK(std::fabs(since.sec + 1e-9 * since.nanosec - double{at.seconds}) < 1e-8);
    CHECK(path.poses[i].pose.position.x == at.position[0] &&
          path.poses[i].pose.orientation.w == at.quaternion[3]);
    CHECK(trajectory.points[i].transforms[0].translation.z == at.position[2]);
    CHECK(trajectory.points[i].transforms[0].rotation.y == at.quaternion[1]);
  }
  builtin_interfaces::msg::Time time;
  time.sec = 1;
  ros2::internal::add_seconds(time, -1.25f);
  CHECK(time.sec == -1 && time.nanosec == 750000000);

  std::printf("%d failures\n", failures);
  return failures != 0;
}
