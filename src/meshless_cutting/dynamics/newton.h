// Newton's method with preconditioned conjugate gradients and a line search on the potential.
#pragma once

#include <cmath>

#include "dynamics/incremental_potential.h"
#include "dynamics/preconditioner.h"

namespace meshless_cutting {

class NewtonSolver {
 public:
  /// `potential` must outlive this.
  NewtonSolver(IncrementalPotential& potential, double relative_tolerance, int iterations)
      : potential_(potential), tolerance_(relative_tolerance), iterations_(iterations) {}

  void TissueChanged(const Tissue& tissue);

  /// Before the first Minimise of a step.
  void BeginStep(const Tissue& tissue) {
    preconditioner_.BeginStep(tissue, potential_);
    if (cautious_steps_ > 0) --cautious_steps_;
  }
  void set_iterations(int iterations) { iterations_ = iterations; }

  /// Differences of energies that mean nothing, J.
  void SetEnergyRounding(double rounding) { energy_rounding_ = rounding; }

  enum class Verdict {
    kConverged,
    kNotConverged,  // iterations ran out; y is better than the start
    kFailed,        // no finite energy at the start, or no way down from where the residual is still large
  };
  struct Result {
    Verdict verdict = Verdict::kFailed;
    int newton_iterations = 0, linear_iterations = 0;
    double relative_residual = 0;
  };

  /// Minimises from y, the place that was taken last. The residual is measured against the forces in the object: the
  /// norm of the terms' gradient plus `load`, N, below which nothing is worth moving. `rounds`: where much is left after the
  /// iterations, so many times as many.
  Result Minimise(Field& y, double load, int rounds);

  /// Of the last evaluation, see Minimise.
  double RelativeResidual(double load) const;

  /// The gradient at the y that Minimise left, N.
  const Field& residual() const { return gradient_; }

  // Before Minimise: Begin, then Offer the places where it may begin. It begins at the last that was taken.
  void Begin();
  /// Evaluates y, and takes it if its energy is finite and lower than that of those before.
  bool Offer(const Field& y);
  /// Of the place taken, J.
  double energy() const { return energy_; }
  /// Whether the place taken is so good that nothing need be done. Stricter than Minimise: otherwise a body would hang
  /// off its balance by the tolerance for ever.
  bool StartIsConverged(double load) const {
    return std::isfinite(energy_) && RelativeResidual(load) <= kAtStart * tolerance_;
  }

 private:
  static constexpr double kAtStart = 0.1;

  /// The Newton step at y in units of the residual, m/N, with the true tangent where that proves definite. Returns the
  /// linear iterations.
  int SolveLinear(const Field& y, double relative_residual);
  /// is_definite: false if a direction of negative curvature ended the iterations.
  int ConjugateGradients(double relative_tolerance, bool& is_definite);
  /// Sum of what `task` returns for each range of particles, in parallel.
  template <class Task>
  double SumOver(const Task& task);

  IncrementalPotential& potential_;
  double tolerance_;
  int iterations_;
  Preconditioner preconditioner_;
  Field gradient_, trial_, trial_gradient_;
  SingleField step_, residual_, direction_, product_;
  std::vector<double> chunk_sums_;
  IncrementalPotential::Norms norms_;
  double energy_ = 0, energy_rounding_ = 0;
  int cautious_steps_ = 0;  // in which the true tangent is tried near the solution alone
};

}  // namespace meshless_cutting
