// The loops over points for processors with Avx2.
#include "dynamics/point_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#pragma GCC target("avx2")
#define MESHLESS_CUTTING_LANES_AVX2       // GCC does not define __AVX2__ for the pragma
#pragma GCC diagnostic ignored "-Wpsabi"  // lanes are passed between inlined functions of this file alone

namespace meshless_cutting {
namespace {
#include "dynamics/lanes.inl"
#include "tissue/material_laws.inl"

#include "dynamics/point_kernels.inl"
}  // namespace

const PointKernelTable kPointKernelsAvx2 = MESHLESS_CUTTING_POINT_KERNEL_TABLE;

}  // namespace meshless_cutting
#endif
