// Threads for loops of microseconds.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace meshless_cutting {

/// Every thread has its own stretch of each loop, the same in all loops of the same length, so that what it wrote in
/// one loop is in its cache in the next. Who has done with its own waits for a moment, since most loops end then, and
/// takes from the others after that, one task at a time: nobody waits for a thread that the system has taken away
/// before it began. What is left to wait for is a task that is being run; a thread that waits spins for a moment and
/// then sleeps, and never yields: to a busy neighbour a yield gives away milliseconds.
///
/// A cache line takes up to a quarter of a microsecond from one processor to another. Hence all that a thread is told comes in one
/// line, and what it answers is in a line that nobody else writes to.
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

  /// A thread's place.
  struct Seat {
    // What it is told.
    alignas(64) std::atomic<std::uint32_t> loop{0};  // loops begun, of a thread that is not the caller
    Function function = nullptr;
    const void* context = nullptr;
    std::atomic<std::uint64_t> left{0};  // of its stretch, end and next in one word: it takes from the front, others from the back

    // What it answers.
    alignas(64) std::atomic<std::uint64_t> done{0};  // tasks since the beginning
  };

  void Run(Function function, const void* context, int count);
  /// Runs what is left of a stretch from its front or its back; how many tasks that were.
  template <bool kFromFront>
  static int TakeFrom(Seat& seat);
  int TakeFromOthers(int thread);
  bool AllDone() const;
  void Answer(Seat& seat, int done);
  void Work(int thread);

  const int thread_count_;
  std::unique_ptr<Seat[]> seats_;  // the caller's first
  std::uint64_t begun_ = 0;        // tasks since the beginning

  alignas(64) std::atomic<int> sleepers_{0};
  std::atomic<bool> caller_sleeps_{false}, stop_{false};
  std::atomic<std::uint32_t> calls_{0};  // what the caller sleeps on
  std::vector<std::thread> workers_;
};

}  // namespace meshless_cutting
