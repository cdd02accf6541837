// Threads for loops of microseconds.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace meshless_cutting {

/// Every thread has its own stretch of each loop, the same in all loops of the same length, so that what it wrote in
/// one loop is in its cache in the next. Who has done with its own takes from the others, one task at a time: nobody
/// waits for a thread that the system has taken away before it began. What is left to wait for is a task that is being
/// run; a thread that waits spins for a moment and then sleeps, and never yields: to a busy neighbour a yield gives
/// away milliseconds.
class ThreadPool {
 public:
  /// `threads` includes the caller of ForEach; 1 or less: no thread is started.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int thread_count() const { return thread_count_; }

  /// Calls task(i) for i in [0, count), each once, in no order, on several threads; returns when all are done.
  /// Everything the tasks wrote is then visible. One loop at a time, from one thread. Allocates nothing; tasks do not
  /// throw.
  template <class Task>
  void ForEach(int count, const Task& task) {
    if (thread_count_ == 1 || count < 2) {
      for (int i = 0; i < count; ++i) task(i);
      return;
    }
    Run([](const void* context, int i) { (*static_cast<const Task*>(context))(i); }, &task, count);
  }

 private:
  using Function = void (*)(const void* context, int index);

  /// What is left of a thread's stretch, end and next in one word: the owner takes from the front, the others from the
  /// back.
  struct alignas(64) Stretch {
    std::atomic<std::uint64_t> left{0};
  };

  void Run(Function function, const void* context, int count);
  int TakeAll(int thread);
  void Work(int thread);

  const int thread_count_;
  Function function_ = nullptr;
  const void* context_ = nullptr;
  std::unique_ptr<Stretch[]> stretches_;  // one per thread, the caller's first

  alignas(64) std::atomic<std::uint32_t> undone_{0};  // tasks of the loop in progress
  std::atomic<bool> caller_sleeps_{false};
  alignas(64) std::atomic<std::uint32_t> loop_{0};  // loops begun
  std::atomic<int> sleepers_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> workers_;
};

}  // namespace meshless_cutting
