// Strain energy, stabilisation and damping in proportion to stiffness in the potential of a step.
#pragma once

#include "dynamics/elastic_points.h"

namespace meshless_cutting {

/// Every scene has it, so that the potential knows it by name and sums it up together with the inertia.
///
/// Rayleigh damping proportional to stiffness is the force -beta K(x_n) v, K the tangent at the start of the step. With
/// v = rate (y - still) it is the gradient of beta rate / 2 (y - still)^T K_n (y - still): convex, and it takes energy out
/// whatever the step. Newton's tangent of it would be beta rate K_n; K hardly changes within a step, so that the elastic
/// tangent is scaled up instead: half the work per product, and the line search sees the true potential.
class ElasticTerm {
 public:
  /// `points` must outlive this.
  explicit ElasticTerm(ElasticPoints& points) : points_(points) {}

  /// Damping from the next step on, s; 0: none.
  void SetDamping(double beta) {
    beta_ = beta;
    if (beta_ > 0) points_.Resize(start_tangent_);
  }

  void TissueChanged() {
    points_.Resize(tangent_);
    if (beta_ > 0) points_.Resize(start_tangent_);
  }
  void BeginStep(const StageMotion& motion) {
    damping_ = {&start_tangent_, motion.still, beta_ * motion.rate};
    if (damping_.damping > 0) points_.Linearise(*motion.start, true, start_tangent_);
  }

  /// What is left in the slots times this is the product with the tangent.
  double tangent_factor() const { return 1 + damping_.damping; }

  void Linearise(const Field& y, bool filtered) { points_.Linearise(y, filtered, tangent_); }
  /// Energy, J, and tangent times p without the factor: sums for the particles are left in the slots.
  double EvaluateInSlots(const Field& y) {
    return damping_.damping > 0 ? points_.EvaluateInSlots(y, damping_) : points_.EvaluateInSlots(y);
  }
  SlotSums slot_sums() { return points_.slot_sums(); }
  void ProductInSlots(const SingleField& p) { points_.ProductInSlots(tangent_, p); }
  SingleSlotSums single_slot_sums() { return points_.single_slot_sums(); }
  void AddDiagonal(BlockField& blocks) { points_.AddDiagonal(tangent_, tangent_factor(), blocks); }
  void AddCoarse(CoarseMatrix& matrix) { points_.AddCoarse(tangent_, tangent_factor(), matrix); }

 private:
  ElasticPoints& points_;
  SinglePointTangent tangent_;
  double beta_ = 0;             // s
  PointTangent start_tangent_;  // at the start of the step, of a scene with damping
  PointDamping damping_;
};

}  // namespace meshless_cutting
