// hangpose for C++17 and later: the functions of hangpose.h with RAII memory and [[nodiscard]] results.
// Header-only; throws nothing and needs neither exceptions nor RTTI. If Eigen/Geometry is included before
// this header, poses convert to Eigen and points from it. Units, frames and thread safety are those of
// hangpose.h.
//
//   hangpose::params params;                                       // or hangpose::params::paper()
//   auto object = hangpose::object::create({vertices, triangles}, params);
//   auto supporter = hangpose::supporter::create({points}, params);
//   if (!object) return fail(object.error().message());
//   hangpose::pose poses[10];
//   auto found = hangpose::predict(*object, *supporter, params, poses);
//
// hangpose::request says how and where the object shall hang and what it must not touch.
// hangpose::predict_many hangs several objects at once. examples-c/09_requests.cpp is a complete program.
//
// hangpose::plan_path finds a way to a pose without collisions, and hangpose::predict_reachable the best pose
// that has one; hangpose::motion says from where, with which gripper, and what the arm can reach.
// examples-c/08_plan.cpp is a complete program.
//
// From depth images: hangpose::volume gives the mesh of an object, hangpose::depth_points the cloud of a
// supporter. examples-c/07_depth_images.cpp is a complete program.
#ifndef HANGPOSE_HPP
#define HANGPOSE_HPP

#include <array>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "hangpose.h"
#include "hangpose/values.hpp"

namespace hangpose {

// A row of an array: x, y, z of a point or direction, or three vertex indices.
using vec3 = std::array<float, 3>;
using triangle = std::array<std::uint32_t, 3>;
// x, y, z, w of a rotation.
using quaternion = std::array<float, 4>;
// Lower and upper corner of a box, metres.
using box = std::array<vec3, 2>;

using camera = hangpose_camera;
using pose = hangpose_pose;
using capsule = hangpose_capsule;
using waypoint = hangpose_waypoint;
using plan_failure = hangpose_plan_failure;
using limits = hangpose_limits;
using object_info = hangpose_object_info;
using object_site = hangpose_object_site;
using object_contact = hangpose_object_contact;
using object_symmetry = hangpose_symmetry;
using supporter_info = hangpose_supporter_info;
using supporter_site = hangpose_supporter_site;
using supporter_contact = hangpose_supporter_contact;

// The constants of the method: the fields of hangpose_params, set to the defaults of a profile.
struct params : hangpose_params {
  params() noexcept : params(HANGPOSE_PROFILE_DEFAULT) {}
  static params paper() noexcept { return params(HANGPOSE_PROFILE_PAPER); }

 private:
  // If the header and the library have different versions, struct_size stays 0, and the first call that takes
  // the params reports the mismatch.
  explicit params(hangpose_profile profile) noexcept : hangpose_params() {
    hangpose_params_init(this, sizeof(hangpose_params), profile, HANGPOSE_ABI_VERSION, nullptr);
  }
};

// Lets other threads read the progress of a call and cancel it, and limits the work of each call. Neither
// copied nor moved. All functions but reset may be called from any thread at any time.
class monitor {
 public:
  explicit monitor(std::uint64_t work_limit = HANGPOSE_NO_WORK_LIMIT) noexcept { reset(work_limit); }
  monitor(const monitor &) = delete;
  monitor &operator=(const monitor &) = delete;

  // Resets progress and cancellation for the next call. No call may be using the monitor.
  void reset(std::uint64_t work_limit = HANGPOSE_NO_WORK_LIMIT) noexcept {
    hangpose_monitor_init(&monitor_, sizeof monitor_, work_limit, nullptr);
  }
  void cancel() noexcept { hangpose_monitor_cancel(&monitor_); }
  bool is_cancelled() const noexcept { return hangpose_monitor_is_cancelled(&monitor_) != 0; }
  // Lends the calls that use this monitor a second thread until reset: a struct that stays where it is until then,
  // for example hangpose::second_thread of hangpose/second_thread.hpp. The results are the same.
  result<done> use(const hangpose_threads &threads) noexcept {
    error why;
    if (hangpose_monitor_use_threads(&monitor_, &threads, why.out()) != HANGPOSE_OK) return why;
    return done{};
  }
  // Progress of the current call, from 0 to 1.
  float progress() const noexcept { return hangpose_monitor_progress(&monitor_); }

  hangpose_monitor *get() noexcept { return &monitor_; }

