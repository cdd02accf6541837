// Strain energy and stabilisation.
#pragma once

#include "dynamics/elastic_points.h"
#include "dynamics/force_term.h"

namespace meshless_cutting {

class ElasticTerm : public ForceTerm {
 public:
  /// `points` must outlive this.
  explicit ElasticTerm(ElasticPoints& points) : points_(points) {}

  /// Newton's tangent is that of the energy times this: where damping in proportion to stiffness is part of the step.
  void SetTangentFactor(double factor) { factor_ = factor; }

  void TissueChanged(int) override { points_.Resize(tangent_); }
  double Evaluate(const Field& y, Field& gradient) override { return points_.Evaluate(y, gradient); }
  void Linearise(const Field& y) override { points_.Linearise(y, tangent_); }
  void AddProduct(const Field& p, Field& q) override { points_.AddProduct(tangent_, factor_, p, q); }
  void AddDiagonal(BlockField& blocks) override { points_.AddDiagonal(tangent_, factor_, blocks); }
  void AddCoarse(CoarseMatrix& matrix) override { points_.AddCoarse(tangent_, factor_, matrix); }

 private:
  ElasticPoints& points_;
  double factor_ = 1;
  PointTangent tangent_;
};

}  // namespace meshless_cutting
