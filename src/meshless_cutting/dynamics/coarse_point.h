// One integration point's share in the coarse matrix.
#pragma once

#include "dynamics/coarse_matrix.h"
#include "dynamics/point_kernels.h"

namespace meshless_cutting {

/// Adds `factor` times the strain and the stabilisation energy's tangent of the point in `lane` of `batch`. `arguments` must name group and
/// tangent.
void AddCoarseOfPoint(const PointKernels& kernels, const KernelArguments& arguments, int batch, int lane, double factor,
                      CoarseMatrix& matrix);

}  // namespace meshless_cutting
