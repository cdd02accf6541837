#include "dynamics/dynamics.h"

#include <algorithm>
#include <cmath>

#include "dynamics/contact_term.h"
#include "dynamics/elastic_term.h"
#include "dynamics/explicit_steps.h"
#include "dynamics/fragments.h"
#include "dynamics/newton.h"
#include "dynamics/solver_choice.h"
#include "dynamics/stiffness_damping_term.h"
#include "dynamics/time_scheme.h"

namespace meshless_cutting {
namespace {

/// A step that fails is repeated as 2, 4, ... steps; after so many doublings it is given up.
constexpr int kDoublings = 4;

/// An object may sleep when no particle moves farther in a step than this share of a cell.
constexpr double kSleepingWay = 1e-3;

/// A second order step that ends with a larger residual, or with so many times the energy that it began with (plus this
/// share of modulus times volume), is repeated as one of implicit Euler.
constexpr double kRoughResidual = 0.05;
constexpr double kEnergyGrowth = 1.5;
constexpr double kEnergyFloor = 1e-3;

/// Differences of energies below this share of modulus times volume are rounding.
constexpr double kEnergyRounding = 1e-15;

/// Forces below this share of (shear modulus) (cross section of the object) are rounding.
constexpr double kForceRounding = 1e-8;

std::vector<MaterialConfig> MaterialsOf(const DynamicsConfig& config) {
  std::vector<MaterialConfig> materials{config.material};
  materials.insert(materials.end(), config.region_materials.begin(), config.region_materials.end());
  return materials;
}

bool IsFinite(const std::vector<Eigen::Vector3d>& values) {
  return std::all_of(values.begin(), values.end(), [](const Eigen::Vector3d& v) { return v.allFinite(); });
}

/// Edge of the largest cell: the grid's, of which many are full.
double CellOf(const Tissue& tissue) {
  double volume = 0;
  for (double v : tissue.point_volume) volume = std::max(volume, v);
  return std::cbrt(volume);
}

ContactScale ContactScaleOf(const DynamicsConfig& config, const Tissue& tissue, const LameConstants& lame) {
  ContactScale scale;
  scale.modulus_pa = lame.lambda + 2 * lame.mu;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& X : tissue.particle_rest) bounds.extend(X);
  scale.cell_m = CellOf(tissue);
  const double gravity = config.gravity_m_s2 ? config.gravity_m_s2->norm() : 0;
  scale.own_pressure_pa = config.material.density_kg_m3 * gravity * bounds.sizes().maxCoeff();
  return scale;
}

SolverChoice ChooseSolverFor(const DynamicsConfig& config, const Tissue& tissue, const LameConstants& stiffest,
                             double contact_stiffness) {
  SolverSituation situation;
  situation.cell_m = CellOf(tissue);
  situation.p_wave_modulus_pa = stiffest.lambda + 2 * stiffest.mu;
  situation.density_kg_m3 = config.material.density_kg_m3;
  for (const MaterialConfig& material : config.region_materials) {
    situation.density_kg_m3 = std::min(situation.density_kg_m3, material.density_kg_m3);
  }
  situation.stiffness_damping_s = config.damping ? config.damping->stiffness_s : 0;
  situation.step_s = config.time_step_s / config.solver.sub_steps;
  situation.contact_ratio = contact_stiffness * situation.cell_m / situation.p_wave_modulus_pa;
  return ChooseSolver(config.solver, situation);
}

}  // namespace

struct Dynamics::Parts {
  Parts(const DynamicsConfig& config_, const Tissue& tissue)
      : config(config_),
        pool(config.solver.threads),
        points(MaterialsOf(config), config.stabilisation, pool),
        elastic(points),
        potential(elastic, terms, pool),
        newton(potential, config.solver.relative_tolerance, config.solver.newton_iterations) {
    if (!config.obstacles.empty()) {
      terms.push_back(&contact.emplace(config.obstacles, ContactScaleOf(config, tissue, points.lame())));
    }
    choice = ChooseSolverFor(config, tissue, points.lame(), contact ? contact->stiffness_per_area() : 0);
    if (choice.integrator == Integrator::kExplicit) {
      explicit_steps.emplace(points, terms, potential);
    } else if (config.damping && config.damping->stiffness_s > 0) {
      terms.push_back(&stiffness_damping.emplace(config.damping->stiffness_s, points, elastic));
    }
  }

