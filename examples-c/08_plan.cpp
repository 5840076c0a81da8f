// Hangs a mug on a hook with a gripper: finds the best pose to which the arm can bring it, and the path
// there, or says why there is none: ./08_plan mug.obj hook.obj
#include <cmath>
#include <cstdio>
#include <hangpose.hpp>
#include <vector>

#include "obj_file.hpp"  // ObjFile: vertices and triangles

static int fail(const hangpose::error &why) {
  std::fprintf(stderr, "%s: %s: %s\n", hangpose_status_string(why.status()), why.field(), why.message());
  return 1;
}

// Stands for the inverse kinematics of a controller: the hand reaches what is near the shoulder.
struct Arm {
  hangpose::vec3 shoulder;
  float reach;
  int asked = 0;

  bool operator()(const hangpose::vec3 &at, const hangpose::quaternion &) noexcept {
    ++asked;
    return std::hypot(at[0] - shoulder[0], at[1] - shoulder[1], at[2] - shoulder[2]) < reach;
  }
};

static void print(const char *what, const hangpose::view<const hangpose::waypoint> &path) {
  for (const hangpose::waypoint &at : path) {
    const auto &p = at.position;
    const auto &q = at.quaternion;
    std::printf("%s %6.2f s: (%.3f, %.3f, %.3f) m, quaternion (%.3f, %.3f, %.3f, %.3f) xyzw\n", what,
                at.seconds, p[0], p[1], p[2], q[0], q[1], q[2], q[3]);
  }
}

int main(int count, char **arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: %s object.obj supporter.obj\n", arguments[0]);
    return 2;
  }
  const ObjFile mug_file(arguments[1]), hook_file(arguments[2]);
  const hangpose::params params;
  const auto mug = hangpose::object::create({mug_file.vertices, mug_file.triangles}, params);
  if (!mug) return fail(mug.error());
  std::vector<hangpose::vec3> points(10000), normals(10000);
  if (auto drawn = hangpose::sample({hook_file.vertices, hook_file.triangles}, points, normals); !drawn)
    return fail(drawn.error());
  const auto hook = hangpose::supporter::create({points, normals}, params);
  if (!hook) return fail(hook.error());

  // ANCHOR: plan
  // Two fingers on the cup, which open by 15 mm each, and the palm behind it. The hand leaves away from the
  // handle.
  const hangpose::capsule hand[3] = {
      {{-0.10f, 0.048f, 0.05f}, {0.0f, 0.048f, 0.05f}, 0.006f, {0.0f, 0.015f, 0.0f}},
      {{-0.10f, -0.048f, 0.05f}, {0.0f, -0.048f, 0.05f}, 0.006f, {0.0f, -0.015f, 0.0f}},
      {{-0.10f, -0.048f, 0.05f}, {-0.10f, 0.048f, 0.05f}, 0.015f, {0.0f, 0.0f, 0.0f}},
  };
  Arm arm{{0.5f, 0.0f, 0.0f}, 0.7f};
  hangpose::motion motion;
  motion.start_at({0.4f, 0.0f, -0.1f}, {0.0f, 0.0f, 0.0f, 1.0f});
  motion.hold_with({hand, {-0.15f, 0.0f, 0.0f}}).accept_if(arm);

  hangpose::pose poses[10];
  hangpose::plan_failure failures[10];
  std::vector<hangpose::waypoint> waypoints(1000);
  const auto found = hangpose::predict_reachable(*mug, *hook, hangpose::request(), params, motion, poses,
                                                 failures, waypoints);
  // ANCHOR_END: plan
  if (!found) return fail(found.error());
  if (found->status == HANGPOSE_REJECTED) {
    std::printf("nothing hangs: %s\n", found->prediction.reason());
    return 3;
  }
  for (std::size_t i = 0; i < found->prediction.poses.size(); ++i)
    std::printf("pose %zu: %s\n", i + 1, hangpose_plan_reason_string(failures[i].reason));
  if (found->status != HANGPOSE_OK) return 3;

  const hangpose::plan &plan = found->plan;
  print("mug ", plan.object);
  print("hand", plan.gripper);
  const hangpose::waypoint &resting = plan.object[plan.object.size() - 1];
  std::printf("the mug is lowered from %.2f s on and rests at %.2f s, when the hand opens\n",
              plan.object[plan.release].seconds, resting.seconds);
  std::printf("the arm was asked %d times; the clearance is %.1f mm\n", arm.asked, 1000 * plan.clearance);
  return 0;
}
