#include "hang_node.hpp"

#include <stdexcept>
#include <utility>

#include "obj_file.hpp"

namespace hangpose_ros {
namespace {

namespace ros2 = hangpose::ros2;

// Milliseconds between two warnings about the same lasting state.
constexpr int quiet_period = 5000;

// Room for the waypoints of a path. Should a path have more, the error says so.
constexpr std::size_t most_waypoints = 4000;

std::string text_of(const hangpose::error &why) {
  return std::string(hangpose_status_string(why.status())) + ": " + why.field() + ": " + why.message();
}

}  // namespace

HangNode::HangNode(const rclcpp::NodeOptions &options)
    : rclcpp::Node("hang_node", options),
      settings_(*this),
      poses_(settings_.poses),
      waypoints_(settings_.has_path ? most_waypoints : 0),
      transforms_(get_clock()),
      listener_(transforms_) {
  if (!settings_.object_file.empty()) {
    const ObjFile file(settings_.object_file);
    if (!file.error.empty()) throw std::invalid_argument("object_file: " + file.error);
    auto object = hangpose::object::create({file.vertices, file.triangles}, settings_.params);
    if (!object) throw std::invalid_argument("object_file: " + text_of(object.error()));
    object_ = *std::move(object);
  }
  // Whoever subscribes later gets the last result, too.
  const auto latched = rclcpp::QoS(1).transient_local();
  poses_publisher_ = create_publisher<geometry_msgs::msg::PoseArray>("~/poses", latched);
  best_publisher_ = create_publisher<geometry_msgs::msg::PoseStamped>("~/best", latched);
  path_publisher_ = create_publisher<nav_msgs::msg::Path>("~/path", latched);
  object_subscription_ = create_subscription<shape_msgs::msg::Mesh>(
      "object", latched, [this](const shape_msgs::msg::Mesh &message) { take_object(message); });
  // Only the newest cloud is of interest: older ones that came during a prediction are dropped.
  cloud_subscription_ = create_subscription<sensor_msgs::msg::PointCloud2>(
      "supporter", rclcpp::SensorDataQoS().keep_last(1),
      [this](const sensor_msgs::msg::PointCloud2 &message) { take_cloud(message); });
}

void HangNode::take_object(const shape_msgs::msg::Mesh &message) {
  const auto mesh = ros2::mesh_triangles::from_mesh(message);
  if (!mesh) return say(mesh.error());
  auto object = hangpose::object::create({mesh->vertices(), mesh->triangles()}, settings_.params);
  if (!object) return say(object.error());
  object_ = *std::move(object);
}

void HangNode::take_cloud(const sensor_msgs::msg::PointCloud2 &message) {
  if (!object_) {
    RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), quiet_period,
                         "waiting for an object: set the parameter object_file, or publish a shape_msgs/Mesh "
                         "on the topic object");
    return;
  }
  const auto now = get_clock()->now();
  if (last_ && (now - *last_).seconds() < settings_.min_period) return;
  last_ = now;
  const auto hung = hang(message);
  if (!hung) say(hung.error());
}

std::optional<ros2::placement> HangNode::look_up(const std::string &to, const std::string &from,
                                                 const builtin_interfaces::msg::Time &stamp) {
  try {
    const auto found = transforms_.lookupTransform(
        to, from, rclcpp::Time(stamp), rclcpp::Duration::from_seconds(settings_.transform_timeout));
    const auto at = ros2::from_transform(found.transform);
    if (at) return *at;
    say(at.error());
  } catch (const tf2::TransformException &why) {
    RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), quiet_period, "no transform: %s", why.what());
  }
  return std::nullopt;
}

hangpose::result<hangpose::done> HangNode::hang(const sensor_msgs::msg::PointCloud2 &message) {
  auto points = ros2::cloud_points::create(message);
  if (!points) return points.error();
  auto header = message.header;
  if (!settings_.frame.empty() && settings_.frame != header.frame_id) {
    const auto at = look_up(settings_.frame, header.frame_id, header.stamp);
    if (!at) return hangpose::done{};
    points->transform(*at);
    header.frame_id = settings_.frame;
  }
  hangpose::cloud cloud(points->points(), points->normals());
  hangpose::vec3 viewpoint{};
  if (!settings_.sensor_frame.empty()) {
    if (settings_.sensor_frame != header.frame_id) {
      const auto at = look_up(header.frame_id, settings_.sensor_frame, header.stamp);
      if (!at) return hangpose::done{};
      viewpoint = at->position;
    }
    cloud.seen_from({&viewpoint, 1});
  }
  if (settings_.has_region) cloud.hang_within(settings_.region);
  const auto supporter = hangpose::supporter::create(cloud, settings_.params);
  if (!supporter) return supporter.error();

  if (!settings_.has_path) {
    const auto found = hangpose::predict(*object_, *supporter, settings_.request, settings_.params, poses_);
    if (!found) return found.error();
    publish(header, *found);
    return hangpose::done{};
  }
  const auto found = hangpose::predict_reachable(*object_, *supporter, settings_.request, settings_.params,
                                                 settings_.motion, poses_, {}, waypoints_);
  if (!found) return found.error();
  publish(header, found->prediction);
  const bool has_path = found->status == HANGPOSE_OK;
  if (!has_path && found->status != HANGPOSE_REJECTED)
    RCLCPP_WARN(get_logger(), "no pose has a path; the last one: %s", found->plan.reason());
  // Without a path an empty one replaces the last.
  const auto object_path = has_path ? found->plan.object : hangpose::view<const hangpose::waypoint>();
  path_publisher_->publish(ros2::to_path<nav_msgs::msg::Path>(header, object_path));
  // The best pose is the one that the path leads to.
  if (has_path) {
    best_publisher_->publish(
        ros2::to_pose_stamped<geometry_msgs::msg::PoseStamped>(header, poses_[found->plan.pose_index]));
  }
  return hangpose::done{};
}

void HangNode::publish(const std_msgs::msg::Header &header, const hangpose::prediction &found) {
  if (found.poses.empty()) RCLCPP_WARN(get_logger(), "nothing hangs: %s", found.reason());
  poses_publisher_->publish(ros2::to_pose_array<geometry_msgs::msg::PoseArray>(
      header, hangpose::view<const hangpose::pose>(found.poses.data(), found.poses.size())));
  if (!settings_.has_path && !found.poses.empty()) {
    best_publisher_->publish(ros2::to_pose_stamped<geometry_msgs::msg::PoseStamped>(header, found.poses[0]));
  }
}

void HangNode::say(const hangpose::error &why) { RCLCPP_ERROR(get_logger(), "%s", text_of(why).c_str()); }

}  // namespace hangpose_ros
