// Runs the node in ros2/ against the stand-ins for rclcpp and tf2 in ros2_stand_in/: sends it meshes and
// clouds and reads what it publishes: ./ros2_node mug.obj hook.obj
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "hang_node.hpp"
#include "obj_file.hpp"

using geometry_msgs::msg::PoseArray;
using geometry_msgs::msg::PoseStamped;
using hangpose_ros::HangNode;
using hangpose_ros::ObjFile;
using nav_msgs::msg::Path;
using rclcpp::Parameter;
using sensor_msgs::msg::PointCloud2;

static int failures = 0;
#define CHECK(is_right)                                                             \
  do {                                                                              \
    if (!(is_right)) std::printf("line %d: %s\n", __LINE__, #is_right), ++failures; \
  } while (false)

static std::unique_ptr<HangNode> node_with(const std::vector<Parameter> &parameters) {
  return std::make_unique<HangNode>(rclcpp::NodeOptions().parameter_overrides(parameters));
}

// What the node says when it refuses these parameters.
static std::string refusal(const std::vector<Parameter> &parameters) {
  try {
    node_with(parameters);
  } catch (const std::exception &why) {
    return why.what();
  }
  return "";
}

static bool begins(const std::string &text, const std::string &with) { return text.rfind(with, 0) == 0; }

static std::string last_line(const HangNode &node) {
  const auto &lines = *node.get_logger().lines;
  return lines.empty() ? "" : lines.back();
}

// The cloud of points and normals in the frame of a camera.
static PointCloud2 cloud_of(const std::vector<hangpose::vec3> &points,
                            const std::vector<hangpose::vec3> &normals) {
  static const char *const names[6] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  PointCloud2 made;
  made.header.frame_id = "camera";
  made.header.stamp.sec = 100;
  made.height = 1;
  made.width = static_cast<std::uint32_t>(points.size());
  made.point_step = 24;
  made.row_step = made.width * made.point_step;
  for (std::uint32_t i = 0; i < 6; ++i)
    made.fields.push_back({names[i], 4 * i, sensor_msgs::msg::PointField::FLOAT32, 1});
  made.data.resize(made.row_step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(&made.data[24 * i], &points[i], 12);
    std::memcpy(&made.data[24 * i + 12], &normals[i], 12);
  }
  return made;
}

static bool is_same(const geometry_msgs::msg::Pose &message, const float (&position)[3],
                    const float (&turned)[4]) {
  return message.position.x == position[0] && message.position.y == position[1] &&
         message.position.z == position[2] && message.orientation.x == turned[0] &&
         message.orientation.y == turned[1] && message.orientation.z == turned[2] &&
         message.orientation.w == turned[3];
}

int main(int count, char **arguments) {
  if (count != 3) return 2;
  const ObjFile mug(arguments[1]), hook(arguments[2]);
  CHECK(mug.error.empty() && hook.error.empty());
  std::vector<hangpose::vec3> points(10000), normals(10000);
  CHECK(hangpose::sample({hook.vertices, hook.triangles}, points, normals));
  const hangpose::params params;
  const auto object = hangpose::object::create({mug.vertices, mug.triangles}, params);
  const auto supporter = hangpose::supporter::create({points, normals}, params);
  hangpose::pose wanted[10];
  std::vector<hangpose::waypoint> waypoints(4000);
  const auto found = hangpose::predict_reachable(*object, *supporter, hangpose::request(), params,
                                                 hangpose::motion(), wanted, {}, waypoints);
  CHECK(found && found->status == HANGPOSE_OK);

  // The poses and the path are those of the library, in the frame of the cloud.
  const auto cloud = cloud_of(points, normals);
  const auto node = node_with({{"object_file", std::string(arguments[1])}});
  node->send("supporter", cloud);
  const auto &arrays = node->published<PoseArray>("~/poses");
  const auto &best = node->published<PoseStamped>("~/best");
  const auto &paths = node->published<Path>("~/path");
  CHECK(arrays.size() == 1 && best.size() == 1 && paths.size() == 1 && last_line(*node).empty());
  CHECK(arrays[0].header.frame_id == "camera" && arrays[0].header.stamp.sec == 100);
  CHECK(arrays[0].poses.size() == found->prediction.poses.size());
  for (std::size_t i = 0; i < arrays[0].poses.size(); ++i)
    CHECK(is_same(arrays[0].poses[i], wanted[i].position, wanted[i].quaternion));
  const hangpose::pose &reached = wanted[found->plan.pose_index];
  CHECK(is_same(best[0].pose, reached.position, reached.quaternion) && best[0].header.frame_id == "camera");
  CHECK(paths[0].poses.size() == found->plan.object.size());
  const auto &end = paths[0].poses.back();
  CHECK(std::fabs(end.pose.position.z - double{reached.rest_position[2]}) < 1e-3);
  CHECK(end.header.stamp.sec > 100 && paths[0].poses[0].header.stamp.sec == 100);

  // Clouds that come too soon are left out.
  node->send("supporter", cloud);
  CHECK(arrays.size() == 1);
  node->get_clock()->nanoseconds = 1100000000;
  auto broken = cloud;
  broken.data.pop_back();
  node->send("supporter", broken);
  CHECK(arrays.size() == 1 && last_line(*node).find("cloud.data") != std::string::npos);

  // A camera that looks along y and is 1 m up: the poses are given in the frame of the robot.
  auto &transforms = tf2_ros::Buffer::transforms();
  auto &base_from_camera = transforms[{"base", "camera"}];
  base_from_camera.transform.translation.z = 1.0;
  base_from_camera.transform.rotation.z = base_from_camera.transform.rotation.w = std::sqrt(0.5);
  const auto in_base = node_with({{"object_file", std::string(arguments[1])},
                                  {"frame", std::string("base")},
                                  {"sensor_frame", std::string("eye")},
                                  {"path.plan", false},
                                  {"min_period", 0.0}});
  in_base->send("supporter", cloud);
  CHECK(in_base->published<PoseArray>("~/poses").empty());
  CHECK(last_line(*in_base).find("\"eye\"") != std::string::npos);
  transforms[{"base", "eye"}].transform.translation.y = 3.0;
  in_base->send("supporter", cloud);
  const auto &turned = in_base->published<PoseStamped>("~/best");
  CHECK(turned.size() == 1 && turned[0].header.frame_id == "base" && turned[0].pose.position.z > 0.9);
  CHECK(in_base->published<PoseArray>("~/poses")[0].header.frame_id == "base");
  CHECK(in_base->published<Path>("~/path").empty());
  auto elsewhere = cloud;
  elsewhere.header.frame_id = "nowhere";
  in_base->send("supporter", elsewhere);
  CHECK(turned.size() == 1 && last_line(*in_base).find("nowhere") != std::string::npos);
  base_from_camera.transform.rotation.w = 0.0;
  in_base->send("supporter", cloud);
  CHECK(turned.size() == 1 && last_line(*in_base).find("orientation") != std::string::npos);

  // Without a file the object comes as a message; a broken one does not replace it.
  const auto by_topic = node_with({{"path.plan", false}, {"min_period", 0.0}, {"poses", std::int64_t{1}}});
  by_topic->send("supporter", cloud);
  CHECK(begins(last_line(*by_topic), "waiting for an object"));
  shape_msgs::msg::Mesh mesh;
  for (const auto &v : mug.vertices) {
    mesh.vertices.emplace_back();
    mesh.vertices.back().x = v[0], mesh.vertices.back().y = v[1], mesh.vertices.back().z = v[2];
  }
  for (const auto &corners : mug.triangles) mesh.triangles.push_back({corners});
  by_topic->send("object", mesh);
  mesh.triangles[0].vertex_indices[0] = UINT32_MAX;
  by_topic->send("object", mesh);
  CHECK(last_line(*by_topic).find("mesh.triangles") != std::string::npos);
  by_topic->send("supporter", cloud);
  CHECK(by_topic->published<PoseArray>("~/poses").size() == 1);
  CHECK(by_topic->published<PoseArray>("~/poses")[0].poses.size() == 1);

  // Each parameter reaches the prediction: where nothing can hang, the node says why; else it gives other
  // poses.
  const auto poses_with = [&](const Parameter &asked, std::string &said) {
    const auto strict = node_with({{"object_file", std::string(arguments[1])}, {"path.plan", false}, asked});
    strict->send("supporter", cloud);
    said = last_line(*strict);
    return strict->published<PoseArray>("~/poses").at(0).poses;
  };
  const auto is_nowhere = [&](const Parameter &asked) {
    std::string said;
    return poses_with(asked, said).empty() && begins(said, "nothing hangs");
  };
  const auto is_elsewhere = [&](const Parameter &asked) {
    std::string said;
    const auto others = poses_with(asked, said);
    return !others.empty() && said.empty() && !is_same(others[0], wanted[0].position, wanted[0].quaternion);
  };
  using Numbers = std::vector<double>;
  using Kinds = std::vector<std::string>;
  CHECK(is_nowhere({"request.here", Numbers{0.0, 0.0, 9.0}}));
  CHECK(is_nowhere({"request.by", Numbers{0.0, 0.0, 9.0}}));
  CHECK(is_nowhere({"request.region", Numbers{1.0, 1.0, 1.0, 2.0, 2.0, 2.0}}));
  CHECK(is_elsewhere({"request.allow", Kinds{"capped"}}));
  CHECK(is_elsewhere({"gravity", Numbers{0.0, 0.0, 1.0}}));
  CHECK(is_elsewhere({"friction", 0.1}));

  // Parameters that are wrong.
  CHECK(begins(refusal({{"profile", std::string("best")}}), "profile: there is no profile 'best'"));
  CHECK(begins(refusal({{"gravity", Numbers{0.0, 1.0}}}), "gravity: has 2 numbers"));
  CHECK(begins(refusal({{"request.here", Numbers{0.0, 1.0, NAN}}}), "request.here: has a number"));
  CHECK(begins(refusal({{"request.allow", std::vector<std::string>{"glued"}}}),
               "request.allow: there is no kind"));
  CHECK(begins(refusal({{"poses", std::int64_t{0}}}), "poses: is 0"));
  CHECK(begins(refusal({{"object_file", std::string("absent.obj")}}),
               "object_file: absent.obj: cannot be opened"));
  CHECK(!refusal({{"poses", std::string("many")}}).empty());

  // The names of the parameters, which the script looks up in config/hang_node.yaml.
  for (const auto &name : node->declared) std::printf("%s\n", name.c_str());
  return failures != 0;
}
