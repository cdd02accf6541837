#include "dynamics/point_support.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Relative deviation of rest positions or gradients that still counts as "the corners of a box".
constexpr double kBoxTolerance = 1e-9;

/// Whether the particles are the corners of a box about their mean; sets their order.
bool AreCorners(const Tissue& tissue, const int* particles, PointSupport& support) {
  const Eigen::Vector3d half = (tissue.particle_rest[particles[0]] - support.mean).cwiseAbs();
  if (!(half.minCoeff() > 0)) return false;
  unsigned found = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d offset = tissue.particle_rest[particles[k]] - support.mean;
    if ((offset.cwiseAbs() - half).cwiseAbs().maxCoeff() > kBoxTolerance * half.maxCoeff()) return false;
    const int corner = (offset.x() > 0 ? 1 : 0) | (offset.y() > 0 ? 2 : 0) | (offset.z() > 0 ? 4 : 0);
    found |= 1u << corner;
    support.order[corner] = k;
  }
  return found == 0xffu;
}

/// The shape that the gradients have on the corners of a box; sets the coefficients of their modes.
SupportShape ShapeOnBox(const Eigen::Vector3d* gradients, double scale, PointSupport& support) {
  double largest_hourglass = 0;
  for (int mode = 0; mode < 8; ++mode) {
    Eigen::Vector3d c = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 8; ++corner) c += Hadamard(mode, corner) * gradients[support.order[corner]];
    c /= 8;
    const int* hourglass = std::find(kHourglassModes, kHourglassModes + 4, mode);
    if (hourglass != kHourglassModes + 4) {
      for (int i = 0; i < 3; ++i) support.hourglass[hourglass - kHourglassModes][i] = c[i];
      largest_hourglass = std::max(largest_hourglass, c.cwiseAbs().maxCoeff());
      continue;
    }
    if (mode != 0) {
      const int axis = mode == 1 ? 0 : mode == 2 ? 1 : 2;
      support.box[axis] = c[axis];
      c[axis] = 0;
    }
    if (!(c.cwiseAbs().maxCoeff() <= kBoxTolerance * scale)) return SupportShape::kGeneral;
  }
  return largest_hourglass <= kBoxTolerance * scale ? SupportShape::kBoxCentre : SupportShape::kBox;
}

}  // namespace

PointSupport DescribeSupport(const Tissue& tissue, int point) {
  PointSupport support;
  const int K = tissue.support_size;
  const std::size_t first = static_cast<std::size_t>(point) * K;
  const int* particles = &tissue.point_particles[first];
  for (int k = 0; k < K; ++k) support.mean += tissue.particle_rest[particles[k]];
  support.mean /= K;
  for (int k = 0; k < K; ++k) support.h2 += (tissue.particle_rest[particles[k]] - support.mean).squaredNorm();
  support.h2 *= 4.0 / 3 / K;
  if (K == 8 && AreCorners(tissue, particles, support)) {
    support.shape = ShapeOnBox(&tissue.point_gradients[first], 1 / std::sqrt(support.h2), support);
  }
  return support;
}

}  // namespace meshless_cutting
