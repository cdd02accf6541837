#include "dynamics/thread_pool.h"

#include <algorithm>

#include "dynamics/futex.h"

namespace meshless_cutting {
namespace {

// About 100 us: longer than the serial stretches inside a solve, far shorter than the pause between two frames.
constexpr int kSpins = 2000;

void Pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

constexpr std::uint64_t StretchOf(std::uint64_t next, std::uint64_t end) { return end << 32 | next; }

}  // namespace

ThreadPool::ThreadPool(int threads) : thread_count_(std::max(threads, 1)) {
  if (thread_count_ == 1) return;
  stretches_ = std::make_unique<Stretch[]>(thread_count_);
  for (int i = 1; i < thread_count_; ++i) workers_.emplace_back([this, i] { Work(i); });
}

ThreadPool::~ThreadPool() {
  stop_ = true;
  ++loop_;
  FutexWakeAll(loop_);
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::Run(Function function, const void* context, int count) {
  // Stretches are empty and no task runs: nobody reads these now.
  function_ = function;
  context_ = context;
  undone_.store(count);
  const std::uint64_t threads = thread_count_, tasks = count;
  for (std::uint64_t t = 0; t < threads; ++t) {
    stretches_[t].left.store(StretchOf(tasks * t / threads, tasks * (t + 1) / threads), std::memory_order_release);
  }
  ++loop_;
  if (sleepers_.load() > 0) FutexWakeAll(loop_);

  const std::uint32_t done = TakeAll(0);
  std::uint32_t undone = undone_.fetch_sub(done) - done;
  for (int spins = 0; undone > 0 && spins < kSpins; ++spins) {
    Pause();
    undone = undone_.load(std::memory_order_acquire);
  }
  if (undone == 0) return;
  caller_sleeps_ = true;
  while ((undone = undone_.load()) > 0) FutexWait(undone_, undone);
  caller_sleeps_ = false;
}

/// Runs what it can get, its own first; how many that were.
int ThreadPool::TakeAll(int thread) {
  int done = 0;
  for (int turn = 0; turn < thread_count_; ++turn) {
    Stretch& stretch = stretches_[(thread + turn) % thread_count_];
    std::uint64_t left = stretch.left.load(std::memory_order_acquire);
    for (;;) {
      const std::uint64_t next = left & 0xffffffffU, end = left >> 32;
      if (next >= end) break;
      const std::uint64_t rest = turn == 0 ? StretchOf(next + 1, end) : StretchOf(next, end - 1);
      if (!stretch.left.compare_exchange_weak(left, rest, std::memory_order_acq_rel, std::memory_order_acquire))
        continue;
      // The loop cannot end, nor its function change, before this task is counted.
      function_(context_, static_cast<int>(turn == 0 ? next : end - 1));
      ++done;
      left = stretch.left.load(std::memory_order_acquire);
    }
  }
  return done;
}

void ThreadPool::Work(int thread) {
  for (;;) {
    const std::uint32_t seen = loop_.load();
    if (stop_) return;
    const std::uint32_t done = TakeAll(thread);
    if (done > 0 && undone_.fetch_sub(done) == done && caller_sleeps_) FutexWakeAll(undone_);
    for (int spins = 0; spins < kSpins && loop_.load(std::memory_order_relaxed) == seen; ++spins) Pause();
    if (loop_.load() != seen) continue;
    ++sleepers_;
    FutexWait(loop_, seen);
    --sleepers_;
  }
}

}  // namespace meshless_cutting
