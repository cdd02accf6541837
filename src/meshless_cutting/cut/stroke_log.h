// Turns what each frame cut into the events of strokes.
#pragma once

#include <vector>

#include "crossing/find_crossings.h"
#include "cut/stroke_event.h"

namespace meshless_cutting {

/// What one tool did in one frame.
struct FrameCut {
  std::vector<Crossing> crossings;           // links that it cut
  std::vector<Eigen::Vector3d> rest_points;  // of the crossings, object frame, m
  double area_m2 = 0;                        // its share of the cut face added
  bool active = false;                       // the blade was there
  int jumps = 0;                             // jumps refused
};

/// The strokes of one tool. A stroke starts with the first link cut and ends when nothing was cut for a while or the
/// blade is gone.
class StrokeLog {
 public:
  StrokeLog(int tool, double time_step_s) : tool_(tool), time_step_s_(time_step_s) {}

  /// Appends the events of this frame, in order.
  void Record(const FrameCut& cut, std::vector<StrokeEvent>& events);

 private:
  int tool_;
  double time_step_s_;
  bool open_ = false;
  double idle_s_ = 0;
  StrokeEvent sum_;
};

}  // namespace meshless_cutting
