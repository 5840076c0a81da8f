// From depth images to a pose. Draws depth images of a jar with a handle, which is held alone, and of a hook.
// Fuses the first into a closed mesh, takes the points of the others, and hangs the jar on the hook.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <hangpose.hpp>
#include <vector>

using hangpose::vec3;

// The camera: its depths are tenths of a millimetre.
static constexpr hangpose::camera CAMERA = {200, 150, {230.0f, 230.0f}, {99.5f, 74.5f}, {}};
static constexpr float UNIT = 1e-4f, AWAY = 0.3f;

// Signed distances from the surfaces, metres.
static float bar(const vec3 &p, const vec3 &from, const vec3 &to, float radius) {
  float along = 0, length = 0, away = 0;  // the last two squared
  for (std::size_t i = 0; i < 3; ++i) {
    along += (p[i] - from[i]) * (to[i] - from[i]);
    length += (to[i] - from[i]) * (to[i] - from[i]);
  }
  const float t = std::clamp(along / length, 0.0f, 1.0f);
  for (std::size_t i = 0; i < 3; ++i) away += std::pow(p[i] - from[i] - t * (to[i] - from[i]), 2.0f);
  return std::sqrt(away) - radius;
}
static float jar(const vec3 &p) {
  const float body = std::max(std::hypot(p[0], p[1]) - 0.03f, std::fabs(p[2]) - 0.04f);
  const float handle = std::hypot(std::hypot(p[0] - 0.03f, p[2]) - 0.026f, p[1]) - 0.004f;
  return std::min(body, handle);
}
static float hook(const vec3 &p) {
  return std::min(bar(p, {0, 0, 0}, {0.08f, 0, 0}, 0.004f), bar(p, {0.08f, 0, 0}, {0.09f, 0, 0.03f}, 0.004f));
}

// A depth image of a shape at the origin, seen from `yaw` around the z axis and `pitch` above the horizon,
// radians.
struct View {
  std::vector<std::uint16_t> depths;
  vec3 position;
  std::array<float, 4> quaternion;

  View(float (*distance)(const vec3 &), float yaw, float pitch) {
    // The axes of the camera, and the rotation onto them: about x by `tilt`, then about z by `yaw`.
    const float sy = std::sin(yaw), cy = std::cos(yaw), sp = std::sin(pitch), cp = std::cos(pitch);
    const vec3 right = {cy, sy, 0}, down = {sy * sp, -cy * sp, -cp}, forward = {-sy * cp, cy * cp, -sp};
    const float tilt = -1.5707963f - pitch;
    const float st = std::sin(tilt / 2), ct = std::cos(tilt / 2), s = std::sin(yaw / 2),
                c = std::cos(yaw / 2);
    quaternion = {c * st, s * st, s * ct, c * ct};
    for (std::size_t i = 0; i < 3; ++i) position[i] = -AWAY * forward[i];
    for (std::uint32_t pixel = 0; pixel < CAMERA.width * CAMERA.height; ++pixel) {
      const float x = (static_cast<float>(pixel % CAMERA.width) - CAMERA.centre[0]) / CAMERA.focal[0];
      const float y = (static_cast<float>(pixel / CAMERA.width) - CAMERA.centre[1]) / CAMERA.focal[1];
      // Goes along the ray by the distance to the surface until there is none left.
      float depth = 0, left = 1;
      for (int step = 0; step < 100 && left > UNIT && depth < 2 * AWAY; ++step) {
        vec3 p;
        for (std::size_t i = 0; i < 3; ++i)
          p[i] = position[i] + depth * (x * right[i] + y * down[i] + forward[i]);
        left = distance(p);
        depth += left / std::sqrt(x * x + y * y + 1);
      }
      depths.push_back(left > UNIT ? 0 : static_cast<std::uint16_t>(depth / UNIT));
    }
  }
  hangpose::depth_image image() const {
    return hangpose::depth_image(CAMERA, depths, UNIT).seen_from(position, quaternion);
  }
};

static int fail(const hangpose::error &why) {
  std::fprintf(stderr, "%s: %s: %s\n", hangpose_status_string(why.status()), why.field(), why.message());
  return 1;
}

int main() {
  // The object: its closed mesh. A dense volume knows what is free, so it can guess what no image shows.
  std::vector<View> views;
  for (const float yaw : {0.4f, 1.9f, 3.5f, 5.1f}) views.emplace_back(jar, yaw, 0.5f);
  std::vector<hangpose::depth_image> images;
  for (const View &view : views) images.push_back(view.image());
  hangpose::volume_settings settings(0.002f);
  settings.dense = settings.missing_is_free = 1;
  const auto room = hangpose::room(images, settings);
  if (!room) return fail(room.error());
  settings.crop_to(*room);
  auto volume = hangpose::volume::create(settings, settings.blocks());
  if (!volume) return fail(volume.error());
  for (const auto &image : images)
    if (const auto pixels = volume->integrate(image); !pixels) return fail(pixels.error());
  if (const auto guessed = volume->complete(); !guessed) return fail(guessed.error());
  const auto surface = volume->find_surface();
  if (!surface) return fail(surface.error());
  const hangpose::params params;
  std::vector<vec3> cameras;
  for (const View &view : views) cameras.push_back(view.position);
  hangpose::mesh mesh(surface->vertices(), surface->triangles());
  const auto object = hangpose::object::create(mesh.seen_from(cameras), params);
  if (!object) return fail(object.error());

  // The supporter: points with normals. The viewpoints tell which sides no camera saw.
  const View sides[] = {{hook, 0.5f, 0.6f}, {hook, -0.6f, 0.3f}};
  const hangpose::depth_image both[] = {sides[0].image(), sides[1].image()};
  const auto seen = hangpose::depth_points::create(both);
  if (!seen) return fail(seen.error());
  const auto supporter = hangpose::supporter::create(
      hangpose::cloud(seen->points(), seen->normals()).seen_from(seen->viewpoints()), params);
  if (!supporter) return fail(supporter.error());

  hangpose::pose poses[5];
  const auto found = hangpose::predict(*object, *supporter, params, poses);
  if (!found) return fail(found.error());
  if (found->poses.empty()) {
    std::printf("nothing hangs: %s\n", found->reason());
    return 3;
  }
  const hangpose::pose &best = found->poses[0];
  const auto &p = best.position;
  const auto &q = best.quaternion;
  std::printf("a mesh of %zu triangles and a cloud of %zu points\n", surface->triangles().size(),
              seen->points().size());
  std::printf("release at (%.4f, %.4f, %.4f) m, quaternion (%.4f, %.4f, %.4f, %.4f) xyzw: ", p[0], p[1], p[2],
              q[0], q[1], q[2], q[3]);
  std::printf("hangs with probability %.3f, up to a tilt of %.2f rad\n", best.probability,
              best.margin.least_tilt);
  return 0;
}
