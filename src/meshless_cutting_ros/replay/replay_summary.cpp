#include "replay/replay_summary.h"

#include <algorithm>
#include <cstdio>

namespace meshless_cutting {
namespace {

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

}  // namespace

void ReplaySummary::Add(const Simulation& simulation) {
  frame_s_.push_back(simulation.statistics().total_s);
  for (const StrokeEvent& event : simulation.events()) {
    if (event.type == StrokeEventType::kStarted) ++strokes_;
    if (event.type == StrokeEventType::kStarted || event.type == StrokeEventType::kProgress) area_m2_ += event.area_m2;
    if (event.type == StrokeEventType::kStarted || event.type == StrokeEventType::kProgress)
      open_length_m_[event.tool] = event.length_m;  // so far in the stroke
    if (event.type == StrokeEventType::kEnded) {
      length_m_ += event.length_m;
      open_length_m_.erase(event.tool);
    }
  }
}

std::string ReplaySummary::Words(const Simulation& simulation) const {
  const FrameStatistics& statistics = simulation.statistics();
  double length_m = length_m_;
  for (const auto& [tool, length] : open_length_m_) length_m += length;
  char line[400];
  std::snprintf(line, sizeof(line),
                "%zu frames, %.3f s; %d strokes, length %.1f mm, cut face %.2f cm^2, %d links cut; frame time p50 %.1f "
                "ms, p99 %.1f ms",
                frame_s_.size(), static_cast<double>(frame_s_.size()) * simulation.scene().time_step_s, strokes_,
                1e3 * length_m, 1e4 * area_m2_, statistics.links_cut, 1e3 * Percentile(frame_s_, 0.5),
                1e3 * Percentile(frame_s_, 0.99));
  std::string words = line;
  words += "\nfragments:";
  for (const double volume : simulation.surface().fragment_volume_m3) {
    std::snprintf(line, sizeof(line), " %.3f", 1e6 * volume);
    words += line;
  }
  return words + " cm^3";
}

}  // namespace meshless_cutting
