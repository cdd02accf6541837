// How a blade moves during one frame: what the tool hands to the crossing search.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace meshless_cutting {

/// A piece of the blade's motion: every point of the polyline moves linearly from points_t0 to points_t1 while frame
/// time goes from t0 to t1 (the whole frame is [0, 1]).
struct BladeWindow {
  double t0 = 0;
  double t1 = 1;
  std::vector<Eigen::Vector3d> points_t0;  // m, scene frame
  std::vector<Eigen::Vector3d> points_t1;  // m, scene frame
};

/// Windows chain without a gap, in order of time, but for a jump: there the chain starts anew. Empty: the blade is
/// inactive.
using BladeMotion = std::vector<BladeWindow>;

}  // namespace meshless_cutting
