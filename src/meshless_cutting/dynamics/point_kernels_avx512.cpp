// The loops over points for processors with Avx512.
#include "dynamics/point_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#pragma GCC target("avx512f,avx512dq,avx512vl,avx512bw")
#define MESHLESS_CUTTING_LANES_AVX2  // GCC does not define __AVX2__ and __AVX512F__ for the pragma
#define MESHLESS_CUTTING_LANES_AVX512
#pragma GCC diagnostic ignored "-Wpsabi"  // lanes are passed between inlined functions of this file alone
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC bug 105593, in its own intrinsics

namespace meshless_cutting {
namespace {
#include "dynamics/lanes.inl"
#include "tissue/material_laws.inl"

#include "dynamics/point_kernels.inl"
}  // namespace

const PointKernelTable kPointKernelsAvx512 = MESHLESS_CUTTING_POINT_KERNEL_TABLE;

}  // namespace meshless_cutting
#endif
