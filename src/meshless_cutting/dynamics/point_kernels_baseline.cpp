// The loops over points for any processor.
#include "dynamics/point_kernels.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // lanes are passed between inlined functions of this file alone

namespace meshless_cutting {
namespace {
#include "dynamics/lanes.inl"
#include "tissue/material_laws.inl"

#include "dynamics/point_kernels.inl"
}  // namespace

const PointKernelTable kPointKernelsBaseline = MESHLESS_CUTTING_POINT_KERNEL_TABLE;

}  // namespace meshless_cutting
