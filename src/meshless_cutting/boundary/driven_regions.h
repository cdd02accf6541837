// Held and moved regions: where their particles are at a given time, and with what force they are held.
#pragma once

#include <string>
#include <vector>

#include "dynamics/dynamics.h"
#include "scene/scene.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Force and torque with which a region is held against the elastic, body and dead forces on it, scene frame; without inertia,
/// damping and contact. In equilibrium those of all regions balance the loads.
struct Reaction {
  std::string name;
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();  // about `about`
  Eigen::Vector3d about = Eigen::Vector3d::Zero();      // scene frame, m: on the axis of rotation, else the middle of the region at rest
};

class DrivenRegions {
 public:
  explicit DrivenRegions(const Scene& scene) : scene_(scene) {}

  /// After the tissue changed. A particle in several regions belongs to the last, prescribed ones after fixed ones.
  void TissueChanged(const Tissue& tissue);

  /// Tells the dynamics where prescribed particles are at time_s, the end of the frame.
  void Drive(const Tissue& tissue, double time_s, Dynamics& dynamics);

  /// `forces`: dead loads per particle, N, may be empty. One per region, fixed ones first.
  const std::vector<Reaction>& Reactions(const Tissue& tissue, const TissueState& state, const Dynamics& dynamics,
                                         const std::vector<Eigen::Vector3d>& forces);

  bool is_moving() const { return !scene_.object.prescribed.empty(); }

 private:
  const Scene& scene_;
  std::vector<std::vector<int>> members_;  // per region: particles
  std::vector<int> driven_;
  std::vector<Eigen::Vector3d> at_end_;
  std::vector<Reaction> reactions_;
};

}  // namespace meshless_cutting