  void TissueChanged(const Tissue& tissue);
  bool IsMoving() const;
  Field& Held(const Field& y);
  void WeighLoad(const Tissue& tissue);
  void Load(const TissueState& state);
  void Prepare(const Tissue& tissue, const TimeScheme& scheme, const Field& v, const Field& a);
  bool Sleeps(const Tissue& tissue, const TimeScheme& scheme);
  double EnergyOf(const Tissue& tissue, const Field& x, const Field& v);
  NewtonSolver::Verdict Attempt(const Tissue& tissue, const TimeScheme& scheme, AdvanceResult& result);
  bool Solve(const Tissue& tissue, double time_step, AdvanceResult& result);
  bool SolveExplicit(const Tissue& tissue, double time_step);
  bool StillSleeps(const TissueState& state) const;
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
  SolverChoice choice;
  std::optional<ExplicitSteps> explicit_steps;
  Fragments fragments;

  bool asleep = false;  // all steps of the last frame were slept through
  AdvanceResult sleeping_result;
  int particles = 0;
  bool skin_changed = true;
  bool first_step = true;
  double load = 0;  // N, what residuals are measured against besides the forces inside
  double energy_floor = 0;  // J
  double cell = 0;  // m, edge of a cell of the background grid

  Field position, velocity, acceleration;                    // of the step in progress
  Field start_position, start_velocity, start_acceleration;  // of the frame
  Field end_position, end_velocity, end_acceleration;        // of the step in progress, until it is accepted
  Field stage, steady, still, scratch;

  // Scenes that move held particles, or pull: empty in others.
  std::vector<int> driven;
  std::vector<Eigen::Vector3d> driven_at_end;
  Field driven_end;       // per particle, at the end of the frame; meaningful where not free
  double driven_share = 1;  // of the way that is left to driven_end, what the step in progress goes
  Field force;            // N per particle
  double forces = 0;      // N, their norm
};

void Dynamics::Parts::TissueChanged(const Tissue& tissue) {
  particles = tissue.particle_count();
  skin_changed = true;
  asleep = false;
  points.TissueChanged(tissue);
  elastic.TissueChanged();
  for (ForceTerm* term : terms) term->TissueChanged(particles);
  fragments.Build(tissue);
  potential.Resize(particles);
  for (Field* field : {&position, &velocity, &acceleration, &start_position, &start_velocity, &start_acceleration,
                       &end_position, &end_velocity, &end_acceleration, &stage, &steady, &still, &scratch}) {
    field->resize(particles);
  }
  cell = CellOf(tissue);
  for (int j = 0; j < particles; ++j) {
    // A particle without mass is one that all its points have left for a twin.
    potential.free[j] = !tissue.particle_fixed[j] && tissue.particle_mass[j] > 0 ? 1 : 0;
  }
  double volume = 0;
  for (double v : tissue.point_volume) volume += v;
  newton.TissueChanged(tissue);
  const double modulus = points.lame().lambda + 2 * points.lame().mu;
  energy_floor = kEnergyFloor * modulus * volume;
  newton.SetEnergyRounding(kEnergyRounding * modulus * volume);
  driven.clear();
  driven_end.clear();
  force.clear();
  forces = 0;
  WeighLoad(tissue);
}

void Dynamics::Parts::WeighLoad(const Tissue& tissue) {
  const double gravity = config.gravity_m_s2 ? config.gravity_m_s2->norm() : 0;
  double weight = 0, volume = 0;
  for (int j = 0; j < particles; ++j) {
    if (potential.free[j]) weight += std::pow(gravity * tissue.particle_mass[j], 2);
  }
  for (double v : tissue.point_volume) volume += v;
  load = std::sqrt(weight) + kForceRounding * points.lame().mu * std::pow(volume, 2.0 / 3) + forces;
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
  driven_end.clear();
  if (driven.empty()) return;
  driven_end = start_position;
  for (std::size_t i = 0; i < driven.size(); ++i) driven_end[driven[i]] = Vector4::From(driven_at_end[i]);
}

