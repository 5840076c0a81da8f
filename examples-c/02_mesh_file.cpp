// Predicts how the mesh in one file hangs on the mesh in another: ./02_mesh_file mug.obj hook.obj
#include <cstdio>
#include <hangpose.hpp>
#include <vector>

#include "obj_file.hpp"  // ObjFile: vertices and triangles

static int fail(const hangpose::error &why) {
  std::fprintf(stderr, "%s: %s: %s\n", hangpose_status_string(why.status()), why.field(), why.message());
  return 1;
}

int main(int count, char **arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: %s object.obj supporter.obj\n", arguments[0]);
    return 2;
  }
  const ObjFile mug(arguments[1]), hook(arguments[2]);
  const hangpose::params params;

  const auto object = hangpose::object::create({mug.vertices, mug.triangles}, params);
  if (!object) return fail(object.error());

  // A supporter is a point cloud, from a camera or, as here, sampled from a mesh.
  std::vector<hangpose::vec3> points(10000), normals(10000);
  if (auto drawn = hangpose::sample({hook.vertices, hook.triangles}, points, normals); !drawn)
    return fail(drawn.error());
  const auto supporter = hangpose::supporter::create({points, normals}, params);
  if (!supporter) return fail(supporter.error());

  hangpose::pose poses[5];
  const auto found = hangpose::predict(*object, *supporter, params, poses);
  if (!found) return fail(found.error());
  if (found->status == HANGPOSE_REJECTED) {
    std::printf("nothing hangs: %s\n", found->reason());
    return 3;
  }
  for (const hangpose::pose &pose : found->poses) {
    const auto &p = pose.position;
    const auto &q = pose.quaternion;
    std::printf("release at (%.4f, %.4f, %.4f) m, quaternion (%.4f, %.4f, %.4f, %.4f) xyzw: ", p[0], p[1],
                p[2], q[0], q[1], q[2], q[3]);
    std::printf("hangs with probability %.3f, up to a tilt of %.2f rad, contacts", pose.probability,
                pose.margin.least_tilt);
    for (const auto &contact : hangpose::contacts(pose)) {
      std::printf(" (%.4f, %.4f, %.4f)", contact.position[0], contact.position[1], contact.position[2]);
    }
    std::printf("\n");
  }
  return 0;
}
