// One integration point's share in the coarse matrix.
#pragma once

#include "dynamics/coarse_matrix.h"
#include "dynamics/point_kernels.h"

namespace meshless_cutting {

/// Adds `factor` times the tangent of the point's strain and stabilisation energy to the rows of aggregate `row`.
/// `arguments` must name group and tangent.
void AddCoarseOfPoint(const PointKernels& kernels, const KernelArguments& arguments, const PointPlace& place,
                      double factor, int row, CoarseMatrix& matrix);

}  // namespace meshless_cutting
