#include "dynamics/explicit_steps.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

constexpr double kStableShare = 0.8;

}  // namespace

double StableStep(double cell_m, double p_wave_modulus_pa, double density_kg_m3, double stiffness_damping_s) {
  const double way_time = cell_m / std::sqrt(p_wave_modulus_pa / density_kg_m3);  // 2 / (highest frequency)
  const double z = stiffness_damping_s / way_time;
  return kStableShare * way_time * (std::sqrt(1 + z * z) - z);
}

void ExplicitSteps::Accelerate(const std::vector<double>& mass, const Forces& forces, const Field& x, const Field& v,
                               double step_s, bool is_made, Field& a) {
  const int count = static_cast<int>(x.size());
  std::fill(gradient_.begin(), gradient_.end(), Vector4());
  if (!terms_.empty()) {
    // Contact and friction hold the position: their damping, made for long steps, sees none of this step's motion.
    StageMotion motion;
    motion.rate = 1 / step_s;
    motion.still = &x;
    motion.start = &x;
    motion.step_s = step_s;
    motion.elapsed_s = is_made ? step_s : 0;
    motion.is_made = is_made;
    for (ForceTerm* term : terms_) {
      term->BeginStep(motion);
      term->Evaluate(x, gradient_);
      term->EndStep(x);
    }
  }
  if (forces.stiffness_damping > 0) points_.AddProduct(tangent_, forces.stiffness_damping, v, gradient_);
  points_.Evaluate(x, gradient_);
  potential_.pool().ForEach(ChunkCount(count, kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, count);
    for (int j = range.begin; j < range.end; ++j) {
      if (potential_.free[j] == 0) {
        a[j] = Vector4();
        continue;
      }
      const Vector4 force = forces.dead ? (*forces.dead)[j] - gradient_[j] : -1.0 * gradient_[j];
      a[j] = forces.gravity + (1 / mass[j]) * force - forces.mass_damping * v[j];
    }
  });
}

bool ExplicitSteps::Run(const std::vector<double>& mass, const Forces& forces, double step_s, int steps, Field& x,
                        Field& v, Field& a) {
  const int count = static_cast<int>(x.size());
  gradient_.resize(count);
  if (forces.stiffness_damping > 0) {
    points_.Resize(tangent_);
    points_.Linearise(x, true, tangent_);
  }
  Accelerate(mass, forces, x, v, step_s, false, a);
  for (int step = 0; step < steps; ++step) {
    for (int j = 0; j < count; ++j) {
      if (potential_.free[j] == 0) {
        if (forces.held_end) {
          const Vector4 way = (1.0 / (steps - step)) * ((*forces.held_end)[j] - x[j]);
          x[j] += way;
          v[j] = (1 / step_s) * way;
        }
        continue;
      }
      v[j] += (0.5 * step_s) * a[j];
      x[j] += step_s * v[j];
    }
    Accelerate(mass, forces, x, v, step_s, true, a);
    for (int j = 0; j < count; ++j) {
      if (potential_.free[j] > 0) v[j] += (0.5 * step_s) * a[j];
    }
  }
  Vector4 sum;
  for (int j = 0; j < count; ++j) sum += (x[j] - x[0]) + v[j];
  return std::isfinite(Sum(sum));
}

}  // namespace meshless_cutting
