// Which way of stepping a scene gets, and why.
#pragma once

#include <string>

#include "scene/scene.h"

namespace meshless_cutting {

struct SolverChoice {
  Integrator integrator = Integrator::kGeneralizedAlpha;  // never kAuto
  int explicit_steps = 1;                                 // per sub-step, where explicit
  std::string reason;                                     // one line for a log
};

/// What is known of a scene when it is loaded.
struct SolverSituation {
  double cell_m = 0;             // edge of a cell of the background grid
  double p_wave_modulus_pa = 0;  // of the stiffest material
  double density_kg_m3 = 0;      // of the lightest
  double stiffness_damping_s = 0;
  double step_s = 0;         // of a sub-step
  double contact_ratio = 0;  // stiffness of a contact against that of the cell behind it; 0: no obstacles
};

/// Implicit steps cost about the same whatever the stiffness, explicit ones as many evaluations of the forces as the
/// stable step fits into the time step. A choice of the user is kept.
SolverChoice ChooseSolver(const SolverConfig& config, const SolverSituation& situation);

}  // namespace meshless_cutting
