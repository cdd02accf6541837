#include "dynamics/solver_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dynamics/explicit_steps.h"

namespace meshless_cutting {
namespace {

/// What a generalised-alpha step costs, in evaluations of the forces: 35, 87 and 152 for 1k, 3k and 10k points of a
/// swinging object, StepInEvaluations of dynamics_benchmark; the last, for where the choice matters. Damped and slow
/// objects take less.
constexpr double kImplicitCost = 150;

/// What an explicit step costs with its sums over particles, what a product with the tangent adds, and the search for
/// contacts.
constexpr double kStepCost = 1.3, kProductCost = 0.8, kContactCost = 0.7;

/// More steps than this for one frame have no use.
constexpr int kMostSteps = 100000;

}  // namespace

SolverChoice ChooseSolver(const SolverConfig& config, const SolverSituation& s) {
  SolverChoice choice;
  const double stable =
      StableStep(s.cell_m, s.p_wave_modulus_pa * (1 + 2 * s.contact_ratio), s.density_kg_m3, s.stiffness_damping_s);
  choice.explicit_steps = static_cast<int>(std::clamp(std::ceil(s.step_s / stable), 1.0, 1.0 * kMostSteps));
  const double per_step =
      kStepCost + (s.stiffness_damping_s > 0 ? kProductCost : 0) + (s.contact_ratio > 0 ? kContactCost : 0);
  const double cost = per_step * choice.explicit_steps;
  const bool explicit_wins = cost < kImplicitCost;
  const bool is_auto = config.integrator == Integrator::kAuto;
  choice.integrator = !is_auto        ? config.integrator
                      : explicit_wins ? Integrator::kExplicit
                                      : Integrator::kGeneralizedAlpha;
  const char* name = choice.integrator == Integrator::kExplicit        ? "explicit"
                     : choice.integrator == Integrator::kImplicitEuler ? "implicit_euler"
                     : choice.integrator == Integrator::kQuasiStatic   ? "quasi_static"
                                                                       : "generalized_alpha";
  char text[320];
  if (is_auto) {
    std::snprintf(
        text, sizeof(text),
        "%s, chosen: %d explicit steps of at most %.3g ms (0.8 h / c_p, h %.3g mm, c_p %.3g m/s%s) cost about %.0f "
        "evaluations of the forces, an implicit step about %.0f",
        name, choice.explicit_steps, 1e3 * stable, 1e3 * s.cell_m, std::sqrt(s.p_wave_modulus_pa / s.density_kg_m3),
        s.contact_ratio > 0 || s.stiffness_damping_s > 0 ? ", less for contact and damping" : "", cost, kImplicitCost);
  } else if (choice.integrator == Integrator::kExplicit) {
    std::snprintf(text, sizeof(text), "%s, as the scene says: %d steps of at most %.3g ms", name, choice.explicit_steps,
                  1e3 * stable);
  } else {
    std::snprintf(text, sizeof(text), "%s, as the scene says or by default", name);
  }
  choice.reason = text;
  return choice;
}

}  // namespace meshless_cutting