/// Whether held particles move in this frame.
bool Dynamics::Parts::IsMoving() const {
  for (std::size_t j = 0; j < driven_end.size(); ++j) {
    if (potential.free[j] > 0) continue;
    const Vector4 way = driven_end[j] - position[j];
    if (Dot(way, way) > 0) return true;
  }
  return false;
}

/// A copy of y with the held particles where the step wants them.
Field& Dynamics::Parts::Held(const Field& y) {
  for (int j = 0; j < particles; ++j) scratch[j] = potential.free[j] > 0 ? y[j] : potential.target[j];
  return scratch;
}

/// Sets up the step from position with the given velocities and accelerations.
void Dynamics::Parts::Prepare(const Tissue& tissue, const TimeScheme& scheme, const Field& v, const Field& a) {
  const Vector4 gravity = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  const double mass_damping = config.damping ? config.damping->mass_per_s : 0;
  const double inertia = scheme.inertia() + mass_damping * scheme.rate();
  double reach = 0;
  for (int j = 0; j < particles; ++j) {
    const Vector4& x = position[j];
    if (potential.free[j] == 0) {
      potential.inertia[j] = 0;
      potential.target[j] = still[j] = steady[j] = x;
      if (!driven_end.empty()) {
        const Vector4 way = driven_share * (driven_end[j] - x);
        potential.target[j] = steady[j] = x + scheme.stage() * way;
        still[j] = steady[j] - (1 / (scheme.rate() * scheme.time_step_s())) * way;
        reach = std::max(reach, Dot(way, way));
      }
      continue;
    }
    potential.inertia[j] = tissue.particle_mass[j] * inertia;
    still[j] = scheme.Still(x, v[j], a[j]);
    steady[j] = scheme.Steady(x, v[j], a[j]);
    // Gravity and damping proportional to mass are inertia with another target.
    potential.target[j] = x + (scheme.inertia() / inertia) * (scheme.Target(x, v[j], a[j]) - x) +
                          (1 / inertia) * gravity + (mass_damping * scheme.rate() / inertia) * (still[j] - x);
    if (!force.empty()) potential.target[j] += (1 / potential.inertia[j]) * force[j];
    const Vector4 way = potential.target[j] - x;
    reach = std::max(reach, Dot(way, way));
  }
  StageMotion motion;
  motion.rate = scheme.rate();
  motion.still = &still;
  motion.start = &position;
  motion.reach = 2 * std::sqrt(reach) / scheme.stage();
  motion.stage = scheme.stage();
  motion.step_s = scheme.time_step_s();
  for (ForceTerm* term : terms) term->BeginStep(motion);
}

/// Where next to nothing moves and the forces balance without inertia, the object sleeps: it stays exactly where it is.
/// Only under gravity, or where all its pieces are held, or nothing moves at all: else balance may mean that it drifts.
bool Dynamics::Parts::Sleeps(const Tissue& tissue, const TimeScheme& scheme) {
  if (IsMoving()) return false;
  double fastest = 0;
  for (int j = 0; j < particles; ++j) fastest = std::max(fastest, Dot(velocity[j], velocity[j]));
  const auto& held = fragments.held;
  if (!config.gravity_m_s2 && fastest > 0 && std::find(held.begin(), held.end(), 0) != held.end()) return false;
  if (std::sqrt(fastest) * scheme.time_step_s() > kSleepingWay * cell) return false;
  std::fill(scratch.begin(), scratch.end(), Vector4());
  Prepare(tissue, scheme, scratch, scratch);
  newton.Start(position);
  if (!newton.StartIsConverged(load)) return false;
  for (ForceTerm* term : terms) term->EndStep(position);
  velocity = acceleration = scratch;
  return true;
}

