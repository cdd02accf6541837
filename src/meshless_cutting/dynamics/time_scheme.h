// Implicit one-step schemes as a minimisation: the unknown is the stage y, where forces are balanced.
#pragma once

#include "scene/scene.h"

namespace meshless_cutting {

/// Positions x, velocities v and accelerations a of the end of a step follow from
///   x1 = x~ + beta dt^2 a1,  x~ = x0 + dt v0 + predict dt^2 a0,   v1 = v0 + dt ((1 - gamma) a0 + gamma a1),
/// and the balance M ((1 - alpha_m) a1 + alpha_m a0) = f(y) at the stage y = (1 - alpha_f) x1 + alpha_f x0.
/// Chung and Hulbert 1993 (generalised-alpha): second order, spectral radius rho at infinite frequency. Since f is
/// taken at y, not averaged, y minimises inertia() / 2 |y - target|_M^2 + Phi(y), f = -Phi', for conservative forces:
/// what a line search needs. Integrator::kQuasiStatic is implicit Euler from rest with a step so long that inertia does
/// not matter: each frame ends in balance.
class TimeScheme {
 public:
  /// is_cautious: the stage is the end of the step (alpha_f = 0; Wood, Bossak and Zienkiewicz 1980): the same order and
  /// dissipation, a little longer periods, and no end of a step beyond the state that was solved for.
  TimeScheme(Integrator integrator, double time_step_s, bool is_cautious = false);

  /// rho for Integrator::kGeneralizedAlpha.
  static constexpr double kSpectralRadius = 0.8;

  double inertia() const { return (1 - alpha_m_) / (beta_ * dt_ * dt_ * (1 - alpha_f_)); }  // 1/s^2
  double rate() const { return gamma_ / (beta_ * dt_); }  // 1/s: velocity at the stage = rate (y - Still)
  double time_step_s() const { return dt_; }
  double elapsed_s() const { return elapsed_; }  // time that passes: of a static step what was asked for
  double stage() const { return 1 - alpha_f_; }  // the stage's place in the step
  bool is_static() const { return is_static_; }  // velocities mean nothing

  // One particle, any vector type. Start of the step: x0, v0, a0.
  template <class V>
  V Predicted(const V& x0, const V& v0, const V& a0) const {
    return x0 + dt_ * v0 + (predict_ * dt_ * dt_) * a0;
  }
  /// The y that needs no force.
  template <class V>
  V Target(const V& x0, const V& v0, const V& a0) const {
    const V x1 = Predicted(x0, v0, a0) - (beta_ * dt_ * dt_ * alpha_m_ / (1 - alpha_m_)) * a0;
    return x0 + (1 - alpha_f_) * (x1 - x0);
  }
  /// The y at which the stage's velocity vanishes.
  template <class V>
  V Still(const V& x0, const V& v0, const V& a0) const {
    return x0 + (1 - alpha_f_) * (Predicted(x0, v0, a0) - x0) -
           (1 / rate()) * (v0 + ((1 - alpha_f_) * dt_ * (1 - gamma_)) * a0);
  }
  /// Where y is if the acceleration stays what it was.
  template <class V>
  V Steady(const V& x0, const V& v0, const V& a0) const {
    return x0 + (1 - alpha_f_) * (dt_ * v0 + ((predict_ + beta_) * dt_ * dt_) * a0);
  }
  /// x, v, a (in: start; out: end of the step) for the stage y.
  template <class V>
  void Finish(const V& y, V& x, V& v, V& a) const {
    const V predicted = Predicted(x, v, a);
    const V x1 = x + (1 / (1 - alpha_f_)) * (y - x);
    const V a1 = (1 / (beta_ * dt_ * dt_)) * (x1 - predicted);
    v = v + (dt_ * (1 - gamma_)) * a + (dt_ * gamma_) * a1;
    x = x1;
    a = a1;
  }

 private:
  double elapsed_, dt_, alpha_m_, alpha_f_, beta_, gamma_, predict_;
  bool is_static_ = false;
};

}  // namespace meshless_cutting
