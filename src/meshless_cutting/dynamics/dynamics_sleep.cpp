#include <algorithm>
#include <cmath>

#include "dynamics/dynamics_parts.h"

namespace meshless_cutting {
namespace {

/// An object may sleep when no particle moves farther in a step than this share of a cell.
constexpr double kSleepingWay = 1e-3;

}  // namespace

bool Dynamics::Parts::IsMoving() const {
  for (std::size_t j = 0; j < driven_end.size(); ++j) {
    if (potential.free[j] > 0) continue;
    const Vector4 way = driven_end[j] - position[j];
    if (Dot(way, way) > 0) return true;
  }
  return false;
}

bool Dynamics::Parts::StillSleeps(const TissueState& state) const {
  if (!asleep || static_cast<int>(state.position.size()) != particles ||
      static_cast<int>(state.velocity.size()) != particles) {
    return false;
  }
  for (int j = 0; j < particles; ++j) {
    const Vector4& x = position[j];
    const Eigen::Vector3d &y = state.position[j], &v = state.velocity[j];
    if (!(x.x == y.x() && x.y == y.y() && x.z == y.z() && v.x() == 0 && v.y() == 0 && v.z() == 0)) return false;
  }
  return true;
}

bool Dynamics::Parts::Sleeps(const Tissue& tissue, const TimeScheme& scheme) {
  if (IsMoving() || (viscous && !viscous->IsRelaxed())) return false;
  double fastest = 0;
  for (int j = 0; j < particles; ++j) fastest = std::max(fastest, Dot(velocity[j], velocity[j]));
  const auto& held = fragments.held;
  if (!config.gravity_m_s2 && fastest > 0 && std::find(held.begin(), held.end(), 0) != held.end()) return false;
  if (std::sqrt(fastest) * scheme.time_step_s() > kSleepingWay * cell) return false;
  std::fill(scratch.begin(), scratch.end(), Vector4());
  Prepare(tissue, scheme, scratch, scratch);
  newton.Begin();
  newton.Offer(position);
  if (!newton.StartIsConverged(load)) return false;
  for (ForceTerm* term : terms) term->EndStep(position);
  velocity = acceleration = scratch;
  return true;
}

}  // namespace meshless_cutting
