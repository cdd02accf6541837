#include "tools/tool_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshless_cutting {
namespace {

// Slope at a point between two secants, Fritsch & Carlson's harmonic mean: zero where they differ in sign.
double MonotoneSlope(double before_s, double before, double after_s, double after) {
  if (before * after <= 0) return 0;
  const double w1 = 2 * after_s + before_s;
  const double w2 = after_s + 2 * before_s;
  return (w1 + w2) / (w1 / before + w2 / after);
}

}  // namespace

ToolPath::ToolPath(std::string frame, std::vector<WayPoint> way_points)
    : frame_(std::move(frame)), way_points_(std::move(way_points)) {
  const std::size_t count = way_points_.size();
  values_.resize(count);
  slopes_.assign(count, Coordinates::Zero());  // at rest at both ends
  for (std::size_t i = 0; i < count; ++i) {
    values_[i].head<3>() = way_points_[i].position_m;
    values_[i].tail<4>() = way_points_[i].orientation.normalized().coeffs();
    // q and -q are one rotation: take the one on the way from the last.
    if (i > 0 && values_[i].tail<4>().dot(values_[i - 1].tail<4>()) < 0) values_[i].tail<4>() *= -1;
  }
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double before_s = way_points_[i].time_s - way_points_[i - 1].time_s;
    const double after_s = way_points_[i + 1].time_s - way_points_[i].time_s;
    for (int c = 0; c < 7; ++c) {
      slopes_[i][c] = MonotoneSlope(before_s, (values_[i][c] - values_[i - 1][c]) / before_s, after_s,
                                    (values_[i + 1][c] - values_[i][c]) / after_s);
    }
  }
}

Eigen::Isometry3d ToolPath::At(double time_s) const {
  const double t = std::clamp(time_s, start_s(), end_s());
  const auto after = std::upper_bound(way_points_.begin() + 1, way_points_.end() - 1, t,
                                      [](double time, const WayPoint& point) { return time < point.time_s; });
  const auto i = static_cast<std::size_t>(after - way_points_.begin());
  const double h = way_points_[i].time_s - way_points_[i - 1].time_s;
  const double s = (t - way_points_[i - 1].time_s) / h;
  // Cubic Hermite.
  const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s);
  const double h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
  const Coordinates value = h00 * values_[i - 1] + h10 * h * slopes_[i - 1] + h01 * values_[i] + h11 * h * slopes_[i];
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = value.head<3>();
  pose.linear() = Eigen::Quaterniond(value[6], value[3], value[4], value[5]).normalized().toRotationMatrix();
  return pose;
}

}  // namespace meshless_cutting
