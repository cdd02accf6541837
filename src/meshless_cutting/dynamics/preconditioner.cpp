#include "dynamics/preconditioner.h"

#include <algorithm>

#include "dynamics/field_loops.h"

namespace meshless_cutting {
namespace {

/// The coarse space has at most so many aggregates, and at least so many particles in each.
constexpr int kAggregates = 40;
constexpr int kParticlesPerAggregate = 24;

/// The coarse matrix is made again when a solve takes so many times the iterations that it took when the matrix was new.
constexpr double kAgeing = 1.5;

SymmetricBlock Inverse(const SymmetricBlock& b) {
  SymmetricBlock inverse;
  const double cxx = b.yy * b.zz - b.yz * b.yz, cxy = b.xz * b.yz - b.xy * b.zz, cxz = b.xy * b.yz - b.xz * b.yy;
  const double det = b.xx * cxx + b.xy * cxy + b.xz * cxz;
  if (!(det > 1e-12 * b.xx * b.yy * b.zz)) {  // rounding has eaten a direction: the diagonal alone still scales
    inverse.xx = 1 / b.xx;
    inverse.yy = 1 / b.yy;
    inverse.zz = 1 / b.zz;
    return inverse;
  }
  inverse.xx = cxx / det;
  inverse.xy = cxy / det;
  inverse.xz = cxz / det;
  inverse.yy = (b.xx * b.zz - b.xz * b.xz) / det;
  inverse.yz = (b.xy * b.xz - b.xx * b.yz) / det;
  inverse.zz = (b.xx * b.yy - b.xy * b.xy) / det;
  return inverse;
}

}  // namespace

void Preconditioner::TissueChanged(const Tissue& tissue, const IncrementalPotential& potential) {
  const int particles = tissue.particle_count();
  inverse_.resize(particles);
  chunk_sums_.resize(ChunkCount(particles, kParticlesPerChunk));
  coarse_.TissueChanged(tissue, potential.free, std::min(kAggregates, particles / kParticlesPerAggregate));
  coarse_vector_.resize(coarse_.size());
  coarse_is_stale_ = true;
}

void Preconditioner::RefreshCoarse(IncrementalPotential& potential) {
  potential.Coarse(coarse_);
  coarse_.Factor();
  coarse_is_stale_ = false;
  coarse_is_new_ = true;
}

void Preconditioner::ReportIterations(double per_decade) {
  if (coarse_is_new_) {
    iterations_when_new_ = per_decade;
    coarse_is_new_ = false;
  } else if (per_decade > kAgeing * iterations_when_new_ + 1) {
    coarse_is_stale_ = true;
  }
}

void Preconditioner::Refresh(IncrementalPotential& potential) {
  if (coarse_is_stale_) RefreshCoarse(potential);
  potential.Diagonal(inverse_);
  potential.pool().ForEach(ChunkCount(potential.size(), kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, potential.size());
    for (int j = range.begin; j < range.end; ++j) {
      inverse_[j] = potential.free[j] > 0 ? Inverse(inverse_[j]) : SymmetricBlock();
    }
  });
}

double Preconditioner::Apply(const Field& r, Field& z, ThreadPool& pool) {
  const Aggregates& aggregates = coarse_.aggregates();
  pool.ForEach(aggregates.count(), [&](int a) {
    Restrict(&aggregates.particles[aggregates.begin[a]], aggregates.begin[a + 1] - aggregates.begin[a],
             aggregates.basis.data(), r.data(), &coarse_vector_[CoarseMatrix::kUnknowns * a]);
  });
  coarse_.Solve(coarse_vector_.data());
  const int count = static_cast<int>(r.size());
  pool.ForEach(ChunkCount(count, kParticlesPerChunk), [&](int c) {
    chunk_sums_[c] = ScaleAndProlong(ParticleRange(c, count), inverse_.data(), aggregates.of_particle.data(),
                                     aggregates.basis.data(), coarse_vector_.data(), r.data(), z.data());
  });
  double sum = 0;
  for (double s : chunk_sums_) sum += s;
  return sum;
}

}  // namespace meshless_cutting
