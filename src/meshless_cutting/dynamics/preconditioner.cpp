#include "dynamics/preconditioner.h"

#include <algorithm>

namespace meshless_cutting {
namespace {

/// The coarse space has at most so many aggregates, and at least so many particles in each.
constexpr int kAggregates = 40;
constexpr int kParticlesPerAggregate = 24;

/// The coarse matrix is made again when a solve takes so many times the iterations that it took when the matrix was new.
constexpr double kAgeing = 1.5;

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
  for (int j = 0; j < potential.size(); ++j) {
    if (potential.free[j] == 0) {
      inverse_[j] = SymmetricBlock();
      continue;
    }
    const SymmetricBlock b = inverse_[j];
    const double cxx = b.yy * b.zz - b.yz * b.yz, cxy = b.xz * b.yz - b.xy * b.zz, cxz = b.xy * b.yz - b.xz * b.yy;
    const double det = b.xx * cxx + b.xy * cxy + b.xz * cxz;
    SymmetricBlock& inverse = inverse_[j];
    if (!(det > 1e-12 * b.xx * b.yy * b.zz)) {  // rounding has eaten a direction: its diagonal alone still scales
      inverse = SymmetricBlock();
      inverse.xx = 1 / b.xx;
      inverse.yy = 1 / b.yy;
      inverse.zz = 1 / b.zz;
      continue;
    }
    inverse.xx = cxx / det;
    inverse.xy = cxy / det;
    inverse.xz = cxz / det;
    inverse.yy = (b.xx * b.zz - b.xz * b.xz) / det;
    inverse.yz = (b.xy * b.xz - b.xx * b.yz) / det;
    inverse.zz = (b.xx * b.yy - b.xy * b.xy) / det;
  }
}

double Preconditioner::Apply(const Field& r, Field& z, ThreadPool& pool) {
  const Aggregates& aggregates = coarse_.aggregates();
  pool.ForEach(aggregates.count(), [&](int a) {
    Vector4 sums[CoarseMatrix::kFunctions];
    for (int i = aggregates.begin[a]; i < aggregates.begin[a + 1]; ++i) {
      const int j = aggregates.particles[i];
      const double* b = &aggregates.basis[j].x;
      for (int c = 0; c < CoarseMatrix::kFunctions; ++c) sums[c] += b[c] * r[j];
    }
    double* to = &coarse_vector_[CoarseMatrix::kUnknowns * a];
    for (int c = 0; c < CoarseMatrix::kFunctions; ++c) {
      to[3 * c] = sums[c].x;
      to[3 * c + 1] = sums[c].y;
      to[3 * c + 2] = sums[c].z;
    }
  });
  coarse_.Solve(coarse_vector_.data());
  const int count = static_cast<int>(r.size());
  pool.ForEach(ChunkCount(count, kParticlesPerChunk), [&](int chunk) {
    double sum = 0;
    const int end = std::min(count, (chunk + 1) * kParticlesPerChunk);
    for (int j = chunk * kParticlesPerChunk; j < end; ++j) {
      const int a = aggregates.of_particle[j];
      if (a < 0) {
        z[j] = Vector4();
        continue;
      }
      const SymmetricBlock& b = inverse_[j];
      Vector4 local{b.xx * r[j].x + b.xy * r[j].y + b.xz * r[j].z, b.xy * r[j].x + b.yy * r[j].y + b.yz * r[j].z,
                    b.xz * r[j].x + b.yz * r[j].y + b.zz * r[j].z, 0};
      const double* basis = &aggregates.basis[j].x;
      const double* u = &coarse_vector_[CoarseMatrix::kUnknowns * a];
      for (int c = 0; c < CoarseMatrix::kFunctions; ++c) {
        local += basis[c] * Vector4{u[3 * c], u[3 * c + 1], u[3 * c + 2], 0};
      }
      z[j] = local;
      sum += Dot(r[j], local);
    }
    chunk_sums_[chunk] = sum;
  });
  double sum = 0;
  for (double s : chunk_sums_) sum += s;
  return sum;
}

}  // namespace meshless_cutting
