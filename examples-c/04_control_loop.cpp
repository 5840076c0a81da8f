// A control loop at 1 kHz, with the prediction in a low-priority thread. The loop reads the progress, cancels
// a prediction whose supporter has moved, restarts it, and takes the pose when it is ready. It never waits
// for the prediction.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <hangpose.hpp>
#include <thread>
#include <vector>

#ifdef __linux__
#include <unistd.h>
#endif

#include "shapes.h"

// The data that the loop and the predictor share. `state` hands the other fields from one to the other.
struct Shared {
  enum State { IDLE, ASKED, ANSWERED, OVER };
  std::atomic<State> state{IDLE};
  hangpose::monitor monitor;
  hangpose::pose best{};
  hangpose_status status = HANGPOSE_OK;
};

// On a real-time kernel a controller would raise the priority of the loop instead.
static void be_less_important() {
#ifdef __linux__
  if (nice(10) == -1) std::perror("nice");  // on Linux for this thread only
#endif
}

static void predictor(Shared &shared) {
  be_less_important();
  const hangpose::params params;
  std::vector<hangpose::vec3> vertices(RING_VERTICES), points(PEG_POINTS), normals(PEG_POINTS);
  std::vector<hangpose::triangle> triangles(RING_TRIANGLES);
  make_ring(0.03f, reinterpret_cast<float(*)[3]>(vertices.data()),
            reinterpret_cast<std::uint32_t(*)[3]>(triangles.data()));
  make_peg(0.004f, reinterpret_cast<float(*)[3]>(points.data()),
           reinterpret_cast<float(*)[3]>(normals.data()));
  for (;;) {
    const auto state = shared.state.load(std::memory_order_acquire);
    if (state == Shared::OVER) return;
    if (state != Shared::ASKED) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    // Every call takes the monitor, so each of them can be cancelled.
    const auto ring = hangpose::object::create({vertices, triangles}, params, &shared.monitor);
    const auto peg = hangpose::supporter::create({points, normals}, params, &shared.monitor);
    shared.status = !ring ? ring.error().status() : !peg ? peg.error().status() : HANGPOSE_OK;
    if (ring && peg) {
      hangpose::view<hangpose::pose> best(&shared.best, 1);
      const auto found = hangpose::predict(*ring, *peg, params, best, &shared.monitor);
      shared.status = found ? found->status : found.error().status();
    }
    // If the loop has ended meanwhile, that stays so.
    auto expected = Shared::ASKED;
    if (!shared.state.compare_exchange_strong(expected, Shared::ANSWERED, std::memory_order_release)) return;
  }
}

int main() {
  using clock = std::chrono::steady_clock;
  static Shared shared;
  std::thread thread(predictor, std::ref(shared));
  int cancelled = 0, ticks = 0;
  auto next = clock::now(), latest = clock::duration::zero() + next;
  auto late = clock::duration::zero();
  shared.state.store(Shared::ASKED, std::memory_order_release);
  for (; ticks < 600000; ++ticks) {
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
    latest = clock::now();
    if (latest - next > late) late = latest - next;
    // ... here a controller reads its encoders and commands its motors ...

    // The peg moves while the first prediction is running.
    if (cancelled == 0 && shared.monitor.progress() > 0.0f) {
      std::printf("tick %d: the peg has moved, prediction cancelled at %.0f %%\n", ticks,
                  static_cast<double>(shared.monitor.progress()) * 100);
      shared.monitor.cancel();
      cancelled = 1;
    }
    if (shared.state.load(std::memory_order_acquire) != Shared::ANSWERED) continue;
    std::printf("tick %d: %s\n", ticks, hangpose_status_string(shared.status));
    if (shared.status != HANGPOSE_CANCELLED) break;
    shared.monitor.reset();  // no call is using it
    shared.state.store(Shared::ASKED, std::memory_order_release);
  }
  shared.monitor.cancel();
  const bool is_done =
      shared.state.exchange(Shared::OVER) == Shared::ANSWERED && shared.status == HANGPOSE_OK;
  thread.join();
  const auto &p = shared.best.position;
  std::printf(
      "%d ticks, at most %.3f ms late; release at (%.4f, %.4f, %.4f) m, hangs with probability %.3f\n", ticks,
      std::chrono::duration<double, std::milli>(late).count(), static_cast<double>(p[0]),
      static_cast<double>(p[1]), static_cast<double>(p[2]), static_cast<double>(shared.best.probability));
  return is_done ? 0 : 1;
}
