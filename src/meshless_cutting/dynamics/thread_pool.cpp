#include "dynamics/thread_pool.h"

#include <algorithm>

#include "dynamics/futex.h"

namespace meshless_cutting {
namespace {

// About 100 us: longer than the serial stretches inside a solve, far shorter than the pause between two frames.
constexpr int kSpins = 2000;

// One to several microseconds: by how much threads that began together may differ. To take from the others costs both of them as much.
constexpr int kPatience = 100;

void Pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

constexpr std::uint64_t StretchOf(std::uint64_t next, std::uint64_t end) { return end << 32 | next; }

}  // namespace

ThreadPool::ThreadPool(int threads) : thread_count_(std::max(threads, 1)) {
  if (thread_count_ == 1) return;
  seats_ = std::make_unique<Seat[]>(thread_count_);
  for (int i = 1; i < thread_count_; ++i) workers_.emplace_back([this, i] { Work(i); });
}

ThreadPool::~ThreadPool() {
  stop_ = true;
  for (int t = 1; t < thread_count_; ++t) {
    ++seats_[t].loop;
    FutexWakeAll(seats_[t].loop);
  }
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::Run(Function function, const void* context, int count) {
  // Stretches are empty and no task runs: nobody reads these now.
  begun_ += count;
  const std::uint64_t threads = thread_count_, tasks = count;
  for (int t = thread_count_ - 1; t >= 0; --t) {
    Seat& seat = seats_[t];
    seat.function = function;
    seat.context = context;
    seat.left.store(StretchOf(tasks * t / threads, tasks * (t + 1) / threads), std::memory_order_release);
    if (t > 0) seat.loop.store(seat.loop.load(std::memory_order_relaxed) + 1);
  }
  if (sleepers_.load() > 0) {
    for (int t = 1; t < thread_count_; ++t) FutexWakeAll(seats_[t].loop);
  }

  Answer(seats_[0], TakeFrom<true>(seats_[0]));
  for (int spins = 0; spins < kPatience; ++spins, Pause()) {
    if (AllDone()) return;
  }
  Answer(seats_[0], TakeFromOthers(0));
  for (int spins = 0; spins < kSpins; ++spins, Pause()) {
    if (AllDone()) return;
  }
  caller_sleeps_ = true;
  for (;;) {
    const std::uint32_t calls = calls_.load();
    if (AllDone()) break;
    FutexWait(calls_, calls);
  }
  caller_sleeps_ = false;
}

bool ThreadPool::AllDone() const {
  std::uint64_t done = 0;
  for (int t = 0; t < thread_count_; ++t) done += seats_[t].done.load();
  return done == begun_;
}

void ThreadPool::Answer(Seat& seat, int done) {
  // Nobody else writes to it. The caller says that it sleeps before it looks for the last time.
  if (done == 0) return;
  seat.done.store(seat.done.load(std::memory_order_relaxed) + done);
  if (!caller_sleeps_) return;
  ++calls_;
  FutexWakeAll(calls_);
}

template <bool kFromFront>
int ThreadPool::TakeFrom(Seat& seat) {
  int done = 0;
  std::uint64_t left = seat.left.load(std::memory_order_acquire);
  for (;;) {
    const std::uint64_t next = left & 0xffffffffU, end = left >> 32;
    if (next >= end) return done;
    const std::uint64_t rest = kFromFront ? StretchOf(next + 1, end) : StretchOf(next, end - 1);
    if (!seat.left.compare_exchange_weak(left, rest, std::memory_order_acq_rel, std::memory_order_acquire)) continue;
    // The loop cannot end, nor its function change, before this task is counted.
    seat.function(seat.context, static_cast<int>(kFromFront ? next : end - 1));
    ++done;
    left = seat.left.load(std::memory_order_acquire);
  }
}

int ThreadPool::TakeFromOthers(int thread) {
  int done = 0;
  for (int turn = 1; turn < thread_count_; ++turn) done += TakeFrom<false>(seats_[(thread + turn) % thread_count_]);
  return done;
}

void ThreadPool::Work(int thread) {
  Seat& seat = seats_[thread];
  std::uint32_t seen = 0;
  const auto waits = [&](int spins) {
    for (; spins > 0 && seat.loop.load(std::memory_order_relaxed) == seen; --spins) Pause();
    return seat.loop.load(std::memory_order_acquire) == seen;
  };
  for (;;) {
    if (waits(kSpins)) {
      ++sleepers_;
      FutexWait(seat.loop, seen);
      --sleepers_;
      continue;
    }
    seen = seat.loop.load(std::memory_order_acquire);
    if (stop_) return;
    Answer(seat, TakeFrom<true>(seat));
    if (waits(kPatience)) Answer(seat, TakeFromOthers(thread));
  }
}

}  // namespace meshless_cutting
