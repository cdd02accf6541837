// Rayleigh damping proportional to stiffness: the force -beta K(x_n) v, K the tangent at the start of the step.
#pragma once

#include "dynamics/elastic_term.h"

namespace meshless_cutting {

/// With v = rate (y - still) this is the gradient of beta rate / 2 (y - still)^T K_n (y - still): convex, and it
/// takes energy out whatever the step.
///
/// Newton's tangent of it would be beta rate K_n. K hardly changes within a step, so that the elastic term's tangent is scaled up instead:
/// half the work per product, and the line search sees the true potential.
class StiffnessDampingTerm : public ForceTerm {
 public:
  /// `beta` in s. `points` and `elastic` must outlive this.
  StiffnessDampingTerm(double beta, ElasticPoints& points, ElasticTerm& elastic)
      : beta_(beta), points_(points), elastic_(elastic) {}

  /// From the next step on.
  void set_beta(double beta) { beta_ = beta; }

  void TissueChanged(int particles) override;
  void BeginStep(const StageMotion& motion) override;
  double Evaluate(const Field& y, Field& gradient) override;
  void Linearise(const Field&) override {}
  bool HasTangent() const override { return false; }
  void AddProduct(const Field&, Field&) override {}
  void AddDiagonal(BlockField&) override {}
  void AddCoarse(CoarseMatrix&) override {}

 private:
  double beta_;
  ElasticPoints& points_;
  ElasticTerm& elastic_;
  double rate_ = 0;
  const Field* still_ = nullptr;
  PointTangent tangent_;
  Field way_;
  std::vector<double> chunk_energy_;
};

}  // namespace meshless_cutting
