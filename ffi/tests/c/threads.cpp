// Threads that share an object and a supporter: they predict and plan at the same time, alone and with a
// second thread that they share too, while another one reads the progress of calls and cancels them. Every
// result must have the bytes of a call that runs alone. Runs under the sanitizers. `threads race` and
// `threads beyond` do what the header forbids, so that a sanitizer must report it.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <hangpose.hpp>
#include <hangpose/second_thread.hpp>
#include <thread>
#include <vector>

#include "shapes.h"

static std::atomic<int> failures{0};
#define CHECK(is_right)                                                             \
  do {                                                                              \
    if (!(is_right)) std::printf("line %d: %s\n", __LINE__, #is_right), ++failures; \
  } while (false)

// Small, because the tests run under ThreadSanitizer.
static constexpr std::size_t POSES = 2, WAYPOINTS = 200;
static constexpr int WORKERS = 3, ROUNDS = 2, CANCELS = 20;

// What a thread finds with the models that it shares.
struct Found {
  hangpose::pose poses[POSES]{};
  hangpose_status predicted = HANGPOSE_CANCELLED, planned = HANGPOSE_CANCELLED;
  std::vector<hangpose::waypoint> path = std::vector<hangpose::waypoint>(WAYPOINTS);

  bool operator==(const Found &other) const {
    return predicted == other.predicted && planned == other.planned && path.size() == other.path.size() &&
           std::memcmp(poses, other.poses, sizeof poses) == 0 &&
           std::memcmp(path.data(), other.path.data(), path.size() * sizeof path[0]) == 0;
  }
};

// Models that all threads share.
struct Models {
  const hangpose::params &params;
  const hangpose::object &ring;
  const hangpose::supporter &peg;

  Found find(hangpose::monitor *watch) const {
    Found mine;
    const auto found = hangpose::predict(ring, peg, params, mine.poses, watch);
    mine.predicted = found ? found->status : found.error().status();
    if (mine.predicted != HANGPOSE_OK) return mine;
    const auto plan = hangpose::plan_path(ring, peg, hangpose::request(), params, hangpose::motion(),
                                          mine.poses[0], mine.path, watch);
    mine.planned = plan ? plan->status : plan.error().status();
    mine.path.resize(plan ? plan->object.size() : 0);
    return mine;
  }
};

static void all_at_once(const Models &models, const Found &right) {
  hangpose::second_thread helper;
  std::vector<std::thread> workers;
  for (int worker = 0; worker < WORKERS; ++worker) {
    workers.emplace_back([&, worker] {
      hangpose::monitor watch;
      if (worker > 0) CHECK(watch.use(helper));
      for (int round = 0; round < ROUNDS; ++round) CHECK(models.find(&watch) == right);
    });
  }
  for (std::thread &worker : workers) worker.join();
}

// Each call is cancelled a little later than the one before.
static void cancelled_from_outside(const Models &models, const Found &right) {
  hangpose::second_thread helper;
  hangpose::monitor watch;
  int ended = 0;
  for (int i = 0; i < CANCELS; ++i) {
    watch.reset();
    CHECK(watch.use(helper));
    Found theirs;
    std::thread worker([&] { theirs = models.find(&watch); });
    for (int wait = 0; wait < i; ++wait) {
      CHECK(watch.progress() >= 0.0f && watch.progress() <= 1.0f);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    watch.cancel();
    worker.join();
    CHECK(watch.is_cancelled());
    const bool is_cut = theirs.predicted == HANGPOSE_CANCELLED || theirs.planned == HANGPOSE_CANCELLED;
    CHECK(is_cut || theirs == right);
    ended += is_cut;
  }
  CHECK(ended > 0);
  std::printf("threads: %d of %d cancels met a call\n", ended, CANCELS);
}

// Predicts in `room`, which is said to have `size` bytes.
static void predict_in(const Models &models, std::vector<unsigned char> &room, std::size_t size) {
  hangpose::pose poses[POSES];
  const auto found = hangpose::predict(models.ring, models.peg, models.params, poses,
                                       hangpose::memory(room.data(), size));
  static_cast<void>(found);
}

// Two predictions in the same working memory.
static void race(const Models &models) {
  std::vector<unsigned char> room(HANGPOSE_PREDICT_BYTES(PEG_POINTS, POSES));
  std::thread other([&] { predict_in(models, room, room.size()); });
  predict_in(models, room, room.size());
  other.join();
}

// A prediction whose working memory is smaller than it is said to be.
static void beyond(const Models &models) {
  std::vector<unsigned char> room(1000);
  predict_in(models, room, HANGPOSE_PREDICT_BYTES(PEG_POINTS, POSES));
}

int main(int count, char **arguments) {
  std::vector<hangpose::vec3> vertices(RING_VERTICES), points(PEG_POINTS), normals(PEG_POINTS);
  std::vector<hangpose::triangle> triangles(RING_TRIANGLES);
  make_ring(0.03f, reinterpret_cast<float(*)[3]>(vertices.data()),
            reinterpret_cast<std::uint32_t(*)[3]>(triangles.data()));
  make_peg(0.004f, reinterpret_cast<float(*)[3]>(points.data()),
           reinterpret_cast<float(*)[3]>(normals.data()));
  hangpose::params params;
  params.samples = 1000;
  params.voxels = 20000;
  params.settle_attempts = 8;
  const auto ring = hangpose::object::create({vertices, triangles}, params);
  const auto peg = hangpose::supporter::create({points, normals}, params);
  if (!ring || !peg) return std::printf("threads: no models\n"), 1;
  const Models models{params, *ring, *peg};
  if (count > 1) return (std::strcmp(arguments[1], "race") == 0 ? race : beyond)(models), 0;

  const Found right = models.find(nullptr);
  CHECK(right.predicted == HANGPOSE_OK && right.planned == HANGPOSE_OK && !right.path.empty());
  all_at_once(models, right);
  cancelled_from_outside(models, right);
  std::printf("threads: %d failures\n", failures.load());
  return failures != 0;
}
