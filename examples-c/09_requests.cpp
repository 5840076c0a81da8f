// Hangs mugs on a mug tree, away from a wall: one where it is asked for, then three more at once beside it:
// ./09_requests mug.obj mug_tree.obj
#include <cstdio>
#include <hangpose.hpp>
#include <vector>

#include "obj_file.hpp"  // ObjFile: vertices and triangles

static int fail(const hangpose::error &why) {
  std::fprintf(stderr, "%s: %s: %s\n", hangpose_status_string(why.status()), why.field(), why.message());
  return 1;
}

// Points of a wall in the plane y = 0.12 m, 5 mm apart, as a camera would see them.
static std::vector<hangpose::vec3> wall() {
  std::vector<hangpose::vec3> points;
  for (int i = 0; i < 80; ++i)
    for (int k = 0; k < 80; ++k)
      points.push_back({0.005f * static_cast<float>(i) - 0.2f, 0.12f, 0.005f * static_cast<float>(k)});
  return points;
}

static void print(std::size_t number, const hangpose::pose &pose) {
  const auto &p = pose.position;
  std::printf("mug %zu: release at (%.4f, %.4f, %.4f) m, %s with probability %.3f; may be off by %.1f mm\n",
              number, p[0], p[1], p[2], hangpose_kind_string(pose.kind), pose.probability,
              1000 * pose.tolerance_position);
}

int main(int count, char **arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: %s object.obj supporter.obj\n", arguments[0]);
    return 2;
  }
  const ObjFile mug_file(arguments[1]), tree_file(arguments[2]);
  const hangpose::params params;
  const auto mug = hangpose::object::create({mug_file.vertices, mug_file.triangles}, params);
  if (!mug) return fail(mug.error());
  std::vector<hangpose::vec3> points(10000), normals(10000);
  if (auto drawn = hangpose::sample({tree_file.vertices, tree_file.triangles}, points, normals); !drawn)
    return fail(drawn.error());
  const auto tree = hangpose::supporter::create({points, normals}, params);
  if (!tree) return fail(tree.error());

  // ANCHOR: request
  // What stands around and hangs already must outlive the request, which points to it.
  const std::vector<hangpose::vec3> scene = wall(), here{{0.06f, 0.0f, 0.165f}};
  hangpose::request request;
  request.avoid(scene);
  request.allow = HANGPOSE_KIND_THREADED | HANGPOSE_KIND_HOOKED;

  // One mug on the peg that is asked for.
  request.on = hangpose::region::around(here, 0.03f);
  hangpose::pose best[1];
  const auto first = hangpose::predict(*mug, *tree, request, params, best);
  // ANCHOR_END: request
  if (!first) return fail(first.error());
  if (first->status == HANGPOSE_REJECTED) {
    std::printf("nothing hangs here: %s\n", first->reason());
    return 3;
  }
  print(1, best[0]);

  // Three more anywhere, all at once: clear of the first and of each other.
  const std::vector<hangpose::hung> hanging{{*mug, best[0]}};
  request.avoid(hanging);
  request.on = hangpose::region();
  const hangpose::object *const more[3] = {&*mug, &*mug, &*mug};
  hangpose::pose poses[3];
  const auto found = hangpose::predict_many(more, *tree, request, params, poses);
  if (!found) return fail(found.error());
  for (std::size_t i = 0; i < 3; ++i) {
    if (poses[i].has_pose) {
      print(i + 2, poses[i]);
    } else {
      std::printf("mug %zu: no room: %s\n", i + 2, found->reason());
    }
  }
  return found->placed > 0 ? 0 : 3;
}
