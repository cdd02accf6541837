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

  // z = B r, zero where particles are not free, in three parts, each together with what else conjugate gradients do to the same
  // particles. The first and the last in parallel, for each chunk of kParticlesPerChunk.

  /// step += alpha direction, residual -= alpha product; the residual is the r of what follows. Returns its weighted square.
  double AdvanceSolution(int chunk, double alpha, const SingleField& direction, const SingleField& product,
                         const std::vector<double>& weight, SingleField& step, SingleField& residual);
  /// Returns r . z.
  double SolveCoarse();
  /// direction = z + beta direction, for a chunk.
  void AdvanceDirection(int chunk, double beta, SingleField& direction) const;

  /// How many iterations the last solve took, per factor 10 that it reduced the residual by.
  void ReportIterations(double per_decade);

 private:
  void BuildCoarse(const Tissue& tissue, const IncrementalPotential& potential);
  void RefreshCoarse(IncrementalPotential& potential);

  /// After a change of the aggregates.
  void PrepareTransfer();

  /// Particles of one aggregate in one chunk: those of the aggregates' list in [begin, end).
  struct Run {
    int chunk, aggregate, begin, end;
  };

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
  std::vector<Run> runs_;       // by chunk
  std::vector<int> run_begin_;  // per chunk, and the end
  SingleField run_sums_;        // CoarseMatrix::kFunctions per run
  SingleField coarse_vector_;   // as many per aggregate
  std::vector<float> coarse_unknowns_;
  std::vector<double> chunk_sums_;
  SingleField scaled_;          // by the diagonal's inverse
};

}  // namespace meshless_cutting
