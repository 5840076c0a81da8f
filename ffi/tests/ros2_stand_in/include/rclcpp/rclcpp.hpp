// Stands for rclcpp: the part of its interface that the node in ros2/ uses, with the signatures of ROS 2
// Humble and later. There are no processes and no network: a test sends messages to subscriptions and reads
// what was published.
#ifndef STAND_IN_RCLCPP_HPP
#define STAND_IN_RCLCPP_HPP

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../../messages.hpp"

namespace rclcpp {

class Duration {
 public:
  explicit Duration(std::int64_t nanoseconds) : nanoseconds_(nanoseconds) {}
  static Duration from_seconds(double seconds) { return Duration(static_cast<std::int64_t>(seconds * 1e9)); }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_); }

 private:
  std::int64_t nanoseconds_;
};

class Time {
 public:
  explicit Time(std::int64_t nanoseconds = 0) : nanoseconds_(nanoseconds) {}
  Time(const builtin_interfaces::msg::Time &stamp)
      : nanoseconds_(stamp.sec * INT64_C(1000000000) + stamp.nanosec) {}
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_); }
  Duration operator-(const Time &earlier) const { return Duration(nanoseconds_ - earlier.nanoseconds_); }

 private:
  std::int64_t nanoseconds_;
};

class Clock {
 public:
  using SharedPtr = std::shared_ptr<Clock>;
  Time now() { return Time(nanoseconds); }
  // Set by the test.
  std::int64_t nanoseconds = 0;
};

// Collects what was logged.
class Logger {
 public:
  std::shared_ptr<std::vector<std::string>> lines = std::make_shared<std::vector<std::string>>();
};

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
inline void
log(const Logger &logger, const char *format, ...) {
  char text[1000];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  logger.lines->push_back(text);
}

#define RCLCPP_INFO(logger, ...) rclcpp::log(logger, __VA_ARGS__)
#define RCLCPP_WARN(logger, ...) rclcpp::log(logger, __VA_ARGS__)
#define RCLCPP_ERROR(logger, ...) rclcpp::log(logger, __VA_ARGS__)
#define RCLCPP_WARN_THROTTLE(logger, clock, milliseconds, ...) \
  (static_cast<void>(clock), static_cast<void>(milliseconds), rclcpp::log(logger, __VA_ARGS__))

class QoS {
 public:
  QoS(std::size_t depth) : depth_(depth) {}
  QoS &keep_last(std::size_t depth) { return depth_ = depth, *this; }
  QoS &transient_local() { return is_latched_ = true, *this; }
  std::size_t depth() const { return depth_; }

 private:
  std::size_t depth_;
  bool is_latched_ = false;
};
class SensorDataQoS : public QoS {
 public:
  SensorDataQoS() : QoS(5) {}
};

using ParameterValue =
    std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

class Parameter {
 public:
  template <class Value>
  Parameter(const std::string &name, Value value) : name_(name), value_(std::move(value)) {}
  const std::string &get_name() const { return name_; }
  const ParameterValue &value() const { return value_; }

 private:
  std::string name_;
  ParameterValue value_;
};

class NodeOptions {
 public:
  NodeOptions &parameter_overrides(const std::vector<Parameter> &values) {
    return overrides_ = values, *this;
  }
  const std::vector<Parameter> &parameter_overrides() const { return overrides_; }

 private:
  std::vector<Parameter> overrides_;
};

template <class Message>
class Publisher {
 public:
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const Message &message) { messages.push_back(message); }
  // Read by the test.
  std::vector<Message> messages;
};

template <class Message>
class Subscription {
 public:
  using SharedPtr = std::shared_ptr<Subscription>;
  std::function<void(const Message &)> callback;
};

class Node {
 public:
  explicit Node(const std::string &name, const NodeOptions &options = NodeOptions())
      : name_(name), options_(options) {}

  template <class Value>
  Value declare_parameter(const std::string &name, const Value &otherwise) {
    declared.push_back(name);
    for (const Parameter &given : options_.parameter_overrides()) {
      if (given.get_name() != name) continue;
      const Value *value = std::get_if<Value>(&given.value());
      if (value == nullptr) throw std::runtime_error("parameter '" + name + "' has invalid type");
      return *value;
    }
    return otherwise;
  }
  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string &topic, const QoS &) {
    const auto made = std::make_shared<Publisher<Message>>();
    topics_[topic] = made;
    return made;
  }
  template <class Message, class Callback>
  typename Subscription<Message>::SharedPtr create_subscription(const std::string &topic, const QoS &,
                                                                Callback &&callback) {
    const auto made = std::make_shared<Subscription<Message>>();
    made->callback = std::forward<Callback>(callback);
    topics_[topic] = made;
    return made;
  }
  Clock::SharedPtr get_clock() { return clock_; }
  Logger get_logger() const { return logger_; }

  // What the test reads and sends.
  std::vector<std::string> declared;
  template <class Message>
  std::vector<Message> &published(const std::string &topic) {
    return std::static_pointer_cast<Publisher<Message>>(topics_.at(topic))->messages;
  }
  template <class Message>
  void send(const std::string &topic, const Message &message) {
    std::static_pointer_cast<Subscription<Message>>(topics_.at(topic))->callback(message);
  }

 private:
  std::string name_;
  NodeOptions options_;
  Clock::SharedPtr clock_ = std::make_shared<Clock>();
  Logger logger_;
  std::map<std::string, std::shared_ptr<void>> topics_;
};

inline void init(int, char **) {}
inline void spin(const std::shared_ptr<Node> &) {}
inline bool shutdown() { return true; }

}  // namespace rclcpp

#endif
