#include "dynamics/dynamics.h"

#include <algorithm>
#include <cmath>

#include "dynamics/contact_term.h"
#include "dynamics/elastic_term.h"
#include "dynamics/newton.h"
#include "dynamics/stiffness_damping_term.h"
#include "dynamics/time_scheme.h"

namespace meshless_cutting {
namespace {

/// A step that fails is repeated as 2, 4, ... steps; after so many doublings it is given up.
constexpr int kDoublings = 4;

/// Forces below this share of (shear modulus) (cross section of the object) are rounding.
constexpr double kForceRounding = 1e-10;

bool IsFinite(const std::vector<Eigen::Vector3d>& values) {
  return std::all_of(values.begin(), values.end(), [](const Eigen::Vector3d& v) { return v.allFinite(); });
}

ContactScale ContactScaleOf(const DynamicsConfig& config, const Tissue& tissue, const LameConstants& lame) {
  ContactScale scale;
  scale.modulus_pa = lame.lambda + 2 * lame.mu;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& X : tissue.particle_rest) bounds.extend(X);
  double volume = 0;
  for (double v : tissue.point_volume) volume = std::max(volume, v);
  scale.cell_m = std::cbrt(volume);
  const double gravity = config.gravity_m_s2 ? config.gravity_m_s2->norm() : 0;
  scale.own_pressure_pa = config.material.density_kg_m3 * gravity * bounds.sizes().maxCoeff();
  return scale;
}

}  // namespace

struct Dynamics::Parts {
  Parts(const DynamicsConfig& config_, const Tissue& tissue)
      : config(config_),
        pool(config.solver.threads),
        points(config.material, pool),
        elastic(points),
        potential(terms, pool),
        newton(potential, config.solver.relative_tolerance, config.solver.newton_iterations) {
    terms.push_back(&elastic);
    if (config.damping && config.damping->stiffness_s > 0) {
      terms.push_back(&stiffness_damping.emplace(config.damping->stiffness_s, points));
    }
    if (!config.obstacles.empty()) {
      terms.push_back(&contact.emplace(config.obstacles, ContactScaleOf(config, tissue, points.lame())));
    }
  }

  void TissueChanged(const Tissue& tissue);
  void Load(const TissueState& state);
  bool Solve(const Tissue& tissue, double time_step, AdvanceResult& result);
  bool SolveSteps(const Tissue& tissue, int steps, AdvanceResult& result);

  DynamicsConfig config;
  ThreadPool pool;
  ElasticPoints points;
  ElasticTerm elastic;
  std::optional<StiffnessDampingTerm> stiffness_damping;
  std::optional<ContactTerm> contact;
  std::vector<ForceTerm*> terms;
  IncrementalPotential potential;
  NewtonSolver newton;

  int particles = 0;
  bool skin_changed = true;
  bool first_step = true;
  double load = 0;  // N, what residuals are measured against besides the forces inside

  Field position, velocity, acceleration;                    // of the step in progress
  Field start_position, start_velocity, start_acceleration;  // of the frame
  Field stage, steady, still, scratch;
};

void Dynamics::Parts::TissueChanged(const Tissue& tissue) {
  particles = tissue.particle_count();
  skin_changed = true;
  points.TissueChanged(tissue);
  potential.Resize(particles);
  for (Field* field : {&position, &velocity, &acceleration, &start_position, &start_velocity, &start_acceleration, &stage,
                       &steady, &still, &scratch}) {
    field->resize(particles);
  }
  double weight = 0, volume = 0;
  const double gravity = config.gravity_m_s2 ? config.gravity_m_s2->norm() : 0;
  for (int j = 0; j < particles; ++j) {
    // A particle without mass is one that all its points have left for a twin.
    const bool is_free = !tissue.particle_fixed[j] && tissue.particle_mass[j] > 0;
    potential.free[j] = is_free ? 1 : 0;
    if (is_free) weight += std::pow(gravity * tissue.particle_mass[j], 2);
  }
  for (double v : tissue.point_volume) volume += v;
  newton.TissueChanged(tissue);
  load = std::sqrt(weight) + kForceRounding * points.lame().mu * std::pow(volume, 2.0 / 3);
}

void Dynamics::Parts::Load(const TissueState& state) {
  const Vector4 body = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  const bool know_velocity = static_cast<int>(state.velocity.size()) == particles && IsFinite(state.velocity);
  const bool know_acceleration = !first_step && static_cast<int>(state.acceleration.size()) == particles &&
                                 IsFinite(state.acceleration);
  const bool know_position = IsFinite(state.position);
  for (int j = 0; j < particles; ++j) {
    const bool is_free = potential.free[j] > 0;
    if (know_position) start_position[j] = Vector4::From(state.position[j]);  // else the last good ones
    start_velocity[j] = is_free && know_velocity ? Vector4::From(state.velocity[j]) : Vector4();
    // Not known: as if the elastic forces set in now. Exact for a body in free fall or at rest without strain.
    start_acceleration[j] = !is_free ? Vector4() : know_acceleration ? Vector4::From(state.acceleration[j]) : body;
  }
  first_step = false;
}

