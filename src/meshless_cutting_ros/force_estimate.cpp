#include "force_estimate.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

constexpr double kLeastWay_m = 1e-6;  // below it a direction is noise

Eigen::Vector3d Middle(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

Eigen::Vector3d ForceEstimate::Wanted(const Frame& frame, const Eigen::Vector3d& way) {
  double area = 0;
  for (const StrokeEvent& event : frame.events) {
    if (event.type == StrokeEventType::kEnded) {
      inside_m_ = bend_m_ = 0;
    } else {
      area += event.area_m2;
      inside_m_ = std::max(inside_m_, event.depth_m);
    }
  }
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  if (area > 0 && way.norm() > kLeastWay_m) force -= config_.toughness_j_m2 * area / way.squaredNorm() * way;
  if (config_.flat_normal && inside_m_ > 0) {
    const Eigen::Vector3d normal = frame.T_WT.linear() * *config_.flat_normal;
    bend_m_ = (bend_m_ + normal.dot(way)) * std::exp(-frame.time_step_s / config_.relaxation_s);
    force -= config_.stiffness_n_m2 * inside_m_ * bend_m_ * normal;
  }
  return force;
}

ToolWrench ForceEstimate::Update(const Frame& frame) {
  if (!frame.trusted || frame.blade.empty()) {
    Reset();
    return {};
  }
  const Eigen::Vector3d middle = Middle(frame.blade);
  const Eigen::Vector3d way = has_last_ ? Eigen::Vector3d(middle - last_middle_) : Eigen::Vector3d::Zero();
  has_last_ = true;
  last_middle_ = middle;

  Eigen::Vector3d wanted = Wanted(frame, way);
  if (!wanted.allFinite()) {
    Reset();
    return {};
  }
  if (wanted.norm() > config_.max_force_n) wanted *= config_.max_force_n / wanted.norm();
  const double most = config_.max_slope_n_s * frame.time_step_s;
  Eigen::Vector3d change = wanted - force_;
  if (change.norm() > most) change *= most / change.norm();
  force_ += change;
  return {force_, (middle - frame.T_WT.translation()).cross(force_)};
}

}  // namespace meshless_cutting
