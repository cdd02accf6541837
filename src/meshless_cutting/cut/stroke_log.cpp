#include "cut/stroke_log.h"

#include <algorithm>

namespace meshless_cutting {

// A blade that has cut nothing for this long has ended its stroke. Shorter: a hesitating hand makes several strokes of
// one.
constexpr double kStrokeIdle_s = 0.5;

void StrokeLog::Record(const FrameCut& cut, std::vector<StrokeEvent>& events) {
  for (int i = 0; i < cut.jumps; ++i) {
    StrokeEvent event;
    event.type = StrokeEventType::kJumpRefused;
    event.tool = tool_;
    event.stroke = sum_.stroke;
    events.push_back(event);
  }
  if (!cut.crossings.empty()) {
    StrokeEvent event;
    event.type = open_ ? StrokeEventType::kProgress : StrokeEventType::kStarted;
    if (!open_) {
      const int stroke = sum_.stroke + 1;
      sum_ = StrokeEvent();
      sum_.type = StrokeEventType::kEnded;
      sum_.tool = tool_;
      sum_.stroke = stroke;
      open_ = true;
    }
    idle_s_ = 0;
    double first = cut.crossings[0].along_m, last = first;
    for (const Crossing& crossing : cut.crossings) {
      first = std::min(first, crossing.along_m);
      last = std::max(last, crossing.along_m);
      event.points.push_back(crossing.point);
    }
    sum_.depth_m = std::max(sum_.depth_m, last - first);
    sum_.area_m2 += cut.area_m2;
    sum_.links_cut += static_cast<int>(cut.crossings.size());
    if (sum_.depth_m > 0) sum_.length_m = sum_.area_m2 / sum_.depth_m;
    event.tool = tool_;
    event.stroke = sum_.stroke;
    event.links_cut = static_cast<int>(cut.crossings.size());
    event.area_m2 = cut.area_m2;
    event.length_m = sum_.length_m;
    event.depth_m = sum_.depth_m;
    event.rest_points = cut.rest_points;
    events.push_back(event);
  } else if (open_) {
    idle_s_ += time_step_s_;
    if (!cut.active || idle_s_ >= kStrokeIdle_s) {
      events.push_back(sum_);
      open_ = false;
    }
  }
}

}  // namespace meshless_cutting
