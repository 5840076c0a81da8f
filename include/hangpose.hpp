// hangpose for C++17 and later: what is in hangpose.h, with memory that looks after itself and results that
// cannot be overlooked. Header-only; throws nothing, needs neither exceptions nor RTTI. Where Eigen's
// Geometry is included before this header, poses and points convert to and from it.
//
//   hangpose::params params;                                       // or hangpose::params::paper()
//   auto object = hangpose::object::create({vertices, triangles}, params);
//   auto supporter = hangpose::supporter::create({points}, params);
//   if (!object) return fail(object.error().message());
//   hangpose::pose poses[10];
//   auto found = hangpose::predict(*object, *supporter, params, poses);
#ifndef HANGPOSE_HPP
#define HANGPOSE_HPP

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "hangpose.h"
#include "hangpose/values.hpp"

namespace hangpose {

// A point, a direction, or a row of three indices: what arrays are made of.
using vec3 = std::array<float, 3>;
using triangle = std::array<std::uint32_t, 3>;

using pose = hangpose_pose;
using limits = hangpose_limits;
using object_info = hangpose_object_info;
using object_site = hangpose_object_site;
using object_contact = hangpose_object_contact;
using supporter_info = hangpose_supporter_info;
using supporter_site = hangpose_supporter_site;
using supporter_contact = hangpose_supporter_contact;

// The constants of the method: fields of hangpose_params.
struct params : hangpose_params {
  params() noexcept : params(HANGPOSE_PROFILE_DEFAULT) {}
  static params paper() noexcept { return params(HANGPOSE_PROFILE_PAPER); }

 private:
  // If the library is another than the header, struct_size stays 0, and the first call that takes this says
  // why.
  explicit params(hangpose_profile profile) noexcept : hangpose_params() {
    hangpose_params_init(this, sizeof(hangpose_params), profile, HANGPOSE_ABI_VERSION, nullptr);
  }
};

// Lets another thread see how far a call is and stop it, and bounds its work. Stays where it is.
class monitor {
 public:
  explicit monitor(std::uint64_t work_limit = HANGPOSE_NO_WORK_LIMIT) noexcept { reset(work_limit); }
  monitor(const monitor &) = delete;
  monitor &operator=(const monitor &) = delete;

  // Ready for the next call; none may run with it.
  void reset(std::uint64_t work_limit = HANGPOSE_NO_WORK_LIMIT) noexcept {
    hangpose_monitor_init(&monitor_, sizeof monitor_, work_limit, nullptr);
  }
  void cancel() noexcept { hangpose_monitor_cancel(&monitor_); }
  bool is_cancelled() const noexcept { return hangpose_monitor_is_cancelled(&monitor_) != 0; }
  // From 0 to 1.
  float progress() const noexcept { return hangpose_monitor_progress(&monitor_); }

  hangpose_monitor *get() noexcept { return &monitor_; }

