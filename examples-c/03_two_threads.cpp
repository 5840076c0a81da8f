// One supporter, many objects, two threads: both threads share one analysed supporter, and each has its own
// memory.
#include <atomic>
#include <cstdio>
#include <hangpose.hpp>
#include <thread>
#include <vector>

#include "shapes.h"

static constexpr int OBJECTS = 8;

struct Answer {
  float radius = 0;
  hangpose_status status = HANGPOSE_OK;
  hangpose::pose best{};
};

// Analyses and hangs the next object until none is left.
static void work(const hangpose::supporter &peg, const hangpose::params &params, std::atomic<int> &next,
                 Answer *answers) {
  std::vector<hangpose::vec3> vertices(RING_VERTICES);
  std::vector<hangpose::triangle> triangles(RING_TRIANGLES);
  std::vector<unsigned char> room(
      HANGPOSE_OBJECT_BYTES(RING_VERTICES, RING_TRIANGLES, params.samples, params.voxels));
  for (int index = next++; index < OBJECTS; index = next++) {
    Answer &answer = answers[index];
    answer.radius = 0.006f + 0.004f * static_cast<float>(index);
    make_ring(answer.radius, reinterpret_cast<float(*)[3]>(vertices.data()),
              reinterpret_cast<std::uint32_t(*)[3]>(triangles.data()));
    // The caller owns the memory and reuses it for the next object.
    const auto ring =
        hangpose::object::create({vertices, triangles}, params, hangpose::memory(room.data(), room.size()));
    if (!ring) {
      answer.status = ring.error().status();
      continue;
    }
    hangpose::view<hangpose::pose> best(&answer.best, 1);
    const auto found = hangpose::predict(*ring, peg, params, best);
    answer.status = found ? found->status : found.error().status();
  }
}

int main() {
  hangpose::params params;
  params.samples = 4000;
  params.voxels = 100000;
  std::vector<hangpose::vec3> points(PEG_POINTS), normals(PEG_POINTS);
  make_peg(0.004f, reinterpret_cast<float(*)[3]>(points.data()),
           reinterpret_cast<float(*)[3]>(normals.data()));
  const auto peg = hangpose::supporter::create({points, normals}, params);
  if (!peg) {
    std::fprintf(stderr, "%s\n", peg.error().message());
    return 1;
  }

  Answer answers[OBJECTS];
  std::atomic<int> next{0};
  std::thread other([&] { work(*peg, params, next, answers); });
  work(*peg, params, next, answers);
  other.join();

  int hung = 0;
  for (const Answer &answer : answers) {
    hung += answer.status == HANGPOSE_OK;
    std::printf("ring of %4.1f mm: %s", static_cast<double>(answer.radius) * 1000,
                hangpose_status_string(answer.status));
    if (answer.best.has_rest)
      std::printf(", with probability %.3f", static_cast<double>(answer.best.probability));
    std::printf("\n");
  }
  return hung > 0 ? 0 : 3;
}
