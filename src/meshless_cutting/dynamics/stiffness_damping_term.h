// Rayleigh damping proportional to stiffness: the force -beta K(x_n) v, K the tangent at the start of the step.
#pragma once

#include "dynamics/elastic_points.h"
#include "dynamics/force_term.h"

namespace meshless_cutting {

/// With v = rate (y - still) this is the gradient of beta rate / 2 (y - still)^T K_n (y - still): convex, and it
/// takes energy out whatever the step.
class StiffnessDampingTerm : public ForceTerm {
 public:
  /// `beta` in s. `points` must outlive this.
  StiffnessDampingTerm(double beta, ElasticPoints& points) : beta_(beta), points_(points) {}

  void BeginStep(const StageMotion& motion) override;
  double Evaluate(const Field& y, Field& gradient) override;
  void Linearise(const Field&) override {}
  void AddProduct(const Field& p, Field& q) override { points_.AddProduct(tangent_, beta_ * rate_, p, q); }
  void AddDiagonal(BlockField& blocks) override { points_.AddDiagonal(tangent_, beta_ * rate_, blocks); }
  void AddCoarse(CoarseMatrix& matrix) override { points_.AddCoarse(tangent_, beta_ * rate_, matrix); }

 private:
  double beta_;
  ElasticPoints& points_;
  double rate_ = 0;
  const Field* still_ = nullptr;
  PointTangent tangent_;
  Field way_, force_;
};

}  // namespace meshless_cutting