 private:
  hangpose_monitor monitor_{};
};

namespace internal {

inline std::uint32_t count(std::size_t size) noexcept {
  // What does not fit is more than there may be, and the call says so.
  return size < UINT32_MAX ? static_cast<std::uint32_t>(size) : UINT32_MAX;
}

// The first number of rows that lie dense, or null where there are none.
template <class T, std::size_t N>
auto numbers(view<std::array<T, N>> rows) noexcept {
  return rows.empty() ? nullptr : rows.data()->data();
}
template <class T, std::size_t N>
auto numbers(view<const std::array<T, N>> rows) noexcept {
  static_assert(sizeof(std::array<T, N>) == N * sizeof(T), "rows lie dense");
  return rows.empty() ? nullptr : rows.data()->data();
}

// A struct that a call fills in.
template <class T, class Call>
result<T> filled(Call &&call) noexcept {
  T out{};
  error why;
  out.struct_size = sizeof out;
  if (call(&out, why.out()) < 0) return why;
  return out;
}

// A handle is not freed, it goes with its memory.
struct leave {
  template <class T>
  void operator()(T *) const noexcept {}
};
template <class T>
using handle = std::unique_ptr<T, leave>;

inline hangpose_monitor *get(monitor *watch) noexcept { return watch == nullptr ? nullptr : watch->get(); }

// hangpose_limits_of, and that header and library are of one version.
inline result<limits> limits_of(const hangpose_params &params, const hangpose_mesh *mesh,
                                const hangpose_cloud *cloud) noexcept {
  error why;
  if (hangpose_check_abi(HANGPOSE_ABI_VERSION) != HANGPOSE_OK) {
    hangpose_params unused;
    hangpose_params_init(&unused, sizeof unused, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION, why.out());
    return why;
  }
  return filled<limits>(
      [&](auto *out, auto *detail) { return hangpose_limits_of(&params, mesh, cloud, out, detail); });
}

inline error no_memory() noexcept {
  return error::of(HANGPOSE_ERROR_MEMORY, "memory", "the heap has not enough memory left");
}

}  // namespace internal

// A triangle mesh of someone else's.
struct mesh : hangpose_mesh {
  mesh(view<const vec3> vertex_rows, view<const triangle> triangle_rows) noexcept : hangpose_mesh() {
    struct_size = sizeof(hangpose_mesh);
    vertex_count = internal::count(vertex_rows.size());
    triangle_count = internal::count(triangle_rows.size());
    vertices = internal::numbers(vertex_rows);
    triangles = internal::numbers(triangle_rows);
  }
};

// A point cloud of someone else's. Normals, if there are any, one for each point, or else there are none.
struct cloud : hangpose_cloud {
  cloud(view<const vec3> point_rows, view<const vec3> normal_rows = {},
        const vec3 *seen_from = nullptr) noexcept
      : hangpose_cloud(), normal_count(internal::count(normal_rows.size())) {
    struct_size = sizeof(hangpose_cloud);
    point_count = internal::count(point_rows.size());
    points = internal::numbers(point_rows);
    normals = internal::numbers(normal_rows);
    viewpoint = seen_from == nullptr ? nullptr : seen_from->data();
  }
  // The first thing that C cannot see.
  result<done> check() const noexcept {
    if (normal_count == 0 || normal_count == point_count) return done{};
    return error::of(HANGPOSE_ERROR_COUNT, "cloud.normals",
                     "there is not one normal for each point: give as many normals as points, or none");
  }

  std::uint32_t normal_count;
};

// An object, analysed. Any number of threads may use it at once.
class object {
 public:
  // In its own memory from the heap.
  static result<object> create(const mesh &mesh, const params &params, monitor *watch = nullptr) noexcept {
    auto within = internal::limits_of(params, &mesh, nullptr);
    if (!within) return within.error();
    memory own = memory::own(hangpose_object_bytes(&*within));
    if (own.data() == nullptr) return internal::no_memory();
    return create(mesh, params, std::move(own), watch);
  }
  // In memory of hangpose_object_bytes, or HANGPOSE_OBJECT_BYTES.
  static result<object> create(const mesh &mesh, const params &params, memory room,
                               monitor *watch = nullptr) noexcept {
    auto within = internal::limits_of(params, &mesh, nullptr);
    if (!within) return within.error();
    object made;
    error why;
    hangpose_object *handle = nullptr;
    hangpose_object_create(room.data(), room.size(), &mesh, &params, internal::get(watch), &handle,
                           why.out());
    if (handle == nullptr) return why;
    made.handle_.reset(handle);
    made.memory_ = std::move(room);
    return made;
  }

