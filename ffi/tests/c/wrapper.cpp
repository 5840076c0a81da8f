// Tests what hangpose.hpp adds to hangpose.h: ownership, and that every failure is reported.
#include <cstdio>
#include <cstring>
#include <hangpose.hpp>
#include <hangpose/second_thread.hpp>
#include <utility>
#include <vector>
#if __cplusplus >= 202002L
#include <span>
#endif

#include "shapes.h"

static int failures = 0;
#define CHECK(is_right)                                                             \
  do {                                                                              \
    if (!(is_right)) std::printf("line %d: %s\n", __LINE__, #is_right), ++failures; \
  } while (false)

int main() {
  std::vector<hangpose::vec3> vertices(RING_VERTICES), points(PEG_POINTS), normals(PEG_POINTS);
  std::vector<hangpose::triangle> triangles(RING_TRIANGLES);
  make_ring(0.03f, reinterpret_cast<float(*)[3]>(vertices.data()),
            reinterpret_cast<std::uint32_t(*)[3]>(triangles.data()));
  make_peg(0.004f, reinterpret_cast<float(*)[3]>(points.data()),
           reinterpret_cast<float(*)[3]>(normals.data()));
  hangpose::params params;
  params.samples = 3000;
  params.voxels = 20000;

  // Empty and invalid inputs.
  const std::vector<hangpose::vec3> none;
  auto empty = hangpose::object::create({none, triangles}, params);
  CHECK(!empty && empty.error().status() == HANGPOSE_ERROR_COUNT);
  auto blank = hangpose::supporter::create({none}, params);
  CHECK(!blank && blank.error().status() == HANGPOSE_ERROR_COUNT);
  auto few =
      hangpose::supporter::create({points, hangpose::view<const hangpose::vec3>(normals.data(), 5)}, params);
  CHECK(!few && std::strcmp(few.error().field(), "cloud.normals") == 0);
  const std::vector<hangpose::vec3> nowhere{{0.0f, 0.0f, NAN}};
  auto seen = hangpose::supporter::create(hangpose::cloud(points).seen_from(nowhere), params);
  CHECK(!seen && std::strcmp(seen.error().field(), "cloud.viewpoints") == 0);
  const std::array<hangpose::vec3, 2> corners{{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 1.0f}}};
  auto within = hangpose::supporter::create(hangpose::cloud(points).hang_within(corners), params);
  CHECK(!within && std::strcmp(within.error().field(), "cloud.region") == 0);
  const std::vector<unsigned char> marks(3, 1);
  auto marked = hangpose::supporter::create(hangpose::cloud(points).hang_on(marks), params);
  CHECK(!marked && std::strcmp(marked.error().field(), "cloud.marks") == 0);
  hangpose::params wrong;
  wrong.max_collision = 2.0f;
  auto refused = hangpose::object::create({vertices, triangles}, wrong);
  CHECK(!refused && refused.error().detail().value == 2.0 && refused.error().detail().maximum == 1.0);

  // Owned memory, memory of the caller, and moved models.
  auto ring = hangpose::object::create({vertices, triangles}, params);
  CHECK(ring && ring->info() && ring->info()->is_closed == 1);
  hangpose::object moved = *std::move(ring);
  CHECK(moved.get() != nullptr && moved.contact(0) && !moved.contact(1000) && !moved.site(0));
  CHECK(moved.info()->symmetries == 2 && moved.symmetry(0)->fold == 0 && !moved.symmetry(2));
  CHECK(ring->get() == nullptr && !ring->info() && ring->info().error().status() == HANGPOSE_ERROR_NULL);
  std::vector<unsigned char> room(HANGPOSE_SUPPORTER_BYTES(PEG_POINTS));
  auto peg =
      hangpose::supporter::create({points, normals}, params, hangpose::memory(room.data(), room.size()));
  CHECK(peg && peg->info()->points == PEG_POINTS && peg->contact(0)->normal[2] > 0.0f);
  auto small = hangpose::supporter::create({points, normals}, params, hangpose::memory(room.data(), 100));
  CHECK(!small && small.error().status() == HANGPOSE_ERROR_MEMORY);

  hangpose::pose poses[3];
  auto found = hangpose::predict(moved, *peg, params, poses);
  CHECK(found && found->status == HANGPOSE_OK && found->poses.size() >= 1 && found->poses.data() == poses);
  CHECK(found->poses[0].has_rest == 1 && found->poses[0].probability >= params.min_probability);
  CHECK(!hangpose::contacts(found->poses[0]).empty() && found->poses[0].is_matched == 0);
  // Requests: the default is anything anywhere; each part of one reaches the call.
  hangpose::request request;
  hangpose::pose again[3];
  auto same = hangpose::predict(moved, *peg, request, params, again);
  CHECK(same && same->poses.size() == found->poses.size() && std::memcmp(again, poses, sizeof again) == 0);
  CHECK(poses[0].kind == HANGPOSE_KIND_THREADED && poses[0].tolerance_position > 0.0f);
  request.on = hangpose::region::within({{{-1.0f, 0.06f, -1.0f}, {1.0f, 1.0f, 1.0f}}});
  auto near_end = hangpose::predict(moved, *peg, request, params, again);
  CHECK(near_end && near_end->status == HANGPOSE_OK && hangpose::contacts(again[0])[0].position[1] >= 0.06f);
  const std::vector<hangpose::vec3> here{{0.0f, 0.01f, 0.004f}, {0.0f, 9.0f, 0.0f}};
  const std::vector<std::uint32_t> first{0}, no_indices, beyond{7};
  request.on = hangpose::region::around(here, first, 0.02f);
  auto near_start = hangpose::predict(moved, *peg, request, params, again);
  CHECK(near_start && near_start->status == HANGPOSE_OK &&
        hangpose::contacts(again[0])[0].position[1] <= 0.04f);
  request.on = hangpose::region::around(here, no_indices, 0.02f);
  auto chosen = hangpose::predict(moved, *peg, request, params, again);
  CHECK(!chosen && std::strcmp(chosen.error().field(), "request.on.index_count") == 0);
  request.on = hangpose::region();
  request.by = hangpose::region::around(vertices, triangles, beyond, 0.01f);
  CHECK(hangpose::predict(moved, *peg, request, params, again));
  request.by = hangpose::region::around(here, triangles, first, 0.01f);
  auto dangling = hangpose::predict(moved, *peg, request, params, again);
  CHECK(!dangling && dangling.error().status() == HANGPOSE_ERROR_INDEX);
  request.by = hangpose::region::around({}, 0.01f);
  auto no_points = hangpose::predict(moved, *peg, request, params, again);
  CHECK(!no_points && std::strcmp(no_points.error().field(), "request.by.point_count") == 0);
  request.by = hangpose::region();
  request.come_along({0.0f, 0.0f, -1.0f}, 0.0f, 0.1f);
  auto from_above = hangpose::predict(moved, *peg, request, params, again);
  CHECK(from_above && from_above->stage == HANGPOSE_STAGE_NO_APPROACH);
  request.has_approach = 0;
  request.avoid(hangpose::view<const hangpose::vec3>(nowhere));
  auto no_scene = hangpose::predict(moved, *peg, request, params, again);
  CHECK(!no_scene && std::strcmp(no_scene.error().field(), "request.scene_points") == 0);
  const std::vector<hangpose::hung> hanging{{moved, poses[0]}};
  request.avoid(none).avoid(hanging);
  auto beside = hangpose::predict(moved, *peg, request, params, again);
  CHECK(beside && beside->status == HANGPOSE_OK &&
        std::memcmp(again[0].rest_position, poses[0].rest_position, sizeof(hangpose::vec3)) != 0);
  // Several at once.
  request.hung_count = 0;
  const hangpose::object *const twice[2] = {&moved, &moved};
  hangpose::pose both[2];
  auto at_once = hangpose::predict_many(twice, *peg, request, params, both);
  CHECK(at_once && at_once->status == HANGPOSE_OK && at_once->placed == 2 && both[1].has_pose == 1);
  CHECK(at_once->stage == HANGPOSE_STAGE_NONE && at_once->distance_queries > 0);
  CHECK(std::memcmp(both[0].rest_position, both[1].rest_position, sizeof(hangpose::vec3)) != 0);
  auto unequal = hangpose::predict_many(twice, *peg, request, params, again);
  CHECK(!unequal && std::strcmp(unequal.error().field(), "poses") == 0);
  const hangpose::object *const missing[2] = {&moved, nullptr};
  auto no_object = hangpose::predict_many(missing, *peg, request, params, both);
  CHECK(!no_object && std::strcmp(no_object.error().field(), "objects") == 0);
  CHECK(no_object.error().detail().index == 1);
  auto nothing = hangpose::predict(moved, *peg, params, hangpose::view<hangpose::pose>());
  CHECK(!nothing);

  // Planning: each part of a motion reaches the call.
  hangpose::motion motion;
  hangpose::plan_failure reasons[3];
  std::vector<hangpose::waypoint> waypoints(400);
  const auto reached =
      hangpose::predict_reachable(moved, *peg, request, params, motion, again, reasons, waypoints);
  CHECK(reached && reached->status == HANGPOSE_OK && reached->plan.has_path == 1);
  CHECK(reached->plan.object.size() == reached->plan.waypoint_count && reached->plan.gripper.empty());
  CHECK(reached->prediction.poses.size() == found->poses.size() && reached->plan.clearance > 0.0f);
  CHECK(reasons[reached->plan.pose_index].reason == HANGPOSE_PLAN_FOUND);
  const hangpose::pose goal = again[reached->plan.pose_index];
  const hangpose::capsule ball[1] = {
      {{0.0f, -0.05f, 0.0f}, {0.0f, -0.05f, 0.0f}, 0.015f, {0.0f, -0.01f, 0.0f}}};
  int asked = 0;
  auto decide = [&asked](const hangpose::vec3 &at, const hangpose::quaternion &) {
    ++asked;
    return at[2] > -1.0f;
  };
  motion.start_at({0.0f, -0.25f, 0.1f}, {0.0f, 0.0f, 0.0f, 1.0f}).hold_with({ball, {0.0f, -0.1f, 0.0f}});
  motion.accept_if(decide).stay_within({{{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}}});
  const auto held = hangpose::plan_path(moved, *peg, request, params, motion, goal, waypoints);
  CHECK(held && held->status == HANGPOSE_OK && asked > 2 && !held->gripper.empty());
  CHECK(held->object[0].position[1] == -0.25f && held->object[0].seconds == 0.0f);
  const auto refuse = [](const hangpose::vec3 &, const hangpose::quaternion &) noexcept { return false; };
  motion.accept_if(refuse);
  const auto refused_path = hangpose::plan_path(moved, *peg, request, params, motion, goal, waypoints);
  CHECK(refused_path && refused_path->status == HANGPOSE_NO_PATH && refused_path->object.empty());
  CHECK(std::strcmp(refused_path->reason(), "the hanging pose is outside of the workspace") == 0);
  motion.accepts = nullptr;
  motion.stay_within({{{1.0f, -1.0f, -1.0f}, {2.0f, 1.0f, 1.0f}}});
  const auto elsewhere =
      hangpose::predict_reachable(moved, *peg, request, params, motion, again, {}, waypoints);
  CHECK(elsewhere && elsewhere->status == HANGPOSE_NO_PATH && elsewhere->plan.has_path == 0);
  const auto unequal_failures =
      hangpose::predict_reachable(moved, *peg, request, params, motion, again,
                                  hangpose::view<hangpose::plan_failure>(reasons, 2), waypoints);
  CHECK(!unequal_failures && std::strcmp(unequal_failures.error().field(), "failures") == 0);
  const auto short_path = hangpose::plan_path(moved, *peg, request, params, hangpose::motion(), goal,
                                              hangpose::view<hangpose::waypoint>(waypoints.data(), 1));
  CHECK(!short_path && short_path.error().status() == HANGPOSE_ERROR_CAPACITY);
  unsigned char drop[100];
  const auto no_memory = hangpose::plan_path(moved, *peg, request, params, hangpose::motion(), goal,
                                             waypoints, hangpose::memory(drop, sizeof drop));
  CHECK(!no_memory && no_memory.error().status() == HANGPOSE_ERROR_MEMORY);

#if __cplusplus >= 202002L
  const std::span<const hangpose::vec3> span(points);
  CHECK(hangpose::supporter::create({span, std::span(normals)}, params));
#endif

  // An update with more points needs room reserved at creation.
  auto growing = hangpose::supporter::create({hangpose::view<const hangpose::vec3>(points.data(), 1000)},
                                             params, nullptr, PEG_POINTS);
  CHECK(growing && growing->update({points, normals}, params));
  CHECK(growing->info()->points == PEG_POINTS);
  auto tight =
      hangpose::supporter::create({hangpose::view<const hangpose::vec3>(points.data(), 1000)}, params);
  CHECK(tight && !tight->update({points, normals}, params) && tight->info()->points == 1000);

  hangpose::monitor monitor;
  monitor.cancel();
  CHECK(monitor.is_cancelled());
  auto cancelled = hangpose::object::create({vertices, triangles}, params, &monitor);
  CHECK(!cancelled && cancelled.error().status() == HANGPOSE_CANCELLED);
  monitor.reset(1);
  CHECK(hangpose::object::create({vertices, triangles}, params, &monitor));
  auto stopped = hangpose::predict(moved, *peg, params, poses, &monitor);
  CHECK(stopped && stopped->status == HANGPOSE_WORK_LIMIT);

  // A second thread, alone and shared: the same bytes.
  const auto copy_of_found = hangpose::predict(moved, *peg, params, poses);
  CHECK(copy_of_found && copy_of_found->status == HANGPOSE_OK);
  hangpose::second_thread helper;
  auto predict_with_helper = [&] {
    hangpose::monitor threaded;
    bool is_same = static_cast<bool>(threaded.use(helper));
    hangpose::pose theirs[3];
    const auto ring_again = hangpose::object::create({vertices, triangles}, params, &threaded);
    const auto with_two = hangpose::predict(*ring_again, *peg, params, theirs, &threaded);
    is_same = is_same && with_two && with_two->poses.size() == copy_of_found->poses.size();
    is_same = is_same && with_two->distance_queries == copy_of_found->distance_queries;
    for (std::size_t i = 0; is_same && i < with_two->poses.size(); ++i)
      is_same = std::memcmp(&theirs[i], &poses[i], sizeof theirs[i]) == 0;
    return is_same;
  };
  CHECK(predict_with_helper());
  bool is_same_beside = false;
  std::thread beside_it([&] { is_same_beside = predict_with_helper(); });
  CHECK(predict_with_helper());
  beside_it.join();
  CHECK(is_same_beside);
  hangpose_threads no_function{sizeof(hangpose_threads), nullptr, nullptr};
  const auto no_join = monitor.use(no_function);
  CHECK(!no_join && std::strcmp(no_join.error().field(), "threads.join") == 0);

  std::vector<hangpose::vec3> drawn(500), drawn_normals(500);
  CHECK(hangpose::sample({vertices, triangles}, drawn, drawn_normals));
  drawn.resize(499);
  CHECK(!hangpose::sample({vertices, triangles}, drawn, drawn_normals));
  // Depth images of a square plate, 40 mm wide, half a metre before the camera.
  std::vector<std::uint16_t> depths(32 * 24, 0);
  for (std::size_t v = 8; v < 16; ++v)
    for (std::size_t u = 12; u < 20; ++u) depths[32 * v + u] = 500;
  const hangpose::camera camera = {32, 24, {100.0f, 100.0f}, {15.5f, 11.5f}, {}};
  const hangpose::depth_image plate(camera, depths, 0.001f);
  const hangpose::depth_image images[] = {
      plate, hangpose::depth_image(plate).seen_from({0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f, 0.0f})};
  hangpose::volume_settings settings(0.005f);
  CHECK(settings.truncation == 0.02f && settings.blocks() == 0);
  const auto crop = hangpose::room(images, settings);
  CHECK(crop && (*crop)[0][2] < 0.48f && (*crop)[1][2] > 0.52f && (*crop)[1][0] < 0.1f);
  CHECK(!hangpose::room({}, settings));
  settings.crop_to(*crop).dense = 1;
  settings.missing_is_free = 1;
  auto volume = hangpose::volume::create(settings, settings.blocks());
  CHECK(volume && volume->integrate(images[0]).value() == 64);
  const auto open = volume->find_surface();
  CHECK(open && !open->triangles().empty() && open->seen().size() == open->vertices().size());
  CHECK(volume->complete());
  const auto closed = volume->find_surface();
  CHECK(closed && closed->triangles().size() > open->triangles().size());
  auto solid = hangpose::object::create({closed->vertices(), closed->triangles()}, params);
  CHECK(solid && solid->info()->is_closed == 1);
  CHECK(hangpose::volume(*std::move(volume)).integrate(images[1]));
  CHECK(volume->get() == nullptr && volume->integrate(images[0]).error().status() == HANGPOSE_ERROR_NULL);
  auto no_room = hangpose::volume::create(settings, 1);
  CHECK(!no_room && no_room.error().status() == HANGPOSE_ERROR_CAPACITY);
  auto tiny = hangpose::volume::create(settings, settings.blocks(), hangpose::memory(room.data(), 100));
  CHECK(!tiny && tiny.error().status() == HANGPOSE_ERROR_MEMORY);
  settings.dense = 0;
  auto sparse = hangpose::volume::create(settings, 100);
  CHECK(sparse && sparse->find_surface()->vertices().empty());
  CHECK(!sparse->complete() && sparse->complete().error().status() == HANGPOSE_ERROR_SPARSE);
  const std::vector<unsigned char> labels(depths.size() - 1);
  auto shown = sparse->integrate(hangpose::depth_image(plate).masked(labels, 0));
  CHECK(!shown && std::strcmp(shown.error().field(), "image.label_count") == 0);
  auto short_image =
      sparse->integrate({camera, hangpose::view<const std::uint16_t>(depths.data(), 700), 0.001f});
  CHECK(!short_image && std::strcmp(short_image.error().field(), "image.depth_count") == 0);
  monitor.cancel();
  CHECK(sparse->integrate(plate, &monitor).error().status() == HANGPOSE_CANCELLED);
  auto visible = hangpose::depth_points::create(images);
  CHECK(visible && visible->points().size() == visible->normals().size() && !visible->points().empty());
  CHECK(visible->viewpoints().size() == 2 && visible->viewpoints()[1][2] == 1.0f);
  hangpose::points_settings nowhere_near;
  nowhere_near.max_depth = 0.1f;
  auto unseen = hangpose::depth_points::create(images, nowhere_near);
  CHECK(!unseen && unseen.error().status() == HANGPOSE_ERROR_BLANK);
  std::printf("wrapper: %d failures\n", failures);
  return failures;
}
