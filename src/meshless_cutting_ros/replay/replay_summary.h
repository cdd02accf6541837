// What a replay did, in a few lines.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "session.h"

namespace meshless_cutting {

class ReplaySummary {
 public:
  /// Counts the frame that the simulation just made.
  void Add(const Simulation& simulation);
  std::string Words(const Simulation& simulation) const;

 private:
  int strokes_ = 0;
  std::map<int, double> open_length_m_;  // per tool, of strokes that have not ended
  double length_m_ = 0;
  double area_m2_ = 0;
  std::vector<double> frame_s_;
};

}  // namespace meshless_cutting
