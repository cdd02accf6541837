#include "dynamics/stiffness_damping_term.h"

#include "dynamics/field_loops.h"

namespace meshless_cutting {

void StiffnessDampingTerm::TissueChanged(int particles) {
  points_.Resize(tangent_);
  way_.resize(particles);
  chunk_energy_.resize(ChunkCount(particles, kParticlesPerChunk));
}

void StiffnessDampingTerm::BeginStep(const StageMotion& motion) {
  rate_ = motion.rate;
  elastic_.SetTangentFactor(1 + beta_ * rate_);
  still_ = motion.still;
  points_.Linearise(*motion.start, true, tangent_);
}

double StiffnessDampingTerm::Evaluate(const Field& y, Field& gradient) {
  const int count = static_cast<int>(y.size());
  ThreadPool& pool = points_.pool();
  pool.ForEach(static_cast<int>(chunk_energy_.size()), [&](int c) {
    const ParticleRange range(c, count);
    for (int j = range.begin; j < range.end; ++j) way_[j] = y[j] - (*still_)[j];
  });
  points_.ProductInSlots(tangent_, way_);
  const SlotSums sums = points_.slot_sums();
  pool.ForEach(static_cast<int>(chunk_energy_.size()), [&](int c) {
    const ParticleRange range(c, count);
    Vector4 force[kParticlesPerChunk];
    GatherSlots(range, sums, beta_ * rate_, force);
    chunk_energy_[c] = 0;
    for (int j = range.begin; j < range.end; ++j) {
      chunk_energy_[c] += 0.5 * Dot(way_[j], force[j - range.begin]);
      gradient[j] += force[j - range.begin];
    }
  });
  double energy = 0;
  for (double e : chunk_energy_) energy += e;
  return energy;
}

}  // namespace meshless_cutting
