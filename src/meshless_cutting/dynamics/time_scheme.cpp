#include "dynamics/time_scheme.h"

namespace meshless_cutting {
namespace {

/// s. Longer than the slowest mode of any tissue, so that inertia is left out but for what keeps a loose piece defined.
constexpr double kStaticStep = 10;

}  // namespace

TimeScheme::TimeScheme(Integrator integrator, double time_step_s, bool is_cautious)
    : elapsed_(time_step_s), dt_(time_step_s) {
  is_static_ = integrator == Integrator::kQuasiStatic;
  if (is_static_) dt_ = kStaticStep;
  if (is_static_ || integrator == Integrator::kImplicitEuler) {
    alpha_m_ = alpha_f_ = predict_ = 0;
    beta_ = gamma_ = 1;
    return;
  }
  constexpr double rho = kSpectralRadius;
  alpha_m_ = (2 * rho - 1) / (rho + 1);
  alpha_f_ = rho / (rho + 1);
  if (is_cautious) {
    alpha_m_ -= alpha_f_;
    alpha_f_ = 0;
  }
  beta_ = 0.25 * (1 - alpha_m_ + alpha_f_) * (1 - alpha_m_ + alpha_f_);
  gamma_ = 0.5 - alpha_m_ + alpha_f_;
  predict_ = 0.5 - beta_;
}

}  // namespace meshless_cutting
