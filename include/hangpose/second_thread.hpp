// A second thread for the calls of hangpose.hpp. Header-only.
//
//   hangpose::second_thread helper;
//   hangpose::monitor monitor;
//   monitor.use(helper);
//   auto found = hangpose::predict(object, supporter, params, poses, &monitor);
#ifndef HANGPOSE_SECOND_THREAD_HPP
#define HANGPOSE_SECOND_THREAD_HPP

#include <condition_variable>
#include <mutex>
#include <thread>

#include "hangpose.hpp"

namespace hangpose {

// A thread that sleeps until a call has a part for it. Neither copied nor moved; it must outlive the monitors that use
// it. Calls of several threads may share it: while it is taken, the others do all of their parts themselves.
class second_thread : public hangpose_threads {
 public:
  second_thread() : hangpose_threads{sizeof(hangpose_threads), run_both, this}, worker_([this] { work(); }) {}
  second_thread(const second_thread &) = delete;
  second_thread &operator=(const second_thread &) = delete;
  ~second_thread() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      has_ended_ = true;
    }
    changed_.notify_all();
    worker_.join();
  }

 private:
  static void run_both(void *context, hangpose_task first, void *first_argument, hangpose_task second,
                       void *second_argument) {
    auto &self = *static_cast<second_thread *>(context);
    const bool is_mine = self.hand_over(second, second_argument);
    first(first_argument);
    if (is_mine) {
      self.wait();
    } else {
      second(second_argument);
    }
  }

  bool hand_over(hangpose_task task, void *argument) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_taken_) return false;
      is_taken_ = true;
      task_ = task;
      argument_ = argument;
    }
    changed_.notify_all();
    return true;
  }

  // Waits until the task that was handed over is done.
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return task_ == nullptr; });
    is_taken_ = false;
  }

  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return task_ != nullptr || has_ended_; });
      if (task_ == nullptr) return;
      lock.unlock();
      task_(argument_);
      lock.lock();
      task_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  // From when a task is handed over until its caller has seen it done.
  bool is_taken_ = false;
  bool has_ended_ = false;
  hangpose_task task_ = nullptr;
  void *argument_ = nullptr;
  // Started when all else is there.
  std::thread worker_;
};

}  // namespace hangpose

#endif  // HANGPOSE_SECOND_THREAD_HPP
