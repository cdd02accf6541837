#include "dynamics/incremental_potential.h"

#include <algorithm>
#include <cmath>

#include "dynamics/field_loops.h"

namespace meshless_cutting {
namespace {

double SumOf(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum;
}

}  // namespace

void IncrementalPotential::Resize(int particles) {
  inertia.resize(particles);
  free.resize(particles);
  target.resize(particles);
  for (std::vector<double>& sums : chunk_sums_) sums.resize(ChunkCount(particles, kParticlesPerChunk));
}

double IncrementalPotential::Evaluate(const Field& y, Field& gradient, Norms& norms) {
  std::fill(gradient.begin(), gradient.end(), Vector4());
  double energy = 0;
  for (ForceTerm* term : terms_) energy += term->Evaluate(y, gradient);
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    double sums[3] = {};
    const int end = std::min(size(), (c + 1) * kParticlesPerChunk);
    for (int j = c * kParticlesPerChunk; j < end; ++j) {
      const Vector4 way = y[j] - target[j];
      const Vector4 term = free[j] * gradient[j];
      const Vector4 total = term + (free[j] * inertia[j]) * way;
      gradient[j] = total;
      sums[0] += free[j] * inertia[j] * Dot(way, way);
      sums[1] += Dot(total, total);
      sums[2] += Dot(term, term);
    }
    for (int i = 0; i < 3; ++i) chunk_sums_[i][c] = sums[i];
  });
  norms.residual = std::sqrt(SumOf(chunk_sums_[1]));
  norms.terms = std::sqrt(SumOf(chunk_sums_[2]));
  return energy + 0.5 * SumOf(chunk_sums_[0]);
}

void IncrementalPotential::Linearise(const Field& y) {
  for (ForceTerm* term : terms_) term->Linearise(y);
}

double IncrementalPotential::Product(const Field& p, Field& q) {
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    Scale(ParticleRange(c, size()), inertia.data(), p.data(), q.data());
  });
  for (ForceTerm* term : terms_) term->AddProduct(p, q);
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    chunk_sums_[0][c] = MaskAndDot(ParticleRange(c, size()), free.data(), p.data(), q.data());
  });
  return SumOf(chunk_sums_[0]);
}

void IncrementalPotential::Diagonal(BlockField& blocks) {
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, size());
    for (int j = range.begin; j < range.end; ++j) {
      blocks[j] = SymmetricBlock();
      blocks[j].xx = blocks[j].yy = blocks[j].zz = inertia[j];
    }
  });
  for (ForceTerm* term : terms_) term->AddDiagonal(blocks);
}

void IncrementalPotential::Coarse(CoarseMatrix& matrix) {
  matrix.Clear();
  const Aggregates& aggregates = matrix.aggregates();
  for (int a = 0; a < aggregates.count(); ++a) {
    double mass[CoarseMatrix::kFunctions][CoarseMatrix::kFunctions] = {};
    for (int i = aggregates.begin[a]; i < aggregates.begin[a + 1]; ++i) {
      const int j = aggregates.particles[i];
      const double* b = &aggregates.basis[j].x;
      for (int c = 0; c < CoarseMatrix::kFunctions; ++c) {
        for (int d = 0; d < CoarseMatrix::kFunctions; ++d) mass[c][d] += inertia[j] * b[c] * b[d];
      }
    }
    for (int c = 0; c < CoarseMatrix::kFunctions; ++c) {
      for (int d = 0; d < CoarseMatrix::kFunctions; ++d) {
        const double block[9] = {mass[c][d], 0, 0, 0, mass[c][d], 0, 0, 0, mass[c][d]};
        matrix.Add(a, c, a, d, block);
      }
    }
  }
  for (ForceTerm* term : terms_) term->AddCoarse(matrix);
}

}  // namespace meshless_cutting
