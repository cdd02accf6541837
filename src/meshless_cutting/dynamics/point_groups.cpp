#include "dynamics/point_groups.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Weight of the stabilisation against zero-energy modes; 1 gave the smallest errors over the reference problems.
constexpr double kStabilisation = 1.0;

/// Relative deviation of rest positions or gradients that still counts as "the corners of a box".
constexpr double kBoxTolerance = 1e-9;

/// One point, sorted out.
struct Support {
  SupportShape shape = SupportShape::kGeneral;
  std::array<int, 8> order{};  // boxes: corner -> k
  double box[3] = {};
  double hourglass[4][3] = {};
};

double MeanSquareOffset(const Tissue& tissue, int p, Eigen::Vector3d& mean) {
  const int K = tissue.support_size;
  const int* particles = &tissue.point_particles[static_cast<std::size_t>(p) * K];
  mean.setZero();
  for (int k = 0; k < K; ++k) mean += tissue.particle_rest[particles[k]];
  mean /= K;
  double sum = 0;
  for (int k = 0; k < K; ++k) sum += (tissue.particle_rest[particles[k]] - mean).squaredNorm();
  return sum / K;
}

Support Classify(const Tissue& tissue, int p, const Eigen::Vector3d& mean) {
  Support support;
  if (tissue.support_size != 8) return support;
  const std::size_t first = static_cast<std::size_t>(p) * 8;
  const int* particles = &tissue.point_particles[first];
  const Eigen::Vector3d* gradients = &tissue.point_gradients[first];

  const Eigen::Vector3d half = (tissue.particle_rest[particles[0]] - mean).cwiseAbs();
  if (!(half.minCoeff() > 0)) return support;
  unsigned found = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d offset = tissue.particle_rest[particles[k]] - mean;
    if ((offset.cwiseAbs() - half).cwiseAbs().maxCoeff() > kBoxTolerance * half.maxCoeff()) return support;
    const int corner = (offset.x() > 0 ? 1 : 0) | (offset.y() > 0 ? 2 : 0) | (offset.z() > 0 ? 4 : 0);
    found |= 1u << corner;
    support.order[corner] = k;
  }
  if (found != 0xffu) return support;

  const double scale = 1 / half.minCoeff();
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
    if (!(c.cwiseAbs().maxCoeff() <= kBoxTolerance * scale)) return support;
  }
  support.shape = largest_hourglass <= kBoxTolerance * scale ? SupportShape::kBoxCentre : SupportShape::kBox;
  return support;
}

/// Rows of the least squares fit of an affine map to K positions; a support that is flat or thinner is fitted with the
/// smallest gradient.
void FillGeneral(const Tissue& tissue, int p, const Eigen::Vector3d& mean, PointGroup& group, int slot) {
  const int K = tissue.support_size, batch = slot / kLanes, lane = slot % kLanes;
  const std::size_t first = static_cast<std::size_t>(p) * K;
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (int k = 0; k < K; ++k) {
    const Eigen::Vector3d offset = tissue.particle_rest[tissue.point_particles[first + k]] - mean;
    moment += offset * offset.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(moment);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value > 1e-9 * moment.trace()) {
      inverse += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose() / value;
    }
  }
  for (int k = 0; k < K; ++k) {
    const Eigen::Vector3d offset = tissue.particle_rest[tissue.point_particles[first + k]] - mean;
    const Eigen::Vector3d fit = inverse * offset;
    for (int i = 0; i < 3; ++i) {
      const std::size_t at = ((static_cast<std::size_t>(batch) * K + k) * 3 + i) * kLanes + lane;
      group.gradient[at] = tissue.point_gradients[first + k][i];
      group.fit[at] = fit[i];
      group.offset[at] = offset[i];
    }
  }
}

/// Place on the Z-order curve of the cell that holds x, x >= 0 in cells.
std::uint64_t MortonCode(const Eigen::Vector3d& x) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::uint64_t>(x[axis]);
    for (int bit = 0; bit < 20; ++bit) code |= (cell >> bit & 1) << (3 * bit + axis);
  }
  return code;
}

void Clear(PointGroup& group) {
  group.batches = 0;
  group.point.clear();
  group.particle.clear();
  group.slot.clear();
  for (AlignedVector<double>* array : {&group.volume, &group.stabilisation, &group.box, &group.hourglass, &group.gradient,
                                     &group.fit, &group.offset}) {
    array->clear();
  }
}

void AddBatch(PointGroup& group) {
  const std::size_t lanes = static_cast<std::size_t>(++group.batches) * kLanes, K = group.support;
  group.point.resize(lanes, -1);
  group.particle.resize(lanes * K);
  group.slot.resize(lanes * K);
  group.volume.resize(lanes, 0);
  group.stabilisation.resize(lanes, 0);
  if (group.shape != SupportShape::kGeneral) group.box.resize(lanes * 3);
  if (group.shape == SupportShape::kBox) group.hourglass.resize(lanes * 12);
  if (group.shape == SupportShape::kGeneral) {
    for (AlignedVector<double>* array : {&group.gradient, &group.fit, &group.offset}) array->resize(lanes * K * 3);
  }
}