 private:
  hangpose_monitor monitor_{};
};

namespace internal {

inline std::uint32_t count(std::size_t size) noexcept {
  // A count that does not fit is above the maximum, so the call reports it.
  return size < UINT32_MAX ? static_cast<std::uint32_t>(size) : UINT32_MAX;
}

// The first number of dense rows, or null if there are none.
template <class T, std::size_t N>
auto numbers(view<std::array<T, N>> rows) noexcept {
  return rows.empty() ? nullptr : rows.data()->data();
}
template <class T, std::size_t N>
auto numbers(view<const std::array<T, N>> rows) noexcept {
  static_assert(sizeof(std::array<T, N>) == N * sizeof(T), "rows are dense");
  return rows.empty() ? nullptr : rows.data()->data();
}

// Calls `call` with a struct to fill in and returns the struct or the error.
template <class T, class Call>
result<T> filled(Call &&call) noexcept {
  T out{};
  error why;
  out.struct_size = sizeof out;
  if (call(&out, why.out()) < 0) return why;
  return out;
}

// A deleter that does nothing: a model needs no free, it ends with its memory.
struct leave {
  template <class T>
  void operator()(T *) const noexcept {}
};
template <class T>
using handle = std::unique_ptr<T, leave>;

inline hangpose_monitor *get(monitor *watch) noexcept { return watch == nullptr ? nullptr : watch->get(); }

// hangpose_limits_of, after a check that header and library have the same version.
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
  return error::of(HANGPOSE_ERROR_MEMORY, "memory",
                   "the heap has too little memory left: free some, or pass static memory");
}

}  // namespace internal

// A triangle mesh in the caller's arrays, which must outlive it.
struct mesh : hangpose_mesh {
  mesh(view<const vec3> vertex_rows, view<const triangle> triangle_rows) noexcept : hangpose_mesh() {
    struct_size = sizeof(hangpose_mesh);
    vertex_count = internal::count(vertex_rows.size());
    triangle_count = internal::count(triangle_rows.size());
    vertices = internal::numbers(vertex_rows);
    triangles = internal::numbers(triangle_rows);
  }
  // Sets the positions of the cameras whose images the mesh was made from, metres.
  mesh &seen_from(view<const vec3> positions) noexcept {
    viewpoint_count = internal::count(positions.size());
    viewpoints = internal::numbers(positions);
    return *this;
  }
};

// A point cloud in the caller's arrays, which must outlive it: points, and one normal for each point or none.
struct cloud : hangpose_cloud {
  cloud(view<const vec3> point_rows, view<const vec3> normal_rows = {}) noexcept
      : hangpose_cloud(), normal_count(internal::count(normal_rows.size())) {
    struct_size = sizeof(hangpose_cloud);
    point_count = internal::count(point_rows.size());
    points = internal::numbers(point_rows);
    normals = internal::numbers(normal_rows);
  }
  // Sets the positions of the sensor, metres. Estimated normals face them.
  cloud &seen_from(view<const vec3> positions) noexcept {
    viewpoint_count = internal::count(positions.size());
    viewpoints = internal::numbers(positions);
    return *this;
  }
  // Limits the places to hang on to points whose mark is not 0.
  cloud &hang_on(view<const unsigned char> point_marks) noexcept {
    mark_count = internal::count(point_marks.size());
    marks = point_marks.data();
    return *this;
  }
  // Limits the places to hang on to a box: its lower and its upper corner, metres.
  cloud &hang_within(const box &corners) noexcept {
    region = corners[0].data();
    return *this;
  }
  // Checks the numbers of normals and marks, which the C interface cannot see.
  result<done> check() const noexcept {
    if (normal_count != 0 && normal_count != point_count)
      return error::of(HANGPOSE_ERROR_COUNT, "cloud.normals",
                       "the number of normals differs from the number of points: pass one normal for each "
                       "point, or none");
    if (marks != nullptr && mark_count != point_count)
      return error::of(HANGPOSE_ERROR_COUNT, "cloud.marks",
                       "the number of marks differs from the number of points: pass one mark for each point, "
                       "or none");
    return done{};
  }

  std::uint32_t normal_count;
  std::uint32_t mark_count = 0;
};

// An analysed object. Any number of threads may use it at the same time.
class object {
 public:
  // Analyses `mesh` in memory from the heap, which the object owns.
  static result<object> create(const mesh &mesh, const params &params, monitor *watch = nullptr) noexcept {
    auto within = internal::limits_of(params, &mesh, nullptr);
    if (!within) return within.error();
    memory own = memory::own(hangpose_object_bytes(&*within));
    if (own.data() == nullptr) return internal::no_memory();
    return create(mesh, params, std::move(own), watch);
  }
  // Analyses `mesh` in `room`, which has at least hangpose_object_bytes or HANGPOSE_OBJECT_BYTES.
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
  // Hanging site `index`, less than info()->sites; site 0 is encircled best.
  result<object_site> site(std::uint32_t index) const noexcept {
    return internal::filled<object_site>(
        [&](auto *out, auto *why) { return hangpose_object_get_site(get(), index, out, why); });
  }
  // Contact candidate `index`, less than info()->contacts; candidate 0 has the greatest capture.
  result<object_contact> contact(std::uint32_t index) const noexcept {
    return internal::filled<object_contact>(
        [&](auto *out, auto *why) { return hangpose_object_get_contact(get(), index, out, why); });
  }
  // Detected symmetry `index`, less than info()->symmetries.
  result<object_symmetry> symmetry(std::uint32_t index) const noexcept {
    return internal::filled<object_symmetry>(
        [&](auto *out, auto *why) { return hangpose_object_get_symmetry(get(), index, out, why); });
  }
  const hangpose_object *get() const noexcept { return handle_.get(); }

