#include "dynamics/thread_pool.h"

namespace meshless_cutting {
namespace {

constexpr int kIndexBits = 24;
constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << kIndexBits) - 1;

// About 20 us: longer than the serial stretches inside a solve, far shorter than the pause between two frames.
constexpr int kSpins = 400;

void Pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { Work(); });
}

ThreadPool::~ThreadPool() {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::Run(Function function, const void* context, int count) {
  function_ = function;
  context_ = context;
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t loop = (ticket_.load(std::memory_order_relaxed) >> (2 * kIndexBits)) + 1;
  ticket_.store(loop << (2 * kIndexBits) | static_cast<std::uint64_t>(count) << kIndexBits);
  if (sleepers_.load() > 0) {
    std::lock_guard<std::mutex> lock(mutex_);
    wake_.notify_all();
  }
  while (ClaimAndRun()) {
  }
  for (int spins = 0; done_.load(std::memory_order_acquire) < count; ++spins) {
    if (spins < kSpins) {
      Pause();
    } else {
      std::this_thread::yield();
    }
  }
}

bool ThreadPool::ClaimAndRun() {
  std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
  for (;;) {
    const std::uint64_t next = ticket & kIndexMask, count = ticket >> kIndexBits & kIndexMask;
    if (next >= count) return false;
    if (ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel, std::memory_order_acquire)) {
      // The loop cannot end, nor its function change, before this index is counted as done.
      function_(context_, static_cast<int>(next));
      done_.fetch_add(1, std::memory_order_release);
      return true;
    }
  }
}

void ThreadPool::Work() {
  for (;;) {
    const std::uint64_t seen = ticket_.load() >> (2 * kIndexBits);
    while (ClaimAndRun()) {
    }
    bool changed = false;
    for (int spins = 0; spins < kSpins && !changed && !stop_; ++spins) {
      Pause();
      changed = ticket_.load(std::memory_order_relaxed) >> (2 * kIndexBits) != seen;
    }
    if (changed) continue;
    std::unique_lock<std::mutex> lock(mutex_);
    ++sleepers_;
    wake_.wait(lock, [&] { return stop_ || ticket_.load() >> (2 * kIndexBits) != seen; });
    --sleepers_;
    if (stop_) return;
  }
}

}  // namespace meshless_cutting
