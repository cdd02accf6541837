// Central differences: many small steps without a solver, for soft or coarse objects.
#pragma once

#include <vector>

#include "dynamics/elastic_term.h"
#include "dynamics/incremental_potential.h"

namespace meshless_cutting {

/// How long a step may be, s: 0.8 h / c_p (h edge of a cell, c_p speed of pressure waves; measured limit 0.86 to 0.98
/// of h / c_p), less with damping in proportion to stiffness: sqrt(1 + z^2) - z of that, z = stiffness_s c_p / h.
double StableStep(double cell_m, double p_wave_modulus_pa, double density_kg_m3, double stiffness_damping_s);

/// Velocity Verlet: v += dt/2 a, x += dt v, a = f(x) / m, v += dt/2 a. Forces that depend on the velocity see that of
/// the middle of the step. Second order; conserves momentum to rounding.
class ExplicitSteps {
 public:
  /// All must outlive this.
  ExplicitSteps(ElasticPoints& points, const std::vector<ForceTerm*>& terms, IncrementalPotential& potential)
      : points_(points), terms_(terms), potential_(potential) {}

  struct Forces {
    Vector4 gravity;                  // m/s^2
    double mass_damping = 0;          // 1/s
    double stiffness_damping = 0;     // s, with the tangent at the start of Run
    const Field* dead = nullptr;      // N per particle, or none
    const Field* held_end = nullptr;  // m, where particles that are not free are at the end of Run, or none: they stay
  };

  /// `steps` steps of `step_s` from x, v, in place; a: acceleration at the end. False: not finite, x, v, a are then of
  /// no use.
  bool Run(const std::vector<double>& mass, const Forces& forces, double step_s, int steps, Field& x, Field& v,
           Field& a);

 private:
  void Accelerate(const std::vector<double>& mass, const Forces& forces, const Field& x, const Field& v, double step_s,
                  bool is_made, Field& a);

  ElasticPoints& points_;
  const std::vector<ForceTerm*>& terms_;
  IncrementalPotential& potential_;
  PointTangent tangent_;
  Field gradient_, still_;
};

}  // namespace meshless_cutting