/// Energy of motion, strain and gravity, J, at the given state. Contact has none worth counting.
double Dynamics::Parts::EnergyOf(const Tissue& tissue, const Field& x, const Field& v) {
  std::fill(scratch.begin(), scratch.end(), Vector4());
  double energy = points.Evaluate(x, scratch);
  const Vector4 gravity = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  for (int j = 0; j < particles; ++j) {
    energy += tissue.particle_mass[j] * (0.5 * Dot(v[j], v[j]) - Dot(gravity, x[j] - position[j]));
    if (!force.empty()) energy -= Dot(force[j], x[j] - position[j]);
  }
  return energy;
}

/// One step of `scheme` from position, velocity, acceleration into those of the end.
NewtonSolver::Verdict Dynamics::Parts::Attempt(const Tissue& tissue, const TimeScheme& scheme, AdvanceResult& result) {
  Prepare(tissue, scheme, velocity, acceleration);

  // Begin where the object already is on its way, or where it goes without forces, or where it is: the lowest. The last
  // bounds the energy of a step whose iterations run out.
  stage = steady;
  double energy = newton.Start(stage);
  if (!newton.StartIsConverged(load)) {
    const Field* best = &steady;
    const bool is_driven = !driven_end.empty();
    for (const Field* guess : {&potential.target, &position}) {
      const double other = newton.Start(is_driven ? Held(*guess) : *guess);
      if (other < energy) {
        energy = other;
        best = guess;
      }
    }
    stage = is_driven ? Held(*best) : *best;
    if (best != &position) newton.Start(stage);
  }
  newton.BeginStep(tissue);
  const NewtonSolver::Result solved = newton.Minimise(stage, load);
  result.newton_iterations += solved.newton_iterations;
  result.linear_iterations += solved.linear_iterations;
  result.relative_residual = solved.relative_residual;
  if (solved.verdict == NewtonSolver::Verdict::kFailed) return solved.verdict;

  if (!contact || contact->IsFar()) fragments.Balance(newton.residual(), potential.inertia, stage);
  end_position = position;
  end_velocity = velocity;
  end_acceleration = acceleration;
  for (int j = 0; j < particles; ++j) {
    if (potential.free[j] > 0) {
      scheme.Finish(stage[j], end_position[j], end_velocity[j], end_acceleration[j]);
    } else if (!driven_end.empty()) {
      const Vector4 way = driven_share * (driven_end[j] - position[j]);
      end_position[j] = position[j] + way;
      end_velocity[j] = (1 / scheme.time_step_s()) * way;
    }
  }
  return solved.verdict;
}

/// Whether nothing has changed since the object fell asleep.
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

/// As Solve, in many small steps. False also when the energy grows: the steps were too long for what the object has become.
bool Dynamics::Parts::SolveExplicit(const Tissue& tissue, double time_step) {
  ExplicitSteps::Forces acting;
  if (config.gravity_m_s2) acting.gravity = Vector4::From(*config.gravity_m_s2);
  if (config.damping) acting.mass_damping = config.damping->mass_per_s;
  if (config.damping) acting.stiffness_damping = config.damping->stiffness_s;
  if (!force.empty()) acting.dead = &force;
  const bool is_moving = IsMoving();
  if (!driven_end.empty()) {
    for (int j = 0; j < particles; ++j) stage[j] = position[j] + driven_share * (driven_end[j] - position[j]);
    acting.held_end = &stage;
  }
  const int steps = choice.explicit_steps;  // as many in half the time when a frame is repeated in halves
  end_position = position;
  end_velocity = velocity;
  end_acceleration = acceleration;
  const double growth = kEnergyGrowth * EnergyOf(tissue, position, velocity) + energy_floor;
  if (!explicit_steps->Run(tissue.particle_mass, acting, time_step / steps, steps, end_position, end_velocity,
                           end_acceleration)) {
    return false;
  }
  if (!is_moving && !(EnergyOf(tissue, end_position, end_velocity) <= growth)) return false;
  position.swap(end_position);
  velocity.swap(end_velocity);
  acceleration.swap(end_acceleration);
  return true;
}

