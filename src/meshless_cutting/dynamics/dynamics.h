// Step 4 of the frame: brings the tissue forward in time under elastic, body and contact forces.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Errors of a step are values. Each bit: what happened, what follows from it.
enum StepStatus : std::uint32_t {
  kStepOk = 0,
  kStepNotConverged = 1 << 0,  // residual above the tolerance when the iterations ran out; the state is finite and usable
  kStepRolledBack = 1 << 1,    // a trial state was not usable; the frame was repeated in halves from the last good state
  kStepFrozen = 1 << 2,        // even the halves failed: positions are kept but where strained beyond use, velocities are zero
};

/// What to solve. Absent parts are never built.
struct DynamicsConfig {
  double time_step_s = 1.0 / 60;
  MaterialConfig material;
  SolverConfig solver;
  std::optional<Eigen::Vector3d> gravity_m_s2;  // scene frame
  std::optional<DampingConfig> damping;
  std::vector<ObstacleConfig> obstacles;  // scene frame
  std::vector<MaterialConfig> region_materials = {};  // of Tissue::point_material 1, 2, ...
  double stabilisation = 1;                      // weight of the term against zero-energy modes
};

/// What may change between two steps. A part that was not built stays absent, whatever is said of it.
struct Tuning {
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();  // scene frame
  DampingConfig damping;
  int newton_iterations = 4;  // at most, per step

  bool operator==(const Tuning& other) const {
    return gravity_m_s2 == other.gravity_m_s2 && damping.mass_per_s == other.damping.mass_per_s &&
           damping.stiffness_s == other.damping.stiffness_s && newton_iterations == other.newton_iterations;
  }
  bool operator!=(const Tuning& other) const { return !(*this == other); }
};

struct AdvanceResult {
  std::uint32_t status = kStepOk;
  int newton_iterations = 0;
  int linear_iterations = 0;
  double relative_residual = 0;  // reached by the last Newton iteration
  int contacts = 0;              // skin vertices that touch an obstacle
  double kinetic_j = 0, elastic_j = 0, gravity_j = 0;
};

/// Time integration and the solver behind it. The tissue and the state belong to the caller.
class Dynamics {
 public:
  Dynamics(const DynamicsConfig& config, const Tissue& tissue);
  ~Dynamics();

  /// Call after the tissue changed (a cut); re-indexes, sizes buffers. `beside`: work that does not change the tissue, done
  /// at the same time; does not throw.
  void TissueChanged(const Tissue& tissue, const std::function<void()>& beside = [] {});

  /// From the next step on. The tissue is that of the last TissueChanged().
  void Tune(const Tuning& tuning, const Tissue& tissue);

  /// One time step of config.time_step_s. `skin` are the vertices that touch obstacles; unused without obstacles.
  /// Same input, same bits, whatever config.solver.threads is. Allocates nothing unless the tissue or the skin grew.
  /// An object that sleeps is left alone until the tissue, its state or what acts on it changes.
  AdvanceResult Advance(const Tissue& tissue, const SurfacePoints& skin, TissueState& state);

  /// Fixed particles that the next frames move: where each is at their end, m, scene frame; in between it moves straight. Those that
  /// are not named stay. Holds until it is set again or the tissue changes.
  void SetDriven(const std::vector<int>& particles, const std::vector<Eigen::Vector3d>& at_end);
  /// Dead forces, N, one per particle of the tissue, constant during the next frames; empty: none. Holds as SetDriven.
  void SetForces(const std::vector<Eigen::Vector3d>& forces);
  /// Elastic energy's gradient by particle j at the end of the last frame, N: the force that holds j against the tissue.
  Eigen::Vector3d ElasticForce(int j) const;

  /// How the steps are made, and why so: one line for a log.
  const std::string& solver_summary() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace meshless_cutting
