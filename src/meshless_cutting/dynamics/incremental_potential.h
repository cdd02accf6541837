// The function whose minimum is the next step: inertia, and a list of force terms.
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/elastic_term.h"
#include "dynamics/force_term.h"
#include "dynamics/thread_pool.h"

namespace meshless_cutting {

/// E(y) = sum_j inertia_j / 2 |y_j - target_j|^2 + elastic energy + sum of terms. Particles that are not free stay
/// where they are: their rows of gradients and products are zero.
class IncrementalPotential {
 public:
  /// All must outlive this. `terms`: what a scene has besides elasticity.
  IncrementalPotential(ElasticTerm& elastic, const std::vector<ForceTerm*>& terms, ThreadPool& pool)
      : elastic_(elastic), terms_(terms), pool_(pool) {}

  void Resize(int particles);

  std::vector<double> inertia;  // kg/s^2 per particle
  std::vector<double> free;     // 1: moves, 0: does not
  std::vector<double> weight;   // in the squares of residuals: a small piece of the object counts as much as a large one
  Field target;                 // m

  /// Weighted norms of the gradient and of the forces' share in it (all but inertia), over the free particles; N.
  struct Norms {
    double residual = 0, terms = 0;
  };

  /// E(y), J; gradient, N. Infinite where a term is.
  double Evaluate(const Field& y, Field& gradient, Norms& norms);

  /// Fix the tangent H at y. That of the elastic term is positive definite on the free particles if `filtered`, or else
  /// the true one, which may have negative curvature.
  void LineariseTerms(const Field& y) {
    for (ForceTerm* term : terms_) term->Linearise(y);
  }
  void LineariseElastic(const Field& y, bool filtered) { elastic_.Linearise(y, filtered); }

  /// q = H p for p that is zero where not free; returns p . q. In single precision, but for the terms besides
  /// elasticity.
  double Product(const SingleField& p, SingleField& q);

  /// The 3 x 3 blocks on the diagonal of H.
  void Diagonal(BlockField& blocks);

  /// Z^T H Z for the coarse space of `matrix`, replacing what it held.
  void Coarse(CoarseMatrix& matrix);

  int size() const { return static_cast<int>(target.size()); }
  ThreadPool& pool() { return pool_; }

 private:
  ElasticTerm& elastic_;
  const std::vector<ForceTerm*>& terms_;
  ThreadPool& pool_;
  std::vector<double> chunk_sums_;
  std::vector<GradientSums> gradient_sums_;
  Field wide_, of_terms_;  // p and the terms' q in Product
};

}  // namespace meshless_cutting