  result<object_info> info() const noexcept {
    return internal::filled<object_info>(
        [&](auto *out, auto *why) { return hangpose_object_get_info(get(), out, why); });
  }
  // Below info()->sites, the best encircled first.
  result<object_site> site(std::uint32_t index) const noexcept {
    return internal::filled<object_site>(
        [&](auto *out, auto *why) { return hangpose_object_get_site(get(), index, out, why); });
  }
  // Below info()->contacts, the one that catches best first.
  result<object_contact> contact(std::uint32_t index) const noexcept {
    return internal::filled<object_contact>(
        [&](auto *out, auto *why) { return hangpose_object_get_contact(get(), index, out, why); });
  }
  const hangpose_object *get() const noexcept { return handle_.get(); }

 private:
  object() noexcept = default;
  memory memory_;
  internal::handle<hangpose_object> handle_;
};

// A supporter, analysed. Any number of threads may use it at once, except while it is updated.
class supporter {
 public:
  // In its own memory from the heap, with room for updates with up to `most_points` points.
  static result<supporter> create(const cloud &cloud, const params &params, monitor *watch = nullptr,
                                  std::size_t most_points = 0) noexcept {
    auto within = internal::limits_of(params, nullptr, &cloud);
    if (!within) return within.error();
    if (within->points < internal::count(most_points)) within->points = internal::count(most_points);
    memory own = memory::own(hangpose_supporter_bytes(&*within));
    if (own.data() == nullptr) return internal::no_memory();
    return create(cloud, params, std::move(own), watch);
  }
  // In memory of hangpose_supporter_bytes, or HANGPOSE_SUPPORTER_BYTES.
  static result<supporter> create(const cloud &cloud, const params &params, memory room,
                                  monitor *watch = nullptr) noexcept {
    auto within = internal::limits_of(params, nullptr, &cloud);
    if (!within) return within.error();
    if (auto checked = cloud.check(); !checked) return checked.error();
    supporter made;
    error why;
    hangpose_supporter *handle = nullptr;
    hangpose_supporter_create(room.data(), room.size(), &cloud, &params, internal::get(watch), &handle,
                              why.out());
    if (handle == nullptr) return why;
    made.handle_.reset(handle);
    made.memory_ = std::move(room);
    return made;
  }

  // A new cloud in place of the old one, in the same memory. After an error the supporter is what it was;
  // when it is cancelled it is empty until an update goes through.
  result<done> update(const cloud &cloud, const params &params, monitor *watch = nullptr) noexcept {
    if (auto checked = cloud.check(); !checked) return checked.error();
    error why;
    auto status = hangpose_supporter_update(handle_.get(), &cloud, &params, internal::get(watch), why.out());
    if (status < 0 || status == HANGPOSE_CANCELLED) return why;
    return done{};
  }

  result<supporter_info> info() const noexcept {
    return internal::filled<supporter_info>(
        [&](auto *out, auto *why) { return hangpose_supporter_get_info(get(), out, why); });
  }
  // Below info()->sites, the thinnest first.
  result<supporter_site> site(std::uint32_t index) const noexcept {
    return internal::filled<supporter_site>(
        [&](auto *out, auto *why) { return hangpose_supporter_get_site(get(), index, out, why); });
  }
  // Below info()->contacts.
  result<supporter_contact> contact(std::uint32_t index) const noexcept {
    return internal::filled<supporter_contact>(
        [&](auto *out, auto *why) { return hangpose_supporter_get_contact(get(), index, out, why); });
  }
  const hangpose_supporter *get() const noexcept { return handle_.get(); }

