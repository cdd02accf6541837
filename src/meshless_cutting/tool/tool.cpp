#include "tool/tool.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

constexpr int kLongestAverage = 100;  // samples

}  // namespace

Tool::Tool(const ToolConfig& config) : config_(config), edge_(config.cutting_edge), edge_next_(config.cutting_edge) {
  if (const auto* fixed = std::get_if<FixedPoseSource>(&config_.pose_source)) T_WT_ = fixed->T_WT;
}

SampleVerdict Tool::Add(const ToolSample& sample) {
  const double measured_s = sample.measured_s.value_or(sample.time_s);
  if (!std::isfinite(sample.time_s) || !std::isfinite(measured_s) || !sample.position_m.allFinite() ||
      !sample.orientation_xyzw.allFinite())
    return SampleVerdict::kNotFinite;
  const double norm = sample.orientation_xyzw.norm();
  if (!(norm > 1e-6)) return SampleVerdict::kZeroQuaternion;
  if (newest_ && measured_s < newest_->measured_s) return SampleVerdict::kBackInTime;
  if (newest_ && measured_s == newest_->measured_s) return SampleVerdict::kDuplicate;

  const double time_s = newest_ ? std::max(sample.time_s, newest_->time_s) : sample.time_s;
  Queued queued{time_s, measured_s, Eigen::Isometry3d::Identity(), false, sample.blade_on};
  const Eigen::Vector4d q = sample.orientation_xyzw / norm;
  queued.T_WT.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  queued.T_WT.translation() = sample.position_m;
  if (newest_) {
    const double interval_s = measured_s - newest_->measured_s;
    if (interval_s <= config_.timeout_s) {
      averaged_over_ = std::min(averaged_over_ + 1, kLongestAverage);
      mean_interval_s_ += (interval_s - mean_interval_s_) / averaged_over_;
    }
    const double allowed = config_.max_speed_m_s * std::max(interval_s, mean_interval_s_);
    for (const Eigen::Vector3d& p : edge_)
      if ((queued.T_WT * p - newest_->T_WT * p).norm() > allowed) queued.jump = true;
  }
  newest_ = queued;
  queue_.push_back(queued);
  return queued.jump ? SampleVerdict::kJump : SampleVerdict::kAccepted;
}

std::vector<Eigen::Vector3d> Tool::BladeAt(const Eigen::Isometry3d& T_WT) const {
  std::vector<Eigen::Vector3d> points(edge_.size());
  std::transform(edge_.begin(), edge_.end(), points.begin(), [&](const Eigen::Vector3d& p) { return T_WT * p; });
  return points;
}

BladeMotion Tool::Move(double t0_s, double t1_s) {
  jumps_ = 0;
  edge_ = edge_next_;
  BladeMotion motion;
  const bool fixed = std::holds_alternative<FixedPoseSource>(config_.pose_source);
  double t = 0;
  // Every sample is one corner of the blade's path; between corners all points move linearly.
  auto extend = [&](double t_new, const std::vector<Eigen::Vector3d>& points) {
    if (blade_) motion.push_back({t, t_new, *blade_, points});
    blade_ = points;
    t = t_new;
  };
  size_t used = 0;
  for (; used < queue_.size() && queue_[used].time_s <= t1_s; ++used) {
    const Queued& sample = queue_[used];
    const bool stale = sample.measured_s - last_measured_s_ > config_.timeout_s;
    if (sample.jump) ++jumps_;
    if (sample.jump || stale || !sample.blade_on) blade_.reset();
    const double at = std::clamp((sample.time_s - t0_s) / (t1_s - t0_s), t, 1.0);
    if (blade_) {
      extend(at, BladeAt(sample.T_WT));
    } else if (sample.blade_on) {
      blade_ = BladeAt(sample.T_WT);
      t = at;
    }
    T_WT_ = sample.T_WT;
    last_sample_s_ = sample.time_s;
    last_measured_s_ = sample.measured_s;
  }
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(used));
  if (fixed && !blade_) blade_ = BladeAt(*T_WT_);
  // A blade that rests or waits for its next sample still cuts tissue that moves onto it, but not for ever: without
  // samples it is inactive. It stays where it is all the same: samples that were only kept back on their way, and say
  // by their own clock that there was no silence, go on from there.
  const bool silent = !fixed && t1_s - last_sample_s_ > config_.timeout_s;
  if (blade_ && T_WT_ && t < 1 && !silent) extend(1, BladeAt(*T_WT_));
  return motion;
}

bool Tool::SetEdge(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() != edge_.size()) return false;
  for (const Eigen::Vector3d& p : points)
    if (!p.allFinite()) return false;
  edge_next_ = points;
  return true;
}

}  // namespace meshless_cutting
