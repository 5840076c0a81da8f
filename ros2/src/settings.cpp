#include "settings.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace hangpose_ros {
namespace {

// A vector of so many numbers, or of none.
std::vector<double> numbers(rclcpp::Node &node, const std::string &name, std::size_t count,
                            const std::string &meaning) {
  const auto values = node.declare_parameter<std::vector<double>>(name, std::vector<double>());
  if (!values.empty() && values.size() != count) {
    throw std::invalid_argument(name + ": has " + std::to_string(values.size()) + " numbers: give " +
                                std::to_string(count) + " (" + meaning + "), or none");
  }
  for (const double value : values) {
    if (!std::isfinite(value)) throw std::invalid_argument(name + ": has a number that is not finite");
  }
  return values;
}

hangpose::vec3 row(const std::vector<double> &values, std::size_t first = 0) {
  return {static_cast<float>(values[first]), static_cast<float>(values[first + 1]),
          static_cast<float>(values[first + 2])};
}

float number(rclcpp::Node &node, const std::string &name, double otherwise) {
  return static_cast<float>(node.declare_parameter<double>(name, otherwise));
}

// The kinds of a list of names, joined.
hangpose_kind kinds(rclcpp::Node &node, const std::string &name, const std::vector<std::string> &otherwise) {
  hangpose_kind joined = 0;
  for (const auto &kind : node.declare_parameter<std::vector<std::string>>(name, otherwise)) {
    if (kind == "threaded") {
      joined |= HANGPOSE_KIND_THREADED;
    } else if (kind == "hooked") {
      joined |= HANGPOSE_KIND_HOOKED;
    } else if (kind == "capped") {
      joined |= HANGPOSE_KIND_CAPPED;
    } else if (kind == "balanced") {
      joined |= HANGPOSE_KIND_BALANCED;
    } else if (!kind.empty()) {
      throw std::invalid_argument(name + ": there is no kind '" + kind +
                                  "': use threaded, hooked, capped or balanced");
    }
  }
  return joined;
}

hangpose::params profile(rclcpp::Node &node) {
  const auto name = node.declare_parameter<std::string>("profile", "default");
  if (name == "default") return hangpose::params();
  if (name == "paper") return hangpose::params::paper();
  throw std::invalid_argument("profile: there is no profile '" + name + "': use default or paper");
}

}  // namespace

Settings::Settings(rclcpp::Node &node) : params(profile(node)) {
  object_file = node.declare_parameter<std::string>("object_file", "");
  frame = node.declare_parameter<std::string>("frame", "");
  sensor_frame = node.declare_parameter<std::string>("sensor_frame", "");
  transform_timeout = node.declare_parameter<double>("transform_timeout", 0.1);
  min_period = node.declare_parameter<double>("min_period", 1.0);
  const auto count = node.declare_parameter<std::int64_t>("poses", 10);
  if (count < 1 || count > 1000)
    throw std::invalid_argument("poses: is " + std::to_string(count) + ": use a number from 1 to 1000");
  poses = static_cast<std::size_t>(count);

  const auto gravity = numbers(node, "gravity", 3, "x, y, z");
  for (std::size_t i = 0; i < gravity.size(); ++i) params.gravity[i] = static_cast<float>(gravity[i]);
  params.friction = number(node, "friction", double{params.friction});
  params.min_probability = number(node, "min_probability", double{params.min_probability});
  const auto centre = numbers(node, "centre_of_mass", 3, "x, y, z, metres");
  if (!centre.empty()) {
    params.centre_of_mass = HANGPOSE_CENTRE_OF_MASS_GIVEN;
    for (std::size_t i = 0; i < 3; ++i) params.given_centre_of_mass[i] = static_cast<float>(centre[i]);
  }

  request.allow = kinds(node, "request.allow", {"threaded", "hooked", "capped", "balanced"});
  request.prefer = kinds(node, "request.prefer", {"threaded", "hooked"});
  const auto here = numbers(node, "request.here", 3, "x, y, z, metres");
  const float here_radius = number(node, "request.here_radius", 0.02);
  if (!here.empty()) {
    here_ = row(here);
    request.on = hangpose::region::around({&here_, 1}, here_radius);
  }
  const auto by = numbers(node, "request.by", 3, "x, y, z, metres");
  const float by_radius = number(node, "request.by_radius", 0.02);
  if (!by.empty()) {
    by_ = row(by);
    request.by = hangpose::region::around({&by_, 1}, by_radius);
  }
  const auto approach = numbers(node, "request.approach", 3, "x, y, z");
  const float angle = number(node, "request.approach_angle", 0.35);
  const float length = number(node, "request.approach_length", 0.1);
  if (!approach.empty()) request.come_along(row(approach), angle, length);
  const auto corners = numbers(node, "request.region", 6, "lower x, y, z, upper x, y, z, metres");
  has_region = !corners.empty();
  if (has_region) region = {row(corners), row(corners, 3)};

  has_path = node.declare_parameter<bool>("path.plan", true);
  // Without a distance field there is no simulation and no path.
  if (has_path && params.voxels == 0)
    throw std::invalid_argument("path.plan: the profile paper plans no paths: set it to false");
  const auto start = numbers(node, "path.start", 7, "x, y, z, metres, and a quaternion x, y, z, w");
  if (!start.empty()) {
    const hangpose::quaternion turned{static_cast<float>(start[3]), static_cast<float>(start[4]),
                                      static_cast<float>(start[5]), static_cast<float>(start[6])};
    motion.start_at(row(start), turned);
  }
  const auto workspace = numbers(node, "path.workspace", 6, "lower x, y, z, upper x, y, z, metres");
  if (!workspace.empty()) motion.stay_within({row(workspace), row(workspace, 3)});
}

}  // namespace hangpose_ros
