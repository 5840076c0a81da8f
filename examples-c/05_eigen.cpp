// Eigen for input and output: points in the columns of a matrix, poses as isometries. Include Eigen first.
#include <Eigen/Geometry>
#include <cstdio>
#include <hangpose.hpp>

#include "shapes.h"

int main() {
  Eigen::Matrix<float, 3, Eigen::Dynamic> vertices(3, RING_VERTICES), points(3, PEG_POINTS),
      normals(3, PEG_POINTS);
  Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic> triangles(3, RING_TRIANGLES);
  make_ring(0.03f, reinterpret_cast<float(*)[3]>(vertices.data()),
            reinterpret_cast<std::uint32_t(*)[3]>(triangles.data()));
  make_peg(0.004f, reinterpret_cast<float(*)[3]>(points.data()),
           reinterpret_cast<float(*)[3]>(normals.data()));

  const hangpose::params params;
  const auto ring =
      hangpose::object::create({hangpose::columns(vertices), hangpose::columns(triangles)}, params);
  const auto peg =
      hangpose::supporter::create({hangpose::columns(points), hangpose::columns(normals)}, params);
  if (!ring || !peg) {
    std::fprintf(stderr, "%s\n", (!ring ? ring.error() : peg.error()).message());
    return 1;
  }
  hangpose::pose poses[1];
  const auto found = hangpose::predict(*ring, *peg, params, poses);
  if (!found || found->poses.empty()) {
    std::fprintf(stderr, "%s\n", found ? found->reason() : found.error().message());
    return 1;
  }
  const Eigen::Isometry3f release = hangpose::to_eigen(found->poses[0]);
  const Eigen::Isometry3f rest = hangpose::rest_to_eigen(found->poses[0]);
  const auto info = ring->info();
  const Eigen::Map<const Eigen::Vector3f> centre_of_mass(info->centre_of_mass);
  const Eigen::Vector3f before = release * centre_of_mass, after = rest * centre_of_mass;
  std::printf("released, the ring's centre of mass sinks %.1f mm, to %.1f mm below the axis of the peg\n",
              1000.0 * static_cast<double>(before.z() - after.z()), -1000.0 * static_cast<double>(after.z()));
  return after.z() < 0 ? 0 : 1;
}
