#include "tool/blade_rim.h"

namespace meshless_cutting {
namespace {

/// A vector of length `rim` along v; zero where v is not longer than that.
Eigen::Vector3d Along(const Eigen::Vector3d& v, double rim) {
  const double length = v.norm();
  return length > rim ? Eigen::Vector3d(rim / length * v) : Eigen::Vector3d::Zero();
}

}  // namespace

BladeMotion WithRim(BladeMotion motion, double rim) {
  for (BladeWindow& window : motion) {
    for (std::size_t i = 0; i < window.points_t1.size(); ++i) {
      window.points_t1[i] += Along(window.points_t1[i] - window.points_t0[i], rim);
    }
    for (auto* points : {&window.points_t0, &window.points_t1}) {
      const std::size_t last = points->size() - 1;
      const Eigen::Vector3d front = Along((*points)[0] - (*points)[1], rim);
      (*points)[last] += Along((*points)[last] - (*points)[last - 1], rim);
      (*points)[0] += front;
    }
  }
  return motion;
}

}  // namespace meshless_cutting
