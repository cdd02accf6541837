#include "dynamics/stiffness_damping_term.h"

#include <algorithm>

namespace meshless_cutting {

void StiffnessDampingTerm::TissueChanged(int particles) {
  points_.Resize(tangent_);
  way_.resize(particles);
  force_.resize(particles);
}

void StiffnessDampingTerm::BeginStep(const StageMotion& motion) {
  rate_ = motion.rate;
  elastic_.SetTangentFactor(1 + beta_ * rate_);
  still_ = motion.still;
  points_.Linearise(*motion.start, true, tangent_);
}

double StiffnessDampingTerm::Evaluate(const Field& y, Field& gradient) {
  const std::size_t count = y.size();
  std::fill(force_.begin(), force_.end(), Vector4());
  for (std::size_t j = 0; j < count; ++j) way_[j] = y[j] - (*still_)[j];
  points_.AddProduct(tangent_, beta_ * rate_, way_, force_);
  double energy = 0;
  for (std::size_t j = 0; j < count; ++j) {
    energy += 0.5 * Dot(way_[j], force_[j]);
    gradient[j] += force_[j];
  }
  return energy;
}

}  // namespace meshless_cutting
