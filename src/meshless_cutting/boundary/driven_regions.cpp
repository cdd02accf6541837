#include "boundary/driven_regions.h"

#include <Eigen/Geometry>

namespace meshless_cutting {
namespace {

/// Nodes on the face of a box belong to it.
constexpr double kSlackShare = 1e-9;

}  // namespace

void DrivenRegions::TissueChanged(const Tissue& tissue) {
  const ObjectConfig& object = scene_.object;
  const std::size_t fixed = object.fixed.size(), count = fixed + object.prescribed.size();
  members_.assign(count, {});
  driven_.clear();
  const auto box = [&](std::size_t i) -> const Box& {
    return i < fixed ? object.fixed[i] : object.prescribed[i - fixed].box;
  };
  for (int j = 0; j < tissue.particle_count(); ++j) {
    if (!tissue.particle_fixed[j]) continue;
    for (std::size_t i = count; i > 0; --i) {
      if (!box(i - 1).Holds(tissue.particle_rest[j], kSlackShare * object.cell_size_m)) continue;
      members_[i - 1].push_back(j);
      break;
    }
  }
  reactions_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    reactions_[i].name = !box(i).name.empty() ? box(i).name
                         : i < fixed          ? "fixed" + std::to_string(i)
                                              : "prescribed" + std::to_string(i - fixed);
    Eigen::AlignedBox3d bounds;
    for (int j : members_[i]) bounds.extend(tissue.particle_rest[j]);
    if (i >= fixed) {
      reactions_[i].about = object.T_WO * object.prescribed[i - fixed].axis_point;
      driven_.insert(driven_.end(), members_[i].begin(), members_[i].end());
      if (object.prescribed[i - fixed].angle_rad.values.size() > 1) continue;
    }
    if (!members_[i].empty()) reactions_[i].about = object.T_WO * bounds.center();
  }
}

void DrivenRegions::Drive(const Tissue& tissue, double time_s, Dynamics& dynamics) {
  const ObjectConfig& object = scene_.object;
  at_end_.clear();
  for (std::size_t i = 0; i < object.prescribed.size(); ++i) {
    const PrescribedRegion& region = object.prescribed[i];
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(region.angle_rad.At(time_s), region.axis).toRotationMatrix();
    const Eigen::Vector3d d = region.displacement_m.At(time_s);
    for (int j : members_[object.fixed.size() + i]) {
      const Eigen::Vector3d X = region.axis_point + R * (tissue.particle_rest[j] - region.axis_point) + d;
      at_end_.push_back(object.T_WO * X);
    }
  }
  dynamics.SetDriven(driven_, at_end_);
}

const std::vector<Reaction>& DrivenRegions::Reactions(const Tissue& tissue, const TissueState& state,
                                                      const Dynamics& dynamics,
                                                      const std::vector<Eigen::Vector3d>& forces) {
  const Eigen::Vector3d gravity = scene_.gravity_m_s2.value_or(Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Reaction& reaction = reactions_[i];
    reaction.force_n.setZero();
    reaction.torque_nm.setZero();
    for (int j : members_[i]) {
      Eigen::Vector3d force = dynamics.ElasticForce(j) - tissue.particle_mass[j] * gravity;
      if (!forces.empty()) force -= forces[j];
      reaction.force_n += force;
      reaction.torque_nm += (state.position[j] - reaction.about).cross(force);
    }
  }
  return reactions_;
}

}  // namespace meshless_cutting
