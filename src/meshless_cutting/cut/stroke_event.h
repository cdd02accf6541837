// What tools did to the object, for logs and bags.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace meshless_cutting {

enum class StrokeEventType : std::uint8_t { kStarted = 0, kProgress = 1, kEnded = 2, kSeparated = 3, kJumpRefused = 4 };

/// Something that a tool did during a frame. STARTED and PROGRESS carry what this frame cut, ENDED the sums of the
/// stroke.
struct StrokeEvent {
  StrokeEventType type = StrokeEventType::kProgress;
  int tool = -1;   // index in the scene
  int stroke = 0;  // counts the strokes of this tool from 1
  int links_cut = 0;
  double area_m2 = 0;   // cut face added, one lip, at rest
  double length_m = 0;  // area over greatest depth: the way of the edge through the tissue
  double depth_m =
      0;  // length of blade edge between the outermost links it cut in one frame, greatest so far in the stroke
  std::vector<Eigen::Vector3d> points;       // where links were cut, scene frame, m
  std::vector<Eigen::Vector3d> rest_points;  // the same at rest, object frame, m
  std::vector<double> fragment_volume_m3;    // SEPARATED: all fragments after it, largest first
};

}  // namespace meshless_cutting