/// One step from position, velocity, acceleration, which it replaces; false: they are as before.
bool Dynamics::Parts::Solve(const Tissue& tissue, double time_step, AdvanceResult& result) {
  const TimeScheme scheme(choice.integrator, time_step);
  if (Sleeps(tissue, scheme)) {
    result.relative_residual = newton.RelativeResidual(load);
    return true;
  }
  asleep = false;
  if (explicit_steps) return SolveExplicit(tissue, time_step);
  NewtonSolver::Verdict verdict = Attempt(tissue, scheme, result);
  if (choice.integrator == Integrator::kGeneralizedAlpha &&
      (verdict == NewtonSolver::Verdict::kFailed || result.relative_residual > kRoughResidual ||
       (!IsMoving() && EnergyOf(tissue, end_position, end_velocity) >
                           kEnergyGrowth * EnergyOf(tissue, position, velocity) + energy_floor))) {
    // The end of a second order step lies beyond the stage that was solved for. After violence that is no place to go.
    verdict = Attempt(tissue, TimeScheme(Integrator::kImplicitEuler, time_step), result);
  }
  if (verdict == NewtonSolver::Verdict::kFailed) return false;
  if (verdict == NewtonSolver::Verdict::kNotConverged) result.status |= kStepNotConverged;
  for (ForceTerm* term : terms) term->EndStep(stage);
  position.swap(end_position);
  velocity.swap(end_velocity);
  acceleration.swap(end_acceleration);
  if (scheme.is_static()) {
    std::fill(velocity.begin(), velocity.end(), Vector4());
    std::fill(acceleration.begin(), acceleration.end(), Vector4());
  }
  return true;
}

bool Dynamics::Parts::SolveSteps(const Tissue& tissue, int steps, AdvanceResult& result) {
  position = start_position;
  velocity = start_velocity;
  acceleration = start_acceleration;
  asleep = true;
  for (int step = 0; step < steps; ++step) {
    driven_share = 1.0 / (steps - step);
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

Eigen::Vector3d Dynamics::ElasticForce(int j) const { return parts_->scratch[j].vector(); }

void Dynamics::Tune(const Tuning& tuning, const Tissue& tissue) {
  Parts& p = *parts_;
  if (p.config.gravity_m_s2) p.config.gravity_m_s2 = tuning.gravity_m_s2;
  if (p.config.damping) p.config.damping->mass_per_s = tuning.damping.mass_per_s;
  if (p.stiffness_damping) p.stiffness_damping->set_beta(tuning.damping.stiffness_s);
  p.newton.set_iterations(tuning.newton_iterations);
  p.WeighLoad(tissue);
  p.asleep = false;
}

AdvanceResult Dynamics::Advance(const Tissue& tissue, const SurfacePoints& skin, TissueState& state) {
  Parts& p = *parts_;
  if (p.StillSleeps(state)) return p.sleeping_result;
  AdvanceResult result;
  p.Load(state);
  if (p.contact) p.contact->SetSkin(skin, p.particles, p.skin_changed);
  p.skin_changed = false;

  bool solved = p.SolveSteps(tissue, p.config.solver.sub_steps, result);
  for (int doubling = 1; doubling <= kDoublings && !solved; ++doubling) {
    result.status |= kStepRolledBack;
    solved = p.SolveSteps(tissue, p.config.solver.sub_steps << doubling, result);
  }
  if (!solved) {
    result.status |= kStepFrozen;
    p.asleep = false;
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
  std::fill(p.scratch.begin(), p.scratch.end(), Vector4());
  result.elastic_j = p.points.Evaluate(p.position, p.scratch);
  if (p.contact) result.contacts = p.contact->contact_count();
  p.sleeping_result = result;
  return result;
}

const std::string& Dynamics::solver_summary() const { return parts_->choice.reason; }

}  // namespace meshless_cutting
