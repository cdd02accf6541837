// Strain energy and stabilisation.
#pragma once

#include "dynamics/elastic_points.h"
#include "dynamics/force_term.h"

namespace meshless_cutting {

class ElasticTerm : public ForceTerm {
 public:
  /// `points` must outlive this.
  explicit ElasticTerm(ElasticPoints& points) : points_(points) {}

  double Evaluate(const Field& y, Field& gradient) override { return points_.Evaluate(y, gradient); }
  void Linearise(const Field& y) override { points_.Linearise(y, tangent_); }
  void AddProduct(const Field& p, Field& q) override { points_.AddProduct(tangent_, 1, p, q); }
  void AddDiagonal(BlockField& blocks) override { points_.AddDiagonal(tangent_, 1, blocks); }
  void AddCoarse(CoarseMatrix& matrix) override { points_.AddCoarse(tangent_, 1, matrix); }

 private:
  ElasticPoints& points_;
  PointTangent tangent_;
};

}  // namespace meshless_cutting
