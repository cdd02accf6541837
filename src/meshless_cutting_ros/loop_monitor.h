// How well the loop keeps time: for /diagnostics.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>

namespace meshless_cutting {

/// Over the last ten seconds of frames. Written by the loop, read by the diagnostics.
class LoopMonitor {
 public:
  struct Summary {
    std::uint64_t frames = 0;     // since the start
    std::uint64_t missed = 0;     // of those, frames that took longer than the time step
    double p50_s = 0, p99_s = 0;  // wall time of a frame
    double real_time_factor = 0;  // simulated time per wall time
    std::uint32_t status = 0;     // bits of all steps of the window
  };

  /// A frame that ended at `wall_s` (any steady clock) and took `total_s` for `time_step_s` of simulated time.
  void Add(double wall_s, double total_s, double time_step_s, std::uint32_t status);
  Summary Get() const;
  /// Forgets the window: after a pause or a load the real-time factor starts anew.
  void Restart();

 private:
  struct Frame {
    double wall_s, total_s, time_step_s;
    std::uint32_t status;
  };
  mutable std::mutex mutex_;
  std::deque<Frame> window_;
  std::uint64_t frames_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace meshless_cutting