/// Copies the numbers that describe a point from lane 0 of the last batch to the filling lanes: any valid numbers will do.
void FillLastBatch(PointGroup& group, int points) {
  if (points % kLanes == 0) return;
  const auto fill = [&](auto& array, int per_batch) {
    if (array.empty()) return;
    for (int row = 0; row < per_batch; ++row) {
      auto* lanes = &array[(static_cast<std::size_t>(group.batches - 1) * per_batch + row) * kLanes];
      std::fill(lanes + points % kLanes, lanes + kLanes, lanes[0]);
    }
  };
  fill(group.particle, group.support);
  fill(group.box, 3);
  fill(group.hourglass, 12);
  fill(group.gradient, group.support * 3);
  fill(group.fit, group.support * 3);
  fill(group.offset, group.support * 3);
}

}  // namespace

void PointGroups::SortNewPoints(const Tissue& tissue) {
  const int points = tissue.point_count();
  if (points < static_cast<int>(order_.size())) order_.clear();
  const int known = static_cast<int>(order_.size());
  if (points == known) return;
  Eigen::AlignedBox3d bounds;
  double largest = 0;
  for (int p = 0; p < points; ++p) {
    bounds.extend(tissue.point_rest[p]);
    largest = std::max(largest, tissue.point_volume[p]);
  }
  const double cell = std::max(std::cbrt(largest), 1e-5 * bounds.sizes().maxCoeff());
  curve_.resize(points);
  order_.resize(points);
  for (int p = known; p < points; ++p) {
    curve_[p] = cell > 0 ? MortonCode((tissue.point_rest[p] - bounds.min()) / cell) : 0;
    order_[p] = p;
  }
  const auto earlier = [&](int a, int b) { return curve_[a] != curve_[b] ? curve_[a] < curve_[b] : a < b; };
  std::sort(order_.begin() + known, order_.end(), earlier);
  std::inplace_merge(order_.begin(), order_.begin() + known, order_.end(), earlier);
}

void PointGroups::Build(const Tissue& tissue, double shear_modulus) {
  const int K = tissue.support_size;
  int counts[kSupportShapes] = {};
  for (int shape = 0; shape < kSupportShapes; ++shape) {
    groups[shape].shape = static_cast<SupportShape>(shape);
    groups[shape].support = K;
    Clear(groups[shape]);
  }
  SortNewPoints(tissue);
  for (int p : order_) {
    Eigen::Vector3d mean;
    const double h2 = 4.0 / 3 * MeanSquareOffset(tissue, p, mean);
    const Support support = Classify(tissue, p, mean);
    PointGroup& group = groups[static_cast<int>(support.shape)];
    const int index = counts[static_cast<int>(support.shape)]++;
    const int batch = index / kLanes, lane = index % kLanes;
    if (lane == 0) AddBatch(group);

    group.point[index] = p;
    group.volume[index] = tissue.point_volume[p];
    group.stabilisation[index] = h2 > 0 ? kStabilisation * shear_modulus * tissue.point_volume[p] / (K * h2) : 0;
    const bool is_box = support.shape != SupportShape::kGeneral;
    for (int k = 0; k < K; ++k) {
      const int from = is_box ? support.order[k] : k;
      group.particle[(static_cast<std::size_t>(batch) * K + k) * kLanes + lane] =
          tissue.point_particles[static_cast<std::size_t>(p) * K + from];
    }
    if (is_box) {
      for (int i = 0; i < 3; ++i) group.box[(static_cast<std::size_t>(batch) * 3 + i) * kLanes + lane] = support.box[i];
    }
    if (support.shape == SupportShape::kBox) {
      for (int n = 0; n < 12; ++n) {
        group.hourglass[(static_cast<std::size_t>(batch) * 12 + n) * kLanes + lane] = support.hourglass[n / 3][n % 3];
      }
    }
    if (!is_box) FillGeneral(tissue, p, mean, group, index);
  }
  for (int shape = 0; shape < kSupportShapes; ++shape) FillLastBatch(groups[shape], counts[shape]);
  BuildSlots(tissue.particle_count());
}

void PointGroups::BuildSlots(int particles) {
  chunks.clear();
  slot_particle_.clear();
  slot_of_.assign(particles, -1);
  for (int g = 0; g < kSupportShapes; ++g) {
    PointGroup& group = groups[g];
    for (int begin = 0; begin < group.batches; begin += kBatchesPerChunk) {
      const int end = std::min(begin + kBatchesPerChunk, group.batches), first = static_cast<int>(slot_particle_.size());
      const std::size_t stride = static_cast<std::size_t>(group.support) * kLanes;
      for (std::size_t at = begin * stride; at < end * stride; ++at) {
        const int j = group.particle[at];
        if (slot_of_[j] < first) {
          slot_of_[j] = static_cast<int>(slot_particle_.size());
          slot_particle_.push_back(j);
        }
        group.slot[at] = slot_of_[j];
      }
      chunks.push_back({g, begin, end, first, static_cast<int>(slot_particle_.size())});
    }
  }
  slot_count = static_cast<int>(slot_particle_.size());

  slot_begin.assign(particles + 1, 0);
  for (int j : slot_particle_) ++slot_begin[j + 1];
  for (int j = 0; j < particles; ++j) slot_begin[j + 1] += slot_begin[j];
  slots.resize(slot_count);
  for (int slot = slot_count - 1; slot >= 0; --slot) slots[--slot_begin[slot_particle_[slot] + 1]] = slot;
  // Filling from the back moved each end down to the start of its own row, one place too high.
  std::copy(slot_begin.begin() + 1, slot_begin.end(), slot_begin.begin());
  slot_begin[particles] = slot_count;
}

}  // namespace meshless_cutting