 private:
  object() noexcept = default;
  memory memory_;
  internal::handle<hangpose_object> handle_;
};

// An analysed supporter. Any number of threads may use it at the same time, except during update.
class supporter {
 public:
  // Analyses `cloud` in memory from the heap, which the supporter owns and which has room for updates of up
  // to `most_points` points.
  static result<supporter> create(const cloud &cloud, const params &params, monitor *watch = nullptr,
                                  std::size_t most_points = 0) noexcept {
    auto within = internal::limits_of(params, nullptr, &cloud);
    if (!within) return within.error();
    if (within->points < internal::count(most_points)) within->points = internal::count(most_points);
    memory own = memory::own(hangpose_supporter_bytes(&*within));
    if (own.data() == nullptr) return internal::no_memory();
    return create(cloud, params, std::move(own), watch);
  }
  // Analyses `cloud` in `room`, which has at least hangpose_supporter_bytes or HANGPOSE_SUPPORTER_BYTES.
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

  // Replaces the cloud by a new one and analyses it in the same memory. After an error the supporter is
  // unchanged; after HANGPOSE_CANCELLED it is empty until an update succeeds.
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
  // Support site `index`, less than info()->sites; site 0 is the thinnest.
  result<supporter_site> site(std::uint32_t index) const noexcept {
    return internal::filled<supporter_site>(
        [&](auto *out, auto *why) { return hangpose_supporter_get_site(get(), index, out, why); });
  }
  // Contact candidate `index`, less than info()->contacts.
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

// The contacts at which the supporter carries the object in the rest pose.
inline view<const hangpose_contact> contacts(const pose &hanging) noexcept {
  return {hanging.contacts, hanging.contact_count};
}

// A part of an object or of a supporter, in its coordinates, metres. Its arrays are the caller's and must
// outlive it. The default is everywhere.
struct region : hangpose_region {
  region() noexcept : hangpose_region() {}
  // What is in a box: its lower and its upper corner.
  static region within(const box &corners) noexcept {
    region made;
    made.shape = HANGPOSE_REGION_BOX;
    for (std::size_t i = 0; i < 3; ++i) made.low[i] = corners[0][i], made.high[i] = corners[1][i];
    return made;
  }
  // What is within `distance` of points: of one point for "here".
  static region around(view<const vec3> rows, float distance) noexcept {
    region made;
    made.shape = HANGPOSE_REGION_POINTS;
    made.point_count = internal::count(rows.size());
    made.points = internal::numbers(rows);
    made.radius = distance;
    return made;
  }
  // What is within `distance` of the points with these indices: of a part of a cloud.
  static region around(view<const vec3> rows, view<const std::uint32_t> chosen, float distance) noexcept {
    region made = around(rows, distance);
    made.choose(chosen);
    return made;
  }
  // What is within `distance` of the triangles with these indices: of a part of a mesh.
  static region around(view<const vec3> vertex_rows, view<const triangle> triangle_rows,
                       view<const std::uint32_t> chosen, float distance) noexcept {
    region made = around(vertex_rows, distance);
    made.shape = HANGPOSE_REGION_TRIANGLES;
    made.triangle_count = internal::count(triangle_rows.size());
    made.triangles = internal::numbers(triangle_rows);
    made.choose(chosen);
    return made;
  }

