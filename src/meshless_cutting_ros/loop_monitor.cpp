#include "loop_monitor.h"

#include <algorithm>
#include <vector>

namespace meshless_cutting {
namespace {

constexpr double kWindow = 10;  // s

}  // namespace

void LoopMonitor::Add(double wall_s, double total_s, double time_step_s, std::uint32_t status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++frames_;
  if (total_s > time_step_s) ++missed_;
  window_.push_back({wall_s, total_s, time_step_s, status});
  while (window_.front().wall_s < wall_s - kWindow) window_.pop_front();
}

LoopMonitor::Summary LoopMonitor::Get() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Summary summary;
  summary.frames = frames_;
  summary.missed = missed_;
  if (window_.empty()) return summary;
  std::vector<double> times;
  double simulated = 0;
  for (const Frame& frame : window_) {
    times.push_back(frame.total_s);
    simulated += frame.time_step_s;
    summary.status |= frame.status;
  }
  std::sort(times.begin(), times.end());
  summary.p50_s = times[times.size() / 2];
  summary.p99_s = times[std::min(times.size() - 1, times.size() * 99 / 100)];
  const double wall = window_.back().wall_s - window_.front().wall_s;
  if (wall > 0) summary.real_time_factor = (simulated - window_.front().time_step_s) / wall;
  return summary;
}

void LoopMonitor::Restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  window_.clear();
}

}  // namespace meshless_cutting