/// One implicit step from position, velocity, acceleration, which it replaces; false: they are as before.
bool Dynamics::Parts::Solve(const Tissue& tissue, double time_step, AdvanceResult& result) {
  const TimeScheme scheme(config.solver.integrator, time_step);
  const Vector4 gravity = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  const double mass_damping = config.damping ? config.damping->mass_per_s : 0;
  const double inertia = scheme.inertia() + mass_damping * scheme.rate();
  double reach = 0;
  for (int j = 0; j < particles; ++j) {
    const Vector4 &x = position[j], &v = velocity[j], &a = acceleration[j];
    potential.inertia[j] = tissue.particle_mass[j] * inertia;
    if (potential.free[j] == 0) {
      potential.inertia[j] = 0;
      potential.target[j] = still[j] = steady[j] = x;
      continue;
    }
    still[j] = scheme.Still(x, v, a);
    steady[j] = scheme.Steady(x, v, a);
    // Gravity and damping proportional to mass are inertia with another target.
    potential.target[j] = x + (scheme.inertia() / inertia) * (scheme.Target(x, v, a) - x) + (1 / inertia) * gravity +
                          (mass_damping * scheme.rate() / inertia) * (still[j] - x);
    const Vector4 way = potential.target[j] - x;
    reach = std::max(reach, Dot(way, way));
  }
  const StageMotion motion{scheme.rate(), &still, &position, 2 * std::sqrt(reach)};
  for (ForceTerm* term : terms) term->BeginStep(motion);

  // Begin where the object already is on its way, or, if that is lower, where it goes without forces.
  double energy = newton.Start(steady);
  stage = steady;
  if (!newton.StartIsConverged(load)) {
    const double free_energy = newton.Start(potential.target);
    if (free_energy < energy) {
      energy = free_energy;
      stage = potential.target;
    } else if (std::isfinite(energy)) {
      newton.Start(stage);
    } else {
      stage = position;
      newton.Start(stage);
    }
  }
  const NewtonSolver::Result solved = newton.Minimise(stage, load);
  result.newton_iterations += solved.newton_iterations;
  result.linear_iterations += solved.linear_iterations;
  result.relative_residual = solved.relative_residual;
  if (solved.verdict == NewtonSolver::Verdict::kFailed) return false;
  if (solved.verdict == NewtonSolver::Verdict::kNotConverged) result.status |= kStepNotConverged;

  for (ForceTerm* term : terms) term->EndStep(stage);
  for (int j = 0; j < particles; ++j) {
    if (potential.free[j] > 0) scheme.Finish(stage[j], position[j], velocity[j], acceleration[j]);
  }
  return true;
}

bool Dynamics::Parts::SolveSteps(const Tissue& tissue, int steps, AdvanceResult& result) {
  position = start_position;
  velocity = start_velocity;
  acceleration = start_acceleration;
  for (int step = 0; step < steps; ++step) {
    if (!Solve(tissue, config.time_step_s / steps, result)) return false;
  }
  return true;
}

Dynamics::Dynamics(const DynamicsConfig& config, const Tissue& tissue)
    : parts_(std::make_unique<Parts>(config, tissue)) {
  TissueChanged(tissue);
}

Dynamics::~Dynamics() = default;

void Dynamics::TissueChanged(const Tissue& tissue) { parts_->TissueChanged(tissue); }

AdvanceResult Dynamics::Advance(const Tissue& tissue, const SurfacePoints& skin, TissueState& state) {
  Parts& p = *parts_;
  AdvanceResult result;
  p.Load(state);
  if (p.contact) p.contact->SetSkin(skin, p.particles, p.skin_changed);
  p.skin_changed = false;

  bool solved = p.SolveSteps(tissue, 1, result);
  for (int doubling = 1; doubling <= kDoublings && !solved; ++doubling) {
    result.status |= kStepRolledBack;
    solved = p.SolveSteps(tissue, 1 << doubling, result);
  }
  if (!solved) {
    result.status |= kStepFrozen;
    p.position = p.start_position;
    std::fill(p.velocity.begin(), p.velocity.end(), Vector4());
    std::fill(p.acceleration.begin(), p.acceleration.end(), Vector4());
  }

  state.position.resize(p.particles);
  state.velocity.resize(p.particles);
  state.acceleration.resize(p.particles);
  for (int j = 0; j < p.particles; ++j) {
    state.position[j] = p.position[j].vector();
    state.velocity[j] = p.velocity[j].vector();
    state.acceleration[j] = p.acceleration[j].vector();
    result.kinetic_j += 0.5 * tissue.particle_mass[j] * state.velocity[j].squaredNorm();
    if (p.config.gravity_m_s2) result.gravity_j -= tissue.particle_mass[j] * p.config.gravity_m_s2->dot(state.position[j]);
  }
  result.elastic_j = p.points.Evaluate(p.position, p.scratch);
  if (p.contact) result.contacts = p.contact->contact_count();
  return result;
}

}  // namespace meshless_cutting