 private:
  // A null pointer would choose all, so no indices are not null, and the call reports that there are none.
  void choose(view<const std::uint32_t> chosen) noexcept {
    static constexpr std::uint32_t none = 0;
    index_count = internal::count(chosen.size());
    indices = chosen.empty() ? &none : chosen.data();
  }
};

// An object that hangs already at the rest pose of a prediction, or at the release pose if it has no rest.
// The object must outlive it.
struct hung : hangpose_hung {
  hung(const hangpose::object &hanging, const pose &at) noexcept : hangpose_hung() {
    object = hanging.get();
    for (std::size_t i = 0; i < 3; ++i) position[i] = at.has_rest ? at.rest_position[i] : at.position[i];
    for (std::size_t i = 0; i < 4; ++i)
      quaternion[i] = at.has_rest ? at.rest_quaternion[i] : at.quaternion[i];
  }
};
static_assert(sizeof(hung) == sizeof(hangpose_hung), "an array of one is an array of the other");

// What predict looks for: the fields of hangpose_request, set to anything anywhere. Its arrays are the
// caller's and must outlive it.
struct request : hangpose_request {
  request() noexcept : hangpose_request() { hangpose_request_init(this, sizeof(hangpose_request), nullptr); }
  // Asks for a straight way of `length` metres to the release pose that is free of collisions and differs by
  // at most `angle` radians from `direction`, in supporter coordinates.
  request &come_along(const vec3 &direction, float angle, float length) noexcept {
    has_approach = 1;
    for (std::size_t i = 0; i < 3; ++i) approach_direction[i] = direction[i];
    approach_angle = angle;
    approach_length = length;
    return *this;
  }
  // Keeps the object away from points of things near the supporter, metres, in supporter coordinates.
  request &avoid(view<const vec3> scene) noexcept {
    scene_point_count = internal::count(scene.size());
    scene_points = internal::numbers(scene);
    return *this;
  }
  // Keeps the object away from objects that hang already, up to HANGPOSE_MAX_HUNG.
  request &avoid(view<const hangpose::hung> objects) noexcept {
    hung_count = internal::count(objects.size());
    hung = objects.data();
    return *this;
  }
  // Gives the symmetries of the object, up to HANGPOSE_MAX_SYMMETRIES or none, in place of those that were
  // detected. Set the struct_size of each.
  request &with_symmetries(view<const object_symmetry> given) noexcept {
    has_symmetries = 1;
    symmetry_count = internal::count(given.size());
    symmetries = given.data();
    return *this;
  }
};

// Result of predict: poses, best first, or the reason why there are none.
class prediction : public hangpose_prediction {
 public:
  prediction() noexcept : hangpose_prediction() { struct_size = sizeof(hangpose_prediction); }
  // HANGPOSE_OK, HANGPOSE_REJECTED, HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT.
  hangpose_status status = HANGPOSE_OK;
  // The poses found, at the front of the caller's array.
  view<pose> poses;
  // A text for people: why the object hangs nowhere.
  const char *reason() const noexcept { return hangpose_stage_string(stage); }
};

namespace internal {

// Working memory from the heap for a prediction of so many poses.
inline result<memory> work_for(const supporter &supporter, const params &params, std::size_t poses) noexcept {
  auto within = limits_of(params, nullptr, nullptr);
  if (!within) return within.error();
  const auto info = supporter.info();
  if (!info) return info.error();
  within->points = info->points;
  within->poses = count(poses);
  memory work = memory::own(hangpose_predict_bytes(&*within));
  if (work.data() == nullptr) return no_memory();
  return work;
}

}  // namespace internal

// Finds poses in which the object hangs on the supporter as it was asked for and writes them to `poses`.
// `work` is working memory of at least hangpose_predict_bytes or HANGPOSE_PREDICT_BYTES. Both models must
// have been analysed with these params.
inline result<prediction> predict(const object &object, const supporter &supporter, const request &asked,
                                  const params &params, view<pose> poses, const memory &work,
                                  monitor *watch = nullptr) noexcept {
  prediction found;
  error why;
  found.status = hangpose_predict(object.get(), supporter.get(), &asked, &params, work.data(), work.size(),
                                  internal::get(watch), poses.data(), sizeof(pose),
                                  internal::count(poses.size()), &found, why.out());
  if (found.status < 0) return why;
  found.poses = view<pose>(poses.data(), found.pose_count);
  return found;
}

// The same with working memory from the heap.
inline result<prediction> predict(const object &object, const supporter &supporter, const request &asked,
                                  const params &params, view<pose> poses, monitor *watch = nullptr) noexcept {
  const auto work = internal::work_for(supporter, params, poses.size());
  if (!work) return work.error();
  return predict(object, supporter, asked, params, poses, *work, watch);
}

// The same for anything anywhere.
inline result<prediction> predict(const object &object, const supporter &supporter, const params &params,
                                  view<pose> poses, const memory &work, monitor *watch = nullptr) noexcept {
  return predict(object, supporter, request(), params, poses, work, watch);
}
inline result<prediction> predict(const object &object, const supporter &supporter, const params &params,
                                  view<pose> poses, monitor *watch = nullptr) noexcept {
  return predict(object, supporter, request(), params, poses, watch);
}

// Result of predict_many: how many of the objects hang, or the reason why none does.
class many : public hangpose_many {
 public:
  many() noexcept : hangpose_many() { struct_size = sizeof(hangpose_many); }
  // HANGPOSE_OK, HANGPOSE_REJECTED, HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT.
  hangpose_status status = HANGPOSE_OK;
  // A text for people: why the first object without a pose has none.
  const char *reason() const noexcept { return hangpose_stage_string(stage); }
};

// Finds poses in which all objects hang on the supporter at once, each as it was asked for: poses[i] is for
// objects[i], whose has_pose is 0 if there is no room for it. The arrays have the same length, up to
// HANGPOSE_MAX_HUNG; copies are the same pointer several times. `work` is as for predict with as many poses.
inline result<many> predict_many(view<const object *const> objects, const supporter &supporter,
                                 const request &asked, const params &params, view<pose> poses,
                                 const memory &work, monitor *watch = nullptr) noexcept {
  if (poses.size() != objects.size()) {
    return error::of(
        HANGPOSE_ERROR_COUNT, "poses",
        "the number of poses differs from the number of objects: pass arrays of the same length");
  }
  const hangpose_object *handles[HANGPOSE_MAX_HUNG] = {};
  for (std::size_t i = 0; i < objects.size() && i < HANGPOSE_MAX_HUNG; ++i) {
    handles[i] = objects[i] == nullptr ? nullptr : objects[i]->get();
  }
  many found;
  error why;
  found.status = hangpose_predict_many(handles, internal::count(objects.size()), supporter.get(), &asked,
                                       &params, work.data(), work.size(), internal::get(watch), poses.data(),
                                       sizeof(pose), &found, why.out());
  if (found.status < 0) return why;
  return found;
}

// The same with working memory from the heap.
inline result<many> predict_many(view<const object *const> objects, const supporter &supporter,
                                 const request &asked, const params &params, view<pose> poses,
                                 monitor *watch = nullptr) noexcept {
  const auto work = internal::work_for(supporter, params, poses.size());
  if (!work) return work.error();
  return predict_many(objects, supporter, asked, params, poses, *work, watch);
}

// A gripper as capsules that are fixed to the object while it is held, in object coordinates. The capsules
// are the caller's and must outlive it.
struct gripper {
  view<const capsule> parts;
  // Displacement with which the opened gripper leaves the object, metres; zeros leave it to the planner.
  vec3 retreat{};
};

// How the object moves to the pose in which it hangs, or away from it: the fields of hangpose_motion, set to
// the defaults. What it points to is the caller's and must outlive it.
struct motion : hangpose_motion {
  motion() noexcept : hangpose_motion() { hangpose_motion_init(this, sizeof(hangpose_motion), nullptr); }
  // Sets where the object is grasped, or, to take it off, where it is brought: position, metres, and rotation
  // from object to supporter coordinates.
  motion &start_at(const vec3 &at, const quaternion &turned) noexcept {
    has_start = 1;
    for (std::size_t i = 0; i < 3; ++i) start_position[i] = at[i];
    for (std::size_t i = 0; i < 4; ++i) start_quaternion[i] = turned[i];
    return *this;
  }
  // Plans for the hand that holds the object, too.
  motion &hold_with(const gripper &hand) noexcept {
    part_count = internal::count(hand.parts.size());
    parts = hand.parts.data();
    for (std::size_t i = 0; i < 3; ++i) retreat[i] = hand.retreat[i];
    return *this;
  }
  // Keeps all of the object in a box: its lower and its upper corner, metres, in supporter coordinates.
  motion &stay_within(const box &corners) noexcept {
    has_workspace = 1;
    for (std::size_t i = 0; i < 3; ++i) workspace_low[i] = corners[0][i], workspace_high[i] = corners[1][i];
    return *this;
  }
  // Asks `decide(const vec3 &position, const quaternion &rotation)`, the caller's inverse kinematics, whether
  // the robot can bring the object to a pose. `decide` is called as hangpose_accepts says, is not copied, and
  // must outlive the motion. An exception of it ends the program.
  template <class Decide>
  motion &accept_if(Decide &decide) noexcept {
    static_assert(std::is_invocable_r_v<bool, Decide &, const vec3 &, const quaternion &>,
                  "the callback takes a position and a rotation and returns a bool");
    context = const_cast<void *>(static_cast<const void *>(std::addressof(decide)));
    accepts = [](void *of, const float *p, const float *q) noexcept -> std::int32_t {
      const bool is_accepted =
          (*static_cast<Decide *>(of))(vec3{p[0], p[1], p[2]}, quaternion{q[0], q[1], q[2], q[3]});
      return is_accepted ? 1 : 0;
    };
    return *this;
  }
};

// Result of plan_path: the path, or the reason why there is none.
class plan : public hangpose_plan {
 public:
  plan() noexcept : hangpose_plan() { struct_size = sizeof(hangpose_plan); }
  // HANGPOSE_OK, HANGPOSE_NO_PATH, HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT.
  hangpose_status status = HANGPOSE_OK;
  // The waypoints of the object, then those of the opened gripper, in the caller's array.
  view<const waypoint> object, gripper;
  // A text for people: why there is no path.
  const char *reason() const noexcept { return hangpose_plan_reason_string(failure.reason); }

