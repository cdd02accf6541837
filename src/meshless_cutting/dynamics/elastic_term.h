// Strain energy and stabilisation in the potential of a step.
#pragma once

#include "dynamics/elastic_points.h"

namespace meshless_cutting {

/// Every scene has it, so that the potential knows it by name and sums it up together with the inertia.
class ElasticTerm {
 public:
  /// `points` must outlive this.
  explicit ElasticTerm(ElasticPoints& points) : points_(points) {}

  /// Newton's tangent is that of the energy times this: where damping in proportion to stiffness is part of the step.
  void SetTangentFactor(double factor) { factor_ = factor; }
  double tangent_factor() const { return factor_; }

  void TissueChanged() { points_.Resize(tangent_); }
  void Linearise(const Field& y, bool filtered) { points_.Linearise(y, filtered, tangent_); }
  /// Energy, J, and tangent times p without the factor: sums for the particles are left in the slots.
  double EvaluateInSlots(const Field& y) { return points_.EvaluateInSlots(y); }
  SlotSums slot_sums() { return points_.slot_sums(); }
  void ProductInSlots(const SingleField& p) { points_.ProductInSlots(tangent_, p); }
  SingleSlotSums single_slot_sums() { return points_.single_slot_sums(); }
  void AddDiagonal(BlockField& blocks) { points_.AddDiagonal(tangent_, factor_, blocks); }
  void AddCoarse(CoarseMatrix& matrix) { points_.AddCoarse(tangent_, factor_, matrix); }

 private:
  ElasticPoints& points_;
  double factor_ = 1;
  SinglePointTangent tangent_;
};

}  // namespace meshless_cutting
