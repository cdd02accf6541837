// An approximate inverse of the tangent: the 3 x 3 blocks of its diagonal, plus a coarse correction (additive two-level
// method).
#pragma once

#include "dynamics/coarse_matrix.h"
#include "dynamics/field_loops.h"
#include "dynamics/incremental_potential.h"

namespace meshless_cutting {

/// B = D^-1 + Z A^-1 Z^T with A = Z^T H Z for an H that may be some steps old, and a Z that may be some cuts old: B
/// stays symmetric positive definite whatever A and Z were made of. Both are made again when the iterations show that
/// they have aged, but not in every frame of a cut; and some time after the last cut in any case, so that each fragment
/// gets the rigid motions of its own. What decides is counts of iterations, the same on any machine.
class Preconditioner {
 public:
  void TissueChanged(const Tissue& tissue, const IncrementalPotential& potential);

  /// Before the solves of a step: new aggregates if it is time for them.
  void BeginStep(const Tissue& tissue, const IncrementalPotential& potential);

  /// Whether the next solve needs Refresh: after some solves, and when the particles or the aggregates are new.
  bool IsDue() const { return is_due_; }

  /// Takes the tangent that `potential` was linearised at last.
  void Refresh(IncrementalPotential& potential);

  /// z = B r, with z zero where particles are not free; returns r . z.
  double Apply(const SingleField& r, SingleField& z, ThreadPool& pool);

  /// How many iterations the last solve took, per factor 10 that it reduced the residual by.
  void ReportIterations(double per_decade);

 private:
  void BuildCoarse(const Tissue& tissue, const IncrementalPotential& potential);
  void RefreshCoarse(IncrementalPotential& potential);

  void RoundBasis();

  BlockField diagonal_;
  AlignedVector<SingleBlock> inverse_;
  SingleField basis_;  // that of the aggregates
  CoarseMatrix coarse_;
  bool is_due_ = true;
  int solves_since_refresh_ = 0;
  bool coarse_is_stale_ = true, coarse_is_new_ = false;
  bool tissue_changed_ = false;  // since the aggregates were made
  int solves_ = 0;               // since the coarse matrix was made
  double iterations_when_new_ = 0;
  SingleField coarse_vector_;  // CoarseMatrix::kFunctions per aggregate
  std::vector<float> coarse_unknowns_;
  std::vector<double> chunk_sums_;
};

}  // namespace meshless_cutting