  // Sets the views on the front of the caller's array.
  void view_on(view<const waypoint> all) noexcept {
    object = view<const waypoint>(all.data(), waypoint_count);
    gripper = view<const waypoint>(all.data() + waypoint_count, gripper_waypoint_count);
  }
};

namespace internal {

// Working memory from the heap for planning, of as many bytes as `query` says.
inline result<memory> work_for_plan(const supporter &supporter, const request &asked, const params &params,
                                    const motion &moved, std::size_t poses, std::size_t waypoints,
                                    std::size_t (*query)(const hangpose_limits *)) noexcept {
  auto within = limits_of(params, nullptr, nullptr);
  if (!within) return within.error();
  const auto info = supporter.info();
  if (!info) return info.error();
  within->points = info->points;
  within->poses = count(poses);
  within->scene_points = asked.scene_point_count;
  within->nodes = moved.nodes;
  within->waypoints = count(waypoints);
  memory work = memory::own(query(&*within));
  if (work.data() == nullptr) return no_memory();
  return work;
}

}  // namespace internal

// Plans a path of the object to `goal` and writes it to `waypoints`. The scene and the objects that hang
// already of `asked` are obstacles. `work` is working memory of at least hangpose_plan_bytes or
// HANGPOSE_PLAN_BYTES. The error HANGPOSE_ERROR_CAPACITY says how many waypoints are needed.
inline result<plan> plan_path(const object &object, const supporter &supporter, const request &asked,
                              const params &params, const motion &moved, const pose &goal,
                              view<waypoint> waypoints, const memory &work,
                              monitor *watch = nullptr) noexcept {
  plan found;
  error why;
  found.status = hangpose_plan_path(object.get(), supporter.get(), &asked, &params, &moved, &goal,
                                    work.data(), work.size(), internal::get(watch), waypoints.data(),
                                    sizeof(waypoint), internal::count(waypoints.size()), &found, why.out());
  if (found.status < 0) return why;
  found.view_on({waypoints.data(), waypoints.size()});
  return found;
}

// The same with working memory from the heap.
inline result<plan> plan_path(const object &object, const supporter &supporter, const request &asked,
                              const params &params, const motion &moved, const pose &goal,
                              view<waypoint> waypoints, monitor *watch = nullptr) noexcept {
  const auto work =
      internal::work_for_plan(supporter, asked, params, moved, 0, waypoints.size(), &hangpose_plan_bytes);
  if (!work) return work.error();
  return plan_path(object, supporter, asked, params, moved, goal, waypoints, *work, watch);
}

// Result of predict_reachable.
struct reachable {
  // HANGPOSE_OK with a path, HANGPOSE_NO_PATH with poses none of which has one, HANGPOSE_REJECTED without
  // poses, HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT.
  hangpose_status status = HANGPOSE_OK;
  // All poses, best first, or the reason why there are none.
  hangpose::prediction prediction;
  // The plan of the last pose for which a path was planned, poses[plan.pose_index].
  hangpose::plan plan;
};

// Does what predict does, then plans a path to one pose after another until one has a path. `failures` has
// one element for each of `poses`, or none: why the poses without a path have none. `work` is working memory
// of at least hangpose_reachable_bytes or HANGPOSE_REACHABLE_BYTES.
inline result<reachable> predict_reachable(const object &object, const supporter &supporter,
                                           const request &asked, const params &params, const motion &moved,
                                           view<pose> poses, view<plan_failure> failures,
                                           view<waypoint> waypoints, const memory &work,
                                           monitor *watch = nullptr) noexcept {
  if (!failures.empty() && failures.size() != poses.size()) {
    return error::of(HANGPOSE_ERROR_COUNT, "failures",
                     "the number of failures differs from the number of poses: pass arrays of the same "
                     "length, or no failures");
  }
  reachable found;
  error why;
  found.status = hangpose_predict_reachable(
      object.get(), supporter.get(), &asked, &params, &moved, work.data(), work.size(), internal::get(watch),
      poses.data(), sizeof(pose), internal::count(poses.size()), failures.empty() ? nullptr : failures.data(),
      sizeof(plan_failure), waypoints.data(), sizeof(waypoint), internal::count(waypoints.size()),
      &found.prediction, &found.plan, why.out());
  if (found.status < 0) return why;
  found.prediction.status = found.plan.status = found.status;
  found.prediction.poses = view<pose>(poses.data(), found.prediction.pose_count);
  found.plan.view_on({waypoints.data(), waypoints.size()});
  return found;
}

// The same with working memory from the heap.
inline result<reachable> predict_reachable(const object &object, const supporter &supporter,
                                           const request &asked, const params &params, const motion &moved,
                                           view<pose> poses, view<plan_failure> failures,
                                           view<waypoint> waypoints, monitor *watch = nullptr) noexcept {
  const auto work = internal::work_for_plan(supporter, asked, params, moved, poses.size(), waypoints.size(),
                                            &hangpose_reachable_bytes);
  if (!work) return work.error();
  return predict_reachable(object, supporter, asked, params, moved, poses, failures, waypoints, *work, watch);
}

// Fills `points` and `normals`, arrays of the same length, with evenly spread samples of a mesh: the cloud of
// a supporter whose mesh is known.
inline result<done> sample(const mesh &mesh, view<vec3> points, view<vec3> normals,
                           std::uint64_t seed = 0) noexcept {
  if (points.size() != normals.size()) {
    return error::of(
        HANGPOSE_ERROR_COUNT, "normals",
        "the number of normals differs from the number of points: pass arrays of the same length");
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

// A depth image in the caller's arrays, which must outlive it: depths row by row, in units of `unit` metres.
struct depth_image : hangpose_depth_image {
  depth_image(const hangpose_camera &taken_by, view<const std::uint16_t> depth_rows, float unit) noexcept
      : hangpose_depth_image() {
    struct_size = sizeof(hangpose_depth_image);
    camera = taken_by;
    depth_count = internal::count(depth_rows.size());
    depths = depth_rows.data();
    scale = unit;
    quaternion[3] = 1.0f;
  }
  // Sets the pose of the camera in world coordinates: its position, metres, and the quaternion x, y, z, w
  // that rotates camera coordinates into world coordinates. Without this call they are the same.
  depth_image &seen_from(const vec3 &at, const hangpose::quaternion &turned) noexcept {
    for (std::size_t i = 0; i < 3; ++i) position[i] = at[i];
    for (std::size_t i = 0; i < 4; ++i) quaternion[i] = turned[i];
    return *this;
  }
  // Takes surfaces only from pixels whose label is `wanted`.
  depth_image &masked(view<const unsigned char> label_rows, unsigned char wanted) noexcept {
    label_count = internal::count(label_rows.size());
    labels = label_rows.data();
    label = wanted;
    return *this;
  }
};
static_assert(sizeof(depth_image) == sizeof(hangpose_depth_image),
              "an array of one is an array of the other");

// Resolution and extent of a volume: the defaults for voxels of a size in metres.
struct volume_settings : hangpose_volume_settings {
  explicit volume_settings(float voxel_size) noexcept : hangpose_volume_settings() {
    hangpose_volume_settings_init(this, sizeof(hangpose_volume_settings), voxel_size, nullptr);
  }
  // Limits the volume to a box, which must outlive the settings.
  volume_settings &crop_to(const box &corners) noexcept {
    crop = corners[0].data();
    return *this;
  }
  // The number of blocks that a dense volume takes.
  std::uint32_t blocks() const noexcept { return hangpose_volume_blocks(this); }
};

// A crop box around an object that is held alone, with room for what a completion may fill.
inline result<box> room(view<const depth_image> images, const volume_settings &settings) noexcept {
  box corners{};
  error why;
  if (hangpose_volume_room(images.data(), internal::count(images.size()), &settings, corners[0].data(),
                           why.out()) != HANGPOSE_OK)
    return why;
  return corners;
}

// The surface of a volume, in memory from the heap that it owns.
class surface {
 public:
  view<const vec3> vertices() const noexcept { return rows<vec3>(vertices_, counts_.vertex_count); }
  view<const triangle> triangles() const noexcept {
    return rows<triangle>(triangles_, counts_.triangle_count);
  }
  // For each vertex 1 if an image shows it, 0 if it was guessed.
  view<const unsigned char> seen() const noexcept { return rows<unsigned char>(seen_, counts_.vertex_count); }

 private:
  friend class volume;
  surface() noexcept : counts_() { counts_.struct_size = sizeof counts_; }
  template <class T>
  static view<const T> rows(const memory &of, std::uint32_t count) noexcept {
    return {static_cast<const T *>(of.data()), count};
  }
  memory vertices_, triangles_, seen_;
  hangpose_mesh counts_;
};

// Depth images that are fused into a truncated signed distance volume.
class volume {
 public:
  // Creates an empty volume in memory from the heap, which it owns. It has room for so many blocks: for a
  // dense volume settings.blocks().
  static result<volume> create(const volume_settings &settings, std::uint32_t blocks) noexcept {
    memory own = memory::own(hangpose_volume_bytes(blocks));
    if (own.data() == nullptr) return internal::no_memory();
    return create(settings, blocks, std::move(own));
  }
  // Creates it in `room`, which has at least hangpose_volume_bytes or HANGPOSE_VOLUME_BYTES.
  static result<volume> create(const volume_settings &settings, std::uint32_t blocks, memory room) noexcept {
    volume made;
    error why;
    hangpose_volume *handle = nullptr;
    hangpose_volume_create(room.data(), room.size(), &settings, blocks, &handle, why.out());
    if (handle == nullptr) return why;
    made.handle_.reset(handle);
    made.memory_ = std::move(room);
    made.blocks_ = blocks;
    return made;
  }

  // Fuses an image. The value is the number of pixels with a surface within the volume. After an error, the
  // volume is unchanged.
  result<std::uint32_t> integrate(const depth_image &image, monitor *watch = nullptr) noexcept {
    std::uint32_t pixels = 0;
    error why;
    if (hangpose_volume_integrate(handle_.get(), &image, internal::get(watch), &pixels, why.out()) !=
        HANGPOSE_OK)
      return why;
    return pixels;
  }
  // Guesses what no image shows of an object that is held alone, with `work` of at least
  // hangpose_complete_bytes. After an error, the volume is unchanged.
  result<done> complete(const memory &work, monitor *watch = nullptr) noexcept {
    error why;
    if (hangpose_volume_complete(handle_.get(), work.data(), work.size(), internal::get(watch), why.out()) !=
        HANGPOSE_OK)
      return why;
    return done{};
  }
  // The same with working memory from the heap.
  result<done> complete(monitor *watch = nullptr) noexcept {
    memory work = memory::own(hangpose_complete_bytes(blocks_));
    if (work.data() == nullptr) return internal::no_memory();
    return complete(work, watch);
  }
  // Finds the surface, in memory from the heap.
  result<surface> find_surface(monitor *watch = nullptr) const noexcept {
    memory work = memory::own(hangpose_surface_bytes(blocks_));
    if (work.data() == nullptr) return internal::no_memory();
    surface found;
    error why;
    hangpose_mesh &counts = found.counts_;
    auto find = [&] {
      return hangpose_volume_surface(
          get(), work.data(), work.size(), internal::get(watch), static_cast<float *>(found.vertices_.data()),
          counts.vertex_count, static_cast<std::uint32_t *>(found.triangles_.data()), counts.triangle_count,
          static_cast<unsigned char *>(found.seen_.data()), &counts, why.out());
    };
    if (find() != HANGPOSE_OK) return why;
    found.vertices_ = memory::own(counts.vertex_count * sizeof(vec3));
    found.triangles_ = memory::own(counts.triangle_count * sizeof(triangle));
    found.seen_ = memory::own(counts.vertex_count);
    if (found.vertices_.data() == nullptr || found.triangles_.data() == nullptr ||
        found.seen_.data() == nullptr)
      return internal::no_memory();
    if (find() != HANGPOSE_OK) return why;
    return found;
  }
  const hangpose_volume *get() const noexcept { return handle_.get(); }

 private:
  volume() noexcept = default;
  memory memory_;
  internal::handle<hangpose_volume> handle_;
  std::uint32_t blocks_ = 0;
};

// Which pixels of a depth image become points, set to the defaults.
struct points_settings : hangpose_points_settings {
  points_settings() noexcept : hangpose_points_settings() {
    hangpose_points_settings_init(this, sizeof(hangpose_points_settings), nullptr);
  }
  // Limits the points to a box, which must outlive the settings.
  points_settings &crop_to(const box &corners) noexcept {
    crop = corners[0].data();
    return *this;
  }
};

// The points that depth images show, in memory from the heap that it owns: the cloud of a supporter.
class depth_points {
 public:
  static result<depth_points> create(view<const depth_image> images,
                                     const points_settings &settings = {}) noexcept {
    depth_points found;
    error why;
    const auto count = internal::count(images.size());
    std::size_t pixels = 0;
    for (const auto &image : images) pixels += image.depth_count;
    found.points_ = memory::own(pixels * sizeof(vec3));
    found.normals_ = memory::own(pixels * sizeof(vec3));
    found.viewpoints_ = memory::own(count * sizeof(vec3));
    if (found.points_.data() == nullptr || found.normals_.data() == nullptr ||
        found.viewpoints_.data() == nullptr)
      return internal::no_memory();
    if (hangpose_depth_points(images.data(), count, &settings, static_cast<float *>(found.points_.data()),
                              static_cast<float *>(found.normals_.data()), internal::count(pixels),
                              static_cast<float *>(found.viewpoints_.data()), &found.counts_,
                              why.out()) != HANGPOSE_OK)
      return why;
    return found;
  }
  view<const vec3> points() const noexcept { return rows(points_, counts_.point_count); }
  view<const vec3> normals() const noexcept { return rows(normals_, counts_.point_count); }
  view<const vec3> viewpoints() const noexcept { return rows(viewpoints_, counts_.viewpoint_count); }

 private:
  depth_points() noexcept : counts_() { counts_.struct_size = sizeof counts_; }
  static view<const vec3> rows(const memory &of, std::uint32_t count) noexcept {
    return {static_cast<const vec3 *>(of.data()), count};
  }
  memory points_, normals_, viewpoints_;
  hangpose_cloud counts_;
};

#if defined(EIGEN_GEOMETRY_MODULE_H) || defined(EIGEN_GEOMETRY_H)

namespace internal {

inline Eigen::Isometry3f isometry(const float (&position)[3], const float (&quaternion)[4]) {
  Eigen::Isometry3f made = Eigen::Isometry3f::Identity();
  made.linear() = Eigen::Quaternionf(Eigen::Map<const Eigen::Vector4f>(quaternion)).toRotationMatrix();
  made.translation() = Eigen::Map<const Eigen::Vector3f>(position);
  return made;
}

}  // namespace internal

// The release pose: maps object coordinates to supporter coordinates.
inline Eigen::Isometry3f to_eigen(const pose &hanging) {
  return internal::isometry(hanging.position, hanging.quaternion);
}
// The rest pose; NaN if hangpose_pose.has_rest is 0.
inline Eigen::Isometry3f rest_to_eigen(const pose &hanging) {
  return internal::isometry(hanging.rest_position, hanging.rest_quaternion);
}

// The pose of a waypoint.
inline Eigen::Isometry3f to_eigen(const waypoint &at) {
  return internal::isometry(at.position, at.quaternion);
}

// A view of the points, normals or triangles in the columns of a matrix, which must outlive the view.
inline view<const vec3> columns(const Eigen::Matrix<float, 3, Eigen::Dynamic> &matrix) noexcept {
  return {reinterpret_cast<const vec3 *>(matrix.data()), static_cast<std::size_t>(matrix.cols())};
}
inline view<const triangle> columns(const Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic> &matrix) noexcept {
  return {reinterpret_cast<const triangle *>(matrix.data()), static_cast<std::size_t>(matrix.cols())};
}

#endif

}  // namespace hangpose

#endif  // HANGPOSE_HPP
