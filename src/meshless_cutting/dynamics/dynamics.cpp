#include "dynamics/dynamics.h"

#include <algorithm>
#include <cmath>

#include "dynamics/dynamics_parts.h"

namespace meshless_cutting {
namespace {

/// A step that fails is repeated as 2, 4, ... steps; after so many doublings it is given up.
constexpr int kDoublings = 4;

bool IsFinite(const std::vector<Eigen::Vector3d>& values) {
  return std::all_of(values.begin(), values.end(), [](const Eigen::Vector3d& v) { return v.allFinite(); });
}

}  // namespace

bool Dynamics::Parts::SolveSteps(const Tissue& tissue, int steps, AdvanceResult& result) {
  position = start_position;
  velocity = start_velocity;
  acceleration = start_acceleration;
  if (viscous) viscous->Restore();
  asleep = true;
  for (int step = 0; step < steps; ++step) {
    driven_share = 1.0 / (steps - step);
    if (!Solve(tissue, config.time_step_s / steps, result)) return false;
  }
  return true;
}

void Dynamics::Parts::Load(const TissueState& state) {
  const Vector4 body = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  const bool know_velocity = static_cast<int>(state.velocity.size()) == particles && IsFinite(state.velocity);
  const bool know_acceleration =
      !first_step && static_cast<int>(state.acceleration.size()) == particles && IsFinite(state.acceleration);
  const bool know_position = IsFinite(state.position);
  bool is_as_it_was = true;
  for (int j = 0; j < particles; ++j) {
    const bool is_free = potential.free[j] > 0;
    is_as_it_was = is_as_it_was && state.position[j] == position[j].vector();
    if (know_position) start_position[j] = Vector4::From(state.position[j]);  // else the last good ones
    start_velocity[j] = is_free && know_velocity ? Vector4::From(state.velocity[j]) : Vector4();
    // Not known: as if the elastic forces set in now. Exact for a body in free fall or at rest without strain.
    start_acceleration[j] = !is_free ? Vector4() : know_acceleration ? Vector4::From(state.acceleration[j]) : body;
  }
  first_step = false;
  if (!is_as_it_was) elastic_force_is = ElasticForceIs::kOfAnotherState;
  driven_end.clear();
  if (driven.empty()) return;
  driven_end = start_position;
  for (std::size_t i = 0; i < driven.size(); ++i) driven_end[driven[i]] = Vector4::From(driven_at_end[i]);
}

void Dynamics::Parts::Store(const Tissue& tissue, TissueState& state, AdvanceResult& result) {
  state.position.resize(particles);
  state.velocity.resize(particles);
  state.acceleration.resize(particles);
  for (int j = 0; j < particles; ++j) {
    state.position[j] = position[j].vector();
    state.velocity[j] = velocity[j].vector();
    state.acceleration[j] = acceleration[j].vector();
    result.kinetic_j += 0.5 * tissue.particle_mass[j] * state.velocity[j].squaredNorm();
    if (config.gravity_m_s2) result.gravity_j -= tissue.particle_mass[j] * config.gravity_m_s2->dot(state.position[j]);
  }
  if (elastic_force_is != ElasticForceIs::kOfPosition) EvaluateElastic(position, ElasticForceIs::kOfPosition);
  result.elastic_j = elastic_energy;
  if (viscous) {
    viscous->AddForce(position, elastic_force);
    elastic_force_is = ElasticForceIs::kOfAnotherState;  // no longer that of strain alone
    result.elastic_j += viscous->StoredEnergy();
  }
  if (contact) result.contacts = contact->contact_count();
}

Dynamics::Dynamics(const DynamicsConfig& config, const Tissue& tissue)
    : parts_(std::make_unique<Parts>(config, tissue)) {
  TissueChanged(tissue);
}

Dynamics::~Dynamics() = default;

void Dynamics::TissueChanged(const Tissue& tissue, const std::function<void()>& beside) {
  parts_->TissueChanged(tissue, beside);
}

void Dynamics::SetDriven(const std::vector<int>& particles, const std::vector<Eigen::Vector3d>& at_end) {
  for (std::size_t i = 0; i < particles.size() && parts_->asleep; ++i) {
    parts_->asleep = parts_->position[particles[i]].vector() == at_end[i];
  }
  parts_->driven = particles;
  parts_->driven_at_end = at_end;
}

void Dynamics::SetForces(const std::vector<Eigen::Vector3d>& forces) {
  Parts& p = *parts_;
  if (p.force.size() != forces.size()) p.asleep = false;
  for (std::size_t j = 0; j < forces.size() && p.asleep; ++j) p.asleep = p.force[j].vector() == forces[j];
  p.force.resize(forces.size());
  double sum = 0;
  for (std::size_t j = 0; j < forces.size(); ++j) {
    p.force[j] = Vector4::From(forces[j]);
    sum += forces[j].squaredNorm();
  }
  p.load += std::sqrt(sum) - p.forces;
  p.forces = std::sqrt(sum);
}

Eigen::Vector3d Dynamics::ElasticForce(int j) const { return parts_->elastic_force[j].vector(); }

void Dynamics::Tune(const Tuning& tuning, const Tissue& tissue) {
  Parts& p = *parts_;
  if (p.config.gravity_m_s2) p.config.gravity_m_s2 = tuning.gravity_m_s2;
  if (p.config.damping) p.config.damping->mass_per_s = tuning.damping.mass_per_s;
  if (p.config.damping && !p.explicit_steps) p.elastic.SetDamping(tuning.damping.stiffness_s);
  p.newton.set_iterations(tuning.newton_iterations);
  p.WeighLoad(tissue);
  p.asleep = false;
}

AdvanceResult Dynamics::Advance(const Tissue& tissue, const SurfacePoints& skin, TissueState& state) {
  Parts& p = *parts_;
  if (p.StillSleeps(state)) return p.sleeping_result;
  AdvanceResult result;
  p.Load(state);
  if (p.viscous) p.viscous->Keep();
  if (p.contact) p.contact->SetSkin(skin, p.particles, p.skin_changed);
  p.skin_changed = false;

  bool solved = p.SolveSteps(tissue, p.config.solver.sub_steps, result);
  for (int doubling = 1; doubling <= kDoublings && !solved; ++doubling) {
    result.status |= kStepRolledBack;
    p.elastic_force_is = Parts::ElasticForceIs::kOfAnotherState;
    solved = p.SolveSteps(tissue, p.config.solver.sub_steps << doubling, result);
  }
  if (!solved && p.explicit_steps) {
    // What has been torn out of shape is too stiff for explicit steps of any length that one may wait for.
    p.is_rescue = true;
    p.elastic_force_is = Parts::ElasticForceIs::kOfAnotherState;
    solved = p.SolveSteps(tissue, p.config.solver.sub_steps, result);
    p.is_rescue = false;
  }
  if (!solved) {
    result.status |= kStepFrozen;
    p.asleep = false;
    p.elastic_force_is = Parts::ElasticForceIs::kOfAnotherState;
    p.position = p.start_position;
    p.strain_limit.Apply(tissue, p.potential.free, p.position);
    std::fill(p.velocity.begin(), p.velocity.end(), Vector4());
    std::fill(p.acceleration.begin(), p.acceleration.end(), Vector4());
  }

  p.Store(tissue, state, result);
  p.sleeping_result = result;
  return result;
}

const std::string& Dynamics::solver_summary() const { return parts_->choice.reason; }

}  // namespace meshless_cutting
