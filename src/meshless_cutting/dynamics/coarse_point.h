// What integration points add to the coarse matrix.
#pragma once

#include "dynamics/coarse_matrix.h"
#include "dynamics/point_kernels.h"

namespace meshless_cutting {

/// Adds `factor` times the tangent of the point's strain and stabilisation energy to the rows of aggregate `row`.
/// `arguments` must name group and tangent.
void AddCoarseOfPoint(const PointKernels& kernels, const KernelArguments& arguments, const PointPlace& place,
                      double factor, int row, CoarseMatrix& matrix);

/// The same for all points that have particles of aggregate `row` alone: its functions are affine, so that these points strain
/// alike and their stabilisation is nothing. `tensor`: sum over them, see PointKernels; `place`: of one of them, of `group`.
void AddCoarseOfTensor(const PointGroup& group, const PointPlace& place, const double (*tensor)[9], double factor, int row,
                       CoarseMatrix& matrix);

}  // namespace meshless_cutting
