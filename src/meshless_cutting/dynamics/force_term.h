// What adds to the incremental potential of a step. The list of terms is made once; a scene pays for those that it has.
#pragma once

#include "dynamics/coarse_matrix.h"
#include "dynamics/field.h"

namespace meshless_cutting {

/// A symmetric 3 x 3 block per particle, N/m.
struct SymmetricBlock {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};
using BlockField = AlignedVector<SymmetricBlock>;

/// How the velocity that damping and friction see follows from the unknown y of a step: v = rate (y - still).
struct StageMotion {
  double rate = 0;                // 1/s
  const Field* still = nullptr;   // m, where y would be if the velocity were zero
  const Field* start = nullptr;   // m, positions at the start of the step
  double reach = 0;               // m, no particle is expected to move farther
  double stage = 1;               // y = start + stage (end of the step - start)
  double step_s = 0;              // time step
  double elapsed_s = 0;           // time that passes in it, for what remembers
  // Explicit steps ask for forces at the end of a step: `start` is there already, what remembers begins where its last step ended.
  bool is_made = false;
};

/// A term Phi(y) of the potential whose minimum over the stage positions y is the step. Loops over particles or points are
/// inside these calls; the calls are virtual.
class ForceTerm {
 public:
  virtual ~ForceTerm() = default;

  /// After the tissue changed: sizes buffers.
  virtual void TissueChanged(int /*particles*/) {}

  /// Once before a step is solved: takes the quantities that the step holds constant.
  virtual void BeginStep(const StageMotion&) {}

  /// Phi(y), J; adds dPhi/dy, N, to `gradient`. May be infinite, never NaN by a finite y.
  virtual double Evaluate(const Field& y, Field& gradient) = 0;

  /// Fixes the positive semidefinite tangent at y.
  virtual void Linearise(const Field& y) = 0;

  /// Whether that is not zero.
  virtual bool HasTangent() const = 0;
  /// q += tangent p, and the 3 x 3 blocks of its diagonal.
  virtual void AddProduct(const Field& p, Field& q) = 0;
  virtual void AddDiagonal(BlockField& blocks) = 0;

  /// Adds Z^T tangent Z, Z the coarse space.
  virtual void AddCoarse(CoarseMatrix& matrix) = 0;

  /// Once when y has been accepted.
  virtual void EndStep(const Field&) {}
};

}  // namespace meshless_cutting
