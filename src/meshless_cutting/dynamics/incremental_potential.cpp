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
  ResizeWithRoom(inertia, particles);
  ResizeWithRoom(free, particles);
  ResizeWithRoom(weight, particles);
  ResizeWithRoom(target, particles);
  if (!terms_.empty()) {
    ResizeWithRoom(wide_, particles);
    ResizeWithRoom(of_terms_, particles);
  }
  chunk_sums_.resize(ChunkCount(particles, kParticlesPerChunk));
  gradient_sums_.resize(chunk_sums_.size());
}

double IncrementalPotential::Evaluate(const Field& y, Field& gradient, Norms& norms) {
  std::fill(gradient.begin(), gradient.end(), Vector4());
  double energy = 0;
  for (ForceTerm* term : terms_) energy += term->Evaluate(y, gradient);
  energy += elastic_.EvaluateInSlots(y);
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    gradient_sums_[c] = GatherGradient(ParticleRange(c, size()), elastic_.slot_sums(), free.data(), inertia.data(),
                                       weight.data(), y.data(), target.data(), gradient.data());
  });
  GradientSums sum;
  for (const GradientSums& s : gradient_sums_) {
    sum.inertia += s.inertia;
    sum.residual += s.residual;
    sum.terms += s.terms;
  }
  norms.residual = std::sqrt(sum.residual);
  norms.terms = std::sqrt(sum.terms);
  return energy + 0.5 * sum.inertia;
}

double IncrementalPotential::Product(const SingleField& p, SingleField& q) {
  elastic_.ProductInSlots(p);
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    chunk_sums_[c] = GatherProduct(ParticleRange(c, size()), elastic_.single_slot_sums(), elastic_.tangent_factor(),
                                   free.data(), inertia.data(), p.data(), q.data());
  });
  if (std::any_of(terms_.begin(), terms_.end(), [](const ForceTerm* term) { return term->HasTangent(); })) {
    std::transform(p.begin(), p.end(), wide_.begin(), Widen);
    std::fill(of_terms_.begin(), of_terms_.end(), Vector4());
    for (ForceTerm* term : terms_) {
      if (term->HasTangent()) term->AddProduct(wide_, of_terms_);
    }
    pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
      chunk_sums_[c] = AddMaskedAndDot(ParticleRange(c, size()), free.data(), of_terms_.data(), p.data(), q.data());
    });
  }
  return SumOf(chunk_sums_);
}

void IncrementalPotential::Diagonal(BlockField& blocks) {
  pool_.ForEach(ChunkCount(size(), kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, size());
    for (int j = range.begin; j < range.end; ++j) {
      blocks[j] = SymmetricBlock();
      blocks[j].xx = blocks[j].yy = blocks[j].zz = inertia[j];
    }
  });
  elastic_.AddDiagonal(blocks);
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
  elastic_.AddCoarse(matrix);
  for (ForceTerm* term : terms_) term->AddCoarse(matrix);
}

}  // namespace meshless_cutting
