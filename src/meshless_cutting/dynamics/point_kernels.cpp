#include "dynamics/point_kernels.h"

namespace meshless_cutting {
namespace {

const PointKernelTable& FastestTable() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    return kPointKernelsAvx512;
  }
  if (__builtin_cpu_supports("avx2")) return kPointKernelsAvx2;
#endif
  return kPointKernelsBaseline;
}

}  // namespace

const PointKernels& SelectPointKernels(MaterialModel model, SupportShape shape) {
  return FastestTable()[static_cast<int>(model)][static_cast<int>(shape)];
}

}  // namespace meshless_cutting
