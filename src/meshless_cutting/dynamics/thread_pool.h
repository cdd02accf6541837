// Threads for loops of microseconds: tasks are claimed one by one, so that nobody waits for a thread that the system has
// taken away before it began; waiting threads spin for a moment and then sleep.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace meshless_cutting {

class ThreadPool {
 public:
  /// `threads` includes the caller of ForEach; 1 or less: no thread is started.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int thread_count() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(i) for i in [0, count), each once, in no order, on several threads; returns when all are done. Everything the
  /// tasks wrote is then visible. One loop at a time, from one thread. Allocates nothing; tasks do not throw.
  /// count < 2^24.
  template <class Task>
  void ForEach(int count, const Task& task) {
    if (workers_.empty() || count < 2) {
      for (int i = 0; i < count; ++i) task(i);
      return;
    }
    Run([](const void* context, int i) { (*static_cast<const Task*>(context))(i); }, &task, count);
  }

 private:
  using Function = void (*)(const void* context, int index);

  void Run(Function function, const void* context, int count);
  bool ClaimAndRun();
  void Work();

  // Loop number (16 bits), count (24), next index (24) in one word: a claim that succeeds belongs to the loop that it read.
  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<int> done_{0};
  Function function_ = nullptr;
  const void* context_ = nullptr;

  std::atomic<int> sleepers_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::thread> workers_;
};

}  // namespace meshless_cutting
