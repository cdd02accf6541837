// Plays a file of way-points to a tool of a simulation, as a driver with 500 samples a second would.
#pragma once

#include <cmath>
#include <filesystem>

#include "simulation.h"
#include "tools/tool_path.h"

namespace meshless_cutting {

class ToolPlayer {
 public:
  /// `slower`: stretches the path in time.
  explicit ToolPlayer(const std::filesystem::path& file, double slower = 1) : path_(ReadToolPath(file)), slower_(slower) {}

  double end_s() const { return slower_ * path_.end_s(); }

  void FeedUntil(Simulation& simulation, int tool, double time_s) {
    for (; static_cast<double>(next_) / kRate <= time_s; ++next_) {
      ToolSample sample;
      sample.time_s = static_cast<double>(next_) / kRate;
      const Eigen::Isometry3d pose = path_.At(sample.time_s / slower_);
      sample.position_m = pose.translation();
      sample.orientation_xyzw = Eigen::Quaterniond(pose.rotation()).coeffs();
      simulation.AddToolSample(tool, sample);
    }
  }

 private:
  static constexpr double kRate = 500;  // 1/s
  ToolPath path_;
  double slower_;
  long next_ = 0;
};

}  // namespace meshless_cutting
