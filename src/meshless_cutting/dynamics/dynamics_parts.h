// What the dynamics consist of and the steps in progress: the insides of Dynamics, for the files that implement it.
//   dynamics_parts.cpp  how the parts are made, and made again after a cut
//   dynamics_sleep.cpp  when an object is left alone
//   dynamics_step.cpp   one step, implicit or explicit, and what is done when it goes wrong
//   dynamics.cpp        the frame: steps, halves, the state in and out
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "dynamics/contact_term.h"
#include "dynamics/dynamics.h"
#include "dynamics/elastic_term.h"
#include "dynamics/explicit_steps.h"
#include "dynamics/field_loops.h"
#include "dynamics/fragments.h"
#include "dynamics/grains.h"
#include "dynamics/light_particles.h"
#include "dynamics/newton.h"
#include "dynamics/solver_choice.h"
#include "dynamics/strain_limit.h"
#include "dynamics/time_scheme.h"
#include "dynamics/viscous_term.h"

namespace meshless_cutting {

struct Dynamics::Parts {
  Parts(const DynamicsConfig& config, const Tissue& tissue);

  // dynamics_parts.cpp
  void TissueChanged(const Tissue& tissue, const std::function<void()>& beside);
  void WeighLoad(const Tissue& tissue);
  /// How much each piece counts in residuals; before WeighLoad.
  void WeighFragments(const Tissue& tissue);

  // dynamics_sleep.cpp
  /// Whether held particles move in this frame.
  bool IsMoving() const;
  /// Whether nothing has changed since the object fell asleep.
  bool StillSleeps(const TissueState& state) const;
  /// Where next to nothing moves and the forces balance without inertia, the object sleeps: it stays exactly where it
  /// is. Only under gravity, or where all its pieces are held, or nothing moves at all: else balance may mean that it
  /// drifts.
  bool Sleeps(const Tissue& tissue, const TimeScheme& scheme);

  // dynamics_step.cpp
  /// One step from position, velocity, acceleration, which it replaces; false: they are as before.
  bool Solve(const Tissue& tissue, double time_step, AdvanceResult& result);
  /// One step into end_position, end_velocity, end_acceleration: by Newton's method. Where a second order step ends
  /// badly it is made again with a more cautious scheme, and once more as implicit Euler.
  bool SolveImplicit(const Tissue& tissue, const TimeScheme& scheme, AdvanceResult& result);
  struct StepEnergy {
    double total_j = 0;   // of strain, motion and gravity, the last relative to position; contact has none worth counting
    double flight_j = 0;  // what of it belongs to the flight of free fragments as wholes
  };
  /// Whether the step that ends in end_position, end_velocity must not be taken.
  bool IsBad(const Tissue& tissue, NewtonSolver::Verdict verdict, double residual, const StepEnergy& start);
  /// The step ends with more than `growth` times the energy that it starts with.
  bool GainsEnergy(const Tissue& tissue, const StepEnergy& start, double growth);
  /// As SolveImplicit, in many small steps. False also when the energy grows: the steps were too long for what the
  /// object has become.
  bool SolveExplicit(const Tissue& tissue, double time_step);
  /// One step of `scheme` from position, velocity, acceleration into those of the end; in up to `rounds` of Newton's
  /// method while the forces are far from balance.
  NewtonSolver::Verdict Attempt(const Tissue& tissue, const TimeScheme& scheme, int rounds, AdvanceResult& result);
  /// Sets up the step from position with the given velocities and accelerations.
  void Prepare(const Tissue& tissue, const TimeScheme& scheme, const Field& v, const Field& a);
  /// The potential of the step is no less than this where the object is, J, known without evaluating it.
  double EnergyToStay();
  /// A copy of y (in scratch) with the held particles where the step wants them.
  Field& Held(const Field& y);
  /// Energy of strain, J; leaves its gradient in elastic_force.
  enum class ElasticForceIs { kOfAnotherState, kOfPosition, kOfTheEnd };
  double EvaluateElastic(const Field& x, ElasticForceIs of);
  /// Of position, velocity.
  StepEnergy EnergyAtStart(const Tissue& tissue);
  /// Of any state; `stored`: its energy of strain, J.
  StepEnergy EnergyOf(const Tissue& tissue, double stored, const Field& x, const Field& v);

  /// task(range) for all particles, in parallel.
  template <class Task>
  void ForParticles(const Task& task) {
    pool.ForEach(ChunkCount(particles, kParticlesPerChunk), [&](int c) { task(ParticleRange(c, particles)); });
  }
  /// Sum of what `task` returns for each range of particles, in parallel; the same bits on any number of threads.
  template <class Task>
  double SumOver(const Task& task) {
    ForParticles([&](const ParticleRange& range) { chunk_sums[range.begin / kParticlesPerChunk] = task(range); });
    double sum = 0;
    for (double s : chunk_sums) sum += s;
    return sum;
  }

  // dynamics.cpp
  /// The frame: `steps` equal steps from the start of the frame; false when one of them failed.
  bool SolveSteps(const Tissue& tissue, int steps, AdvanceResult& result);
  /// The state as the start of the frame; what of it is not finite is replaced.
  void Load(const TissueState& state);
  /// Position, velocity and acceleration as the state, with its energies.
  void Store(const Tissue& tissue, TissueState& state, AdvanceResult& result);

  DynamicsConfig config;
  ThreadPool pool;
  ElasticPoints points;
  ElasticTerm elastic;
  std::optional<ViscousTerm> viscous;
  std::optional<ContactTerm> contact;
  std::vector<ForceTerm*> terms;
  IncrementalPotential potential;
  NewtonSolver newton;
  SolverChoice choice;
  std::optional<ExplicitSteps> explicit_steps;
  Fragments fragments;
  Grains grains;
  StrainLimit strain_limit;
  LightParticles light;

  bool is_rescue = false;  // explicit steps have failed: this frame is made of steps of implicit Euler
  bool asleep = false;  // all steps of the last frame were slept through
  AdvanceResult sleeping_result;
  int particles = 0;
  std::vector<double> fragment_mass;  // kg, scratch
  bool skin_changed = true;
  bool first_step = true;
  double load = 0;          // N, what residuals are measured against besides the forces inside
  double energy_floor = 0;  // J
  double cell = 0;          // m, edge of a cell of the background grid

  Field position, velocity, acceleration;                    // of the step in progress
  Field start_position, start_velocity, start_acceleration;  // of the frame
  Field end_position, end_velocity, end_acceleration;        // of the step in progress, until it is accepted
  Field stage, steady, still, scratch;
  std::vector<double> chunk_sums;

  // Of the last EvaluateElastic: at position it serves the next step and the report of the frame as well.
  double elastic_energy = 0;  // J
  double elastic_energy_at_start = 0;  // J, of the last EnergyAtStart
  Field elastic_force;        // N, the energy's gradient
  ElasticForceIs elastic_force_is = ElasticForceIs::kOfAnotherState;

  // Scenes that move held particles, or pull: empty in others.
  std::vector<int> driven;
  std::vector<Eigen::Vector3d> driven_at_end;
  Field driven_end;         // per particle, at the end of the frame; meaningful where not free
  double driven_share = 1;  // of the way that is left to driven_end, what the step in progress goes
  Field force;              // N per particle
  double forces = 0;        // N, their norm
};

}  // namespace meshless_cutting