 private:
  supporter() noexcept = default;
  memory memory_;
  internal::handle<hangpose_supporter> handle_;
};

// Where the supporter bears the object at rest.
inline view<const hangpose_contact> contacts(const pose &hanging) noexcept {
  return {hanging.contacts, hanging.contact_count};
}

// What predict found: poses, best first, or why there are none.
class prediction : public hangpose_prediction {
 public:
  prediction() noexcept : hangpose_prediction() { struct_size = sizeof(hangpose_prediction); }
  // HANGPOSE_OK, _REJECTED, _CANCELLED or _WORK_LIMIT.
  hangpose_status status = HANGPOSE_OK;
  // At the front of the poses that were handed in.
  view<pose> poses;
  // For people: why nothing hangs.
  const char *reason() const noexcept { return hangpose_stage_string(stage); }
};

// Finds poses in which the object hangs on the supporter, in memory of hangpose_predict_bytes, or
// HANGPOSE_PREDICT_BYTES.
inline result<prediction> predict(const object &object, const supporter &supporter, const params &params,
                                  view<pose> poses, const memory &work, monitor *watch = nullptr) noexcept {
  prediction found;
  error why;
  found.status =
      hangpose_predict(object.get(), supporter.get(), &params, work.data(), work.size(), internal::get(watch),
                       poses.data(), sizeof(pose), internal::count(poses.size()), &found, why.out());
  if (found.status < 0) return why;
  found.poses = view<pose>(poses.data(), found.pose_count);
  return found;
}

// The same in memory from the heap.
inline result<prediction> predict(const object &object, const supporter &supporter, const params &params,
                                  view<pose> poses, monitor *watch = nullptr) noexcept {
  auto within = internal::limits_of(params, nullptr, nullptr);
  if (!within) return within.error();
  const auto info = supporter.info();
  if (!info) return info.error();
  within->points = info->points;
  within->poses = internal::count(poses.size());
  memory work = memory::own(hangpose_predict_bytes(&*within));
  if (work.data() == nullptr) return internal::no_memory();
  return predict(object, supporter, params, poses, work, watch);
}

// Draws evenly spread points and their normals, as many as there is room for, from a supporter that is known
// as a mesh.
inline result<done> sample(const mesh &mesh, view<vec3> points, view<vec3> normals,
                           std::uint64_t seed = 0) noexcept {
  if (points.size() != normals.size()) {
    return error::of(HANGPOSE_ERROR_COUNT, "normals", "there is not room for one normal for each point");
  }
  const auto count = internal::count(points.size());
  memory work = memory::own(hangpose_sample_bytes(count));
  if (work.data() == nullptr) return internal::no_memory();
  error why;
  if (hangpose_mesh_sample(&mesh, seed, work.data(), work.size(), internal::numbers(points),
                           internal::numbers(normals), count, why.out()) < 0) {
    return why;
  }
  return done{};
}

#if defined(EIGEN_GEOMETRY_MODULE_H) || defined(EIGEN_GEOMETRY_H)

namespace internal {

inline Eigen::Isometry3f motion(const float (&position)[3], const float (&quaternion)[4]) {
  Eigen::Isometry3f motion = Eigen::Isometry3f::Identity();
  motion.linear() = Eigen::Quaternionf(Eigen::Map<const Eigen::Vector4f>(quaternion)).toRotationMatrix();
  motion.translation() = Eigen::Map<const Eigen::Vector3f>(position);
  return motion;
}

}  // namespace internal

// The motion from object to supporter coordinates, where the object is let go.
inline Eigen::Isometry3f to_eigen(const pose &hanging) {
  return internal::motion(hanging.position, hanging.quaternion);
}
// The same where it comes to rest; NaN where it has no rest.
inline Eigen::Isometry3f rest_to_eigen(const pose &hanging) {
  return internal::motion(hanging.rest_position, hanging.rest_quaternion);
}

// Points, normals or triangles in the columns of a matrix, which must outlive the view.
inline view<const vec3> columns(const Eigen::Matrix<float, 3, Eigen::Dynamic> &matrix) noexcept {
  return {reinterpret_cast<const vec3 *>(matrix.data()), static_cast<std::size_t>(matrix.cols())};
}
inline view<const triangle> columns(const Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic> &matrix) noexcept {
  return {reinterpret_cast<const triangle *>(matrix.data()), static_cast<std::size_t>(matrix.cols())};
}

#endif

}  // namespace hangpose

#endif  // HANGPOSE_HPP
