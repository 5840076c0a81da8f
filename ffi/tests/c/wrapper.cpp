// Tests what hangpose.hpp adds to hangpose.h: ownership, and that every failure is reported.
#include <cstdio>
#include <cstring>
#include <hangpose.hpp>
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
  auto nothing = hangpose::predict(moved, *peg, params, hangpose::view<hangpose::pose>());
  CHECK(!nothing);

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

  std::vector<hangpose::vec3> drawn(500), drawn_normals(500);
  CHECK(hangpose::sample({vertices, triangles}, drawn, drawn_normals));
  drawn.resize(499);
  CHECK(!hangpose::sample({vertices, triangles}, drawn, drawn_normals));
  std::printf("wrapper: %d failures\n", failures);
  return failures;
}
