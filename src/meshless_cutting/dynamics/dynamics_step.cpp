#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/dynamics_parts.h"

namespace meshless_cutting {
namespace {

/// A step that ends with so many times the energy that it began with (plus a share of modulus times volume) has
/// overshot.
constexpr double kEnergyGrowth = 1.2;

/// Rounds of iterations for the last scheme that is tried. In random session 209, where a flake of a cell swings about a neck of
/// a two-hundredth of one, the energy bursts after one round, and no frame is repeated in halves with six.
constexpr int kLastRounds = 6;

/// One of implicit Euler, the last that is tried, is taken if it ends with less than so many times.
constexpr double kEnergyBurst = 4;

/// One that leaves so much of the forces counts as bad: a body that is turned inside out, say, or a piece that spins faster than the
/// scheme can follow, whose unbalanced steps would blow it up.
constexpr double kUnbalanced = 0.3;

}  // namespace

bool Dynamics::Parts::Solve(const Tissue& tissue, double time_step, AdvanceResult& result) {
  const TimeScheme scheme(is_rescue ? Integrator::kImplicitEuler : choice.integrator, time_step);
  if (Sleeps(tissue, scheme)) {
    result.relative_residual = newton.RelativeResidual(load);
    return true;
  }
  asleep = false;
  const bool is_explicit = explicit_steps && !is_rescue;
  if (!(is_explicit ? SolveExplicit(tissue, time_step) : SolveImplicit(tissue, scheme, result))) return false;
  elastic_force_is =
      elastic_force_is == ElasticForceIs::kOfTheEnd ? ElasticForceIs::kOfPosition : ElasticForceIs::kOfAnotherState;
  position.swap(end_position);
  velocity.swap(end_velocity);
  acceleration.swap(end_acceleration);
  if (scheme.is_static()) {
    std::fill(velocity.begin(), velocity.end(), Vector4());
    std::fill(acceleration.begin(), acceleration.end(), Vector4());
  } else {
    light.Follow(position, velocity, acceleration);
    grains.Restore(tissue, time_step, position, velocity, acceleration);
    if (grains.count() + light.count() > 0) elastic_force_is = ElasticForceIs::kOfAnotherState;
  }
  return true;
}

bool Dynamics::Parts::SolveImplicit(const Tissue& tissue, const TimeScheme& scheme, AdvanceResult& result) {
  const bool is_second_order = choice.integrator == Integrator::kGeneralizedAlpha;
  const StepEnergy start = is_second_order ? EnergyAtStart(tissue) : StepEnergy();
  NewtonSolver::Verdict verdict = Attempt(tissue, scheme, is_second_order ? 2 : 1, result);
  if (is_second_order && IsBad(tissue, verdict, result.relative_residual, start)) {
    // The end of a generalised-alpha step lies beyond the stage that was solved for. After violence that is no place to
    // go.
    verdict = Attempt(tissue, TimeScheme(choice.integrator, scheme.time_step_s(), true), 1, result);
    if (IsBad(tissue, verdict, result.relative_residual, start)) {
      verdict = Attempt(tissue, TimeScheme(Integrator::kImplicitEuler, scheme.time_step_s()), kLastRounds, result);
      elastic_force_is = ElasticForceIs::kOfAnotherState;
      if (GainsEnergy(tissue, start, kEnergyBurst)) return false;
    }
  }
  if (verdict == NewtonSolver::Verdict::kFailed) return false;
  if (verdict == NewtonSolver::Verdict::kNotConverged) result.status |= kStepNotConverged;
  for (ForceTerm* term : terms) term->EndStep(stage);
  return true;
}

bool Dynamics::Parts::IsBad(const Tissue& tissue, NewtonSolver::Verdict verdict, double residual,
                            const StepEnergy& start) {
  return verdict == NewtonSolver::Verdict::kFailed || residual > kUnbalanced || GainsEnergy(tissue, start, kEnergyGrowth);
}

bool Dynamics::Parts::GainsEnergy(const Tissue& tissue, const StepEnergy& start, double growth) {
  if (IsMoving()) return false;  // who moves held particles puts energy in
  double stored = EvaluateElastic(end_position, ElasticForceIs::kOfTheEnd);
  if (viscous) stored += explicit_steps && !is_rescue ? viscous->StoredEnergy() : viscous->StoredEnergyAt(end_position);
  const StepEnergy end = EnergyOf(tissue, stored, end_position, end_velocity);
  // What flies free does not feed what shakes, unless it hits something.
  const double share = !contact || contact->IsFar() ? 1 : 0;
  const double most = growth * (start.total_j - share * start.flight_j) + energy_floor;
  return !(end.total_j - share * end.flight_j <= most);
}

NewtonSolver::Verdict Dynamics::Parts::Attempt(const Tissue& tissue, const TimeScheme& scheme, int rounds,
                                               AdvanceResult& result) {
  Prepare(tissue, scheme, velocity, acceleration);

  // Begin where the object already is on its way, or where it goes without forces, or where it is: the lowest. The last
  // bounds the energy of a step whose iterations run out, and is where things come to rest.
  newton.Begin();
  newton.Offer(steady);
  const Field* best = &steady;
  const bool is_driven = !driven_end.empty();
  if (!newton.StartIsConverged(load)) {
    if (newton.Offer(is_driven ? Held(potential.target) : potential.target)) best = &potential.target;
    if (newton.energy() > EnergyToStay() && newton.Offer(is_driven ? Held(position) : position)) best = &position;
  }
  stage = is_driven ? Held(*best) : *best;
  newton.BeginStep(tissue);
  const NewtonSolver::Result solved = newton.Minimise(stage, load, rounds);
  result.newton_iterations += solved.newton_iterations;
  result.linear_iterations += solved.linear_iterations;
  result.relative_residual = solved.relative_residual;
  if (solved.verdict == NewtonSolver::Verdict::kFailed) return solved.verdict;

  if (!contact || contact->IsFar()) fragments.Balance(newton.residual(), potential.inertia, stage);
  ForParticles([&](const ParticleRange& range) {
    for (int j = range.begin; j < range.end; ++j) {
      end_position[j] = position[j];
      end_velocity[j] = velocity[j];
      end_acceleration[j] = acceleration[j];
      if (potential.free[j] > 0) {
        scheme.Finish(stage[j], end_position[j], end_velocity[j], end_acceleration[j]);
      } else if (!driven_end.empty()) {
        const Vector4 way = driven_share * (driven_end[j] - position[j]);
        end_position[j] = position[j] + way;
        end_velocity[j] = (1 / scheme.time_step_s()) * way;
      }
    }
  });
  return solved.verdict;
}

void Dynamics::Parts::Prepare(const Tissue& tissue, const TimeScheme& scheme, const Field& v, const Field& a) {
  const Vector4 gravity = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  const double mass_damping = config.damping ? config.damping->mass_per_s : 0;
  const double inertia = scheme.inertia() + mass_damping * scheme.rate();
  ForParticles([&](const ParticleRange& range) {
    double reach = 0;
    for (int j = range.begin; j < range.end; ++j) {
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
    chunk_sums[range.begin / kParticlesPerChunk] = reach;
  });
  const double reach = *std::max_element(chunk_sums.begin(), chunk_sums.end());
  StageMotion motion;
  motion.rate = scheme.rate();
  motion.still = &still;
  motion.start = &position;
  motion.reach = 2 * std::sqrt(reach) / scheme.stage();
  motion.stage = scheme.stage();
  motion.step_s = scheme.time_step_s();
  motion.elapsed_s = scheme.elapsed_s();
  elastic.BeginStep(motion);
  for (ForceTerm* term : terms) term->BeginStep(motion);
}

double Dynamics::Parts::EnergyToStay() {
  // Known of a second order step, if its other terms are never negative and nothing moves what is held.
  const bool is_known = choice.integrator == Integrator::kGeneralizedAlpha && !viscous && driven_end.empty();
  if (!is_known) return -std::numeric_limits<double>::infinity();
  const double inertia = SumOver([&](const ParticleRange& range) {
    double sum = 0;
    for (int j = range.begin; j < range.end; ++j) {
      const Vector4 way = position[j] - potential.target[j];
      sum += 0.5 * potential.inertia[j] * Dot(way, way);
    }
    return sum;
  });
  return elastic_energy_at_start + inertia;
}

Field& Dynamics::Parts::Held(const Field& y) {
  for (int j = 0; j < particles; ++j) scratch[j] = potential.free[j] > 0 ? y[j] : potential.target[j];
  return scratch;
}

double Dynamics::Parts::EvaluateElastic(const Field& x, ElasticForceIs of) {
  std::fill(elastic_force.begin(), elastic_force.end(), Vector4());
  elastic_energy = points.Evaluate(x, elastic_force);
  elastic_force_is = of;
  return elastic_energy;
}

Dynamics::Parts::StepEnergy Dynamics::Parts::EnergyAtStart(const Tissue& tissue) {
  if (elastic_force_is != ElasticForceIs::kOfPosition) EvaluateElastic(position, ElasticForceIs::kOfPosition);
  elastic_force_is = ElasticForceIs::kOfAnotherState;  // soon
  elastic_energy_at_start = elastic_energy;
  return EnergyOf(tissue, elastic_energy + (viscous ? viscous->StoredEnergy() : 0), position, velocity);
}

Dynamics::Parts::StepEnergy Dynamics::Parts::EnergyOf(const Tissue& tissue, double stored, const Field& x,
                                                      const Field& v) {
  const Vector4 gravity = config.gravity_m_s2 ? Vector4::From(*config.gravity_m_s2) : Vector4();
  StepEnergy energy;
  energy.total_j = stored + SumOver([&](const ParticleRange& range) {
    double sum = 0;
    for (int j = range.begin; j < range.end; ++j) {
      sum += tissue.particle_mass[j] * (0.5 * Dot(v[j], v[j]) - Dot(gravity, x[j] - position[j]));
      if (!force.empty()) sum -= Dot(force[j], x[j] - position[j]);
    }
    return sum;
  });
  energy.flight_j = fragments.EnergyOfFlight(tissue.particle_mass, gravity, position, x, v);
  return energy;
}

bool Dynamics::Parts::SolveExplicit(const Tissue& tissue, double time_step) {
  ExplicitSteps::Forces acting;
  if (config.gravity_m_s2) acting.gravity = Vector4::From(*config.gravity_m_s2);
  if (config.damping) acting.mass_damping = config.damping->mass_per_s;
  if (config.damping) acting.stiffness_damping = config.damping->stiffness_s;
  if (!force.empty()) acting.dead = &force;
  if (!driven_end.empty()) {
    for (int j = 0; j < particles; ++j) stage[j] = position[j] + driven_share * (driven_end[j] - position[j]);
    acting.held_end = &stage;
  }
  const int steps = choice.explicit_steps;  // as many in half the time when a frame is repeated in halves
  end_position = position;
  end_velocity = velocity;
  end_acceleration = acceleration;
  const StepEnergy start = EnergyAtStart(tissue);
  if (!explicit_steps->Run(tissue.particle_mass, acting, time_step / steps, steps, end_position, end_velocity,
                           end_acceleration)) {
    return false;
  }
  return !GainsEnergy(tissue, start, kEnergyGrowth);
}

}  // namespace meshless_cutting
