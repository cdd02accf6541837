#include "dynamics/point_groups.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "tissue/space_filling_curve.h"

namespace meshless_cutting {
namespace {

/// Rows of the least squares fit of an affine map to K positions; a support that is flat or thinner is fitted with the
/// smallest gradient.
void FillGeneral(const Tissue& tissue, int p, const Eigen::Vector3d& mean, PointGroup& group, int batch, int lane) {
  const int K = tissue.support_size;
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

void Resize(PointGroup& group) {
  const std::size_t lanes = static_cast<std::size_t>(group.batches) * kLanes, K = group.support;
  const bool is_general = group.shape == SupportShape::kGeneral;
  ResizeWithRoom(group.point, lanes);
  ResizeWithRoom(group.particle, lanes * K);
  ResizeWithRoom(group.slot, lanes * K);
  ResizeWithRoom(group.volume, lanes);
  ResizeWithRoom(group.stabilisation, lanes);
  std::fill(group.point.begin(), group.point.end(), -1);
  std::fill(group.volume.begin(), group.volume.end(), 0.0);
  std::fill(group.stabilisation.begin(), group.stabilisation.end(), 0.0);
  ResizeWithRoom(group.box, is_general ? 0 : lanes * 3);
  ResizeWithRoom(group.hourglass, group.shape == SupportShape::kBox ? lanes * 12 : 0);
  for (AlignedVector<double>* array : {&group.gradient, &group.fit, &group.offset}) {
    ResizeWithRoom(*array, is_general ? lanes * K * 3 : 0);
  }
}

/// Where the n-th of `count` points of a group goes. Along the space-filling curve a chunk is filled lane by lane, not
/// batch by batch: the points of one batch lie apart, share no particles, and do not wait for each other's sums.
PointPlace PlaceOf(int group, int support, int n, int count) {
  const int points_per_chunk = BatchesPerChunk(support) * kLanes;
  const int chunk = n / points_per_chunk, in_chunk = std::min(points_per_chunk, count - chunk * points_per_chunk);
  const int batches = (in_chunk + kLanes - 1) / kLanes;
  return {group, chunk * BatchesPerChunk(support) + n % points_per_chunk % batches, n % points_per_chunk / batches};
}

/// Copies the numbers that describe a point from lane 0 of a batch, which is never empty, to lanes without a point: any valid
/// numbers will do.
void FillEmptyLanes(PointGroup& group) {
  const auto fill = [&](auto& array, int batch, int lane, int per_batch) {
    if (array.empty()) return;
    for (int row = 0; row < per_batch; ++row) {
      auto* lanes = &array[(static_cast<std::size_t>(batch) * per_batch + row) * kLanes];
      lanes[lane] = lanes[0];
    }
  };
  for (int batch = 0; batch < group.batches; ++batch) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (group.point[static_cast<std::size_t>(batch) * kLanes + lane] >= 0) continue;
      fill(group.particle, batch, lane, group.support);
      fill(group.box, batch, lane, 3);
      fill(group.hourglass, batch, lane, 12);
      fill(group.gradient, batch, lane, group.support * 3);
      fill(group.fit, batch, lane, group.support * 3);
      fill(group.offset, batch, lane, group.support * 3);
    }
  }
}

/// Writes point p to its place.
void Put(const Tissue& tissue, int p, const PointSupport& support, double stabilisation, const PointPlace& place,
         PointGroup& group) {
  const int K = group.support, lane = place.lane;
  const std::size_t batch = place.batch;
  const bool is_box = support.shape != SupportShape::kGeneral;
  group.point[batch * kLanes + lane] = p;
  group.volume[batch * kLanes + lane] = tissue.point_volume[p];
  group.stabilisation[batch * kLanes + lane] = stabilisation;
  for (int k = 0; k < K; ++k) {
    const int from = is_box ? support.order[k] : k;
    group.particle[(batch * K + k) * kLanes + lane] = tissue.point_particles[static_cast<std::size_t>(p) * K + from];
  }
  if (!is_box) FillGeneral(tissue, p, support.mean, group, place.batch, lane);
  for (int i = 0; i < 3 && is_box; ++i) group.box[(batch * 3 + i) * kLanes + lane] = support.box[i];
  for (int n = 0; n < 12 && support.shape == SupportShape::kBox; ++n) {
    group.hourglass[(batch * 12 + n) * kLanes + lane] = support.hourglass[n / 3][n % 3];
  }
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
  ResizeWithRoom(curve_, points);
  ResizeWithRoom(order_, points);
  for (int p = known; p < points; ++p) {
    curve_[p] = cell > 0 ? MortonCode(((tissue.point_rest[p] - bounds.min()) / cell).cast<int>()) : 0;
    order_[p] = p;
  }
  const auto earlier = [&](int a, int b) { return curve_[a] != curve_[b] ? curve_[a] < curve_[b] : a < b; };
  std::sort(order_.begin() + known, order_.end(), earlier);
  std::inplace_merge(order_.begin(), order_.begin() + known, order_.end(), earlier);
}

bool PointGroups::IsDescribed(const Tissue& tissue, int p) const {
  const std::size_t K = tissue.support_size, first = p * K;
  return first + K <= described_particles_.size() && described_rest_[p] == tissue.point_rest[p] &&
         std::equal(&described_particles_[first], &described_particles_[first] + K, &tissue.point_particles[first]);
}

void PointGroups::Build(const Tissue& tissue, const std::vector<double>& stiffness) {
  SortNewPoints(tissue);
  groups.resize(stiffness.size() * kSupportShapes);
  counts_.assign(groups.size(), 0);
  const auto group_of = [&](int p) { return tissue.material(p) * kSupportShapes + static_cast<int>(supports_[p].shape); };
  ResizeWithRoom(supports_, tissue.point_count());
  ResizeWithRoom(places, tissue.point_count());
  for (int p = 0; p < tissue.point_count(); ++p) {
    if (!IsDescribed(tissue, p)) supports_[p] = DescribeSupport(tissue, p);
    ++counts_[group_of(p)];
  }
  for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
    groups[g].shape = static_cast<SupportShape>(g % kSupportShapes);
    groups[g].material = g / kSupportShapes;
    groups[g].support = tissue.support_size;
    groups[g].batches = (counts_[g] + kLanes - 1) / kLanes;
    groups[g].placed = 0;
    Resize(groups[g]);
  }
  for (int p : order_) {
    const PointSupport& support = supports_[p];
    const int g = group_of(p);
    const double scale = tissue.support_size * support.h2;
    const double stabilisation = scale > 0 ? stiffness[groups[g].material] * tissue.point_volume[p] / scale : 0;
    places[p] = PlaceOf(g, tissue.support_size, groups[g].placed++, counts_[g]);
    Put(tissue, p, support, stabilisation, places[p], groups[g]);
  }
  ResizeWithRoom(described_rest_, tissue.point_rest.size());
  ResizeWithRoom(described_particles_, tissue.point_particles.size());
  std::copy(tissue.point_rest.begin(), tissue.point_rest.end(), described_rest_.begin());
  std::copy(tissue.point_particles.begin(), tissue.point_particles.end(), described_particles_.begin());
  for (PointGroup& group : groups) FillEmptyLanes(group);
  BuildSlots(tissue.particle_count());
}

void PointGroups::BuildSlots(int particles) {
  chunks.clear();
  for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
    const int per_chunk = BatchesPerChunk(groups[g].support);
    for (int begin = 0; begin < groups[g].batches; begin += per_chunk) {
      chunks.push_back({g, begin, std::min(begin + per_chunk, groups[g].batches), 0, 0});
    }
  }
  // In the order of their particles, so that the threads' stretches of points and of particles lie at the same place.
  const auto mean_particle = [&](const PointChunk& chunk) {
    const std::vector<int>& particle = groups[chunk.group].particle;
    const std::size_t stride = static_cast<std::size_t>(groups[chunk.group].support) * kLanes;
    double sum = 0;
    for (std::size_t at = chunk.begin * stride; at < chunk.end * stride; ++at) sum += particle[at];
    return sum / static_cast<double>((chunk.end - chunk.begin) * stride);
  };
  chunk_order_.clear();
  for (const PointChunk& chunk : chunks) chunk_order_.emplace_back(mean_particle(chunk), chunk);
  std::sort(chunk_order_.begin(), chunk_order_.end(), [](const auto& x, const auto& y) {
    if (x.first != y.first) return x.first < y.first;
    return x.second.group != y.second.group ? x.second.group < y.second.group : x.second.begin < y.second.begin;
  });

  slot_particle.clear();
  slot_of_.assign(particles, -1);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    PointChunk& chunk = chunks[c] = chunk_order_[c].second;
    PointGroup& group = groups[chunk.group];
    chunk.first_slot = static_cast<int>(slot_particle.size());
    const std::size_t stride = static_cast<std::size_t>(group.support) * kLanes;
    for (std::size_t at = chunk.begin * stride; at < chunk.end * stride; ++at) {
      const int j = group.particle[at];
      if (slot_of_[j] < chunk.first_slot) {
        slot_of_[j] = static_cast<int>(slot_particle.size());
        slot_particle.push_back(j);
      }
      group.slot[at] = static_cast<Slot>(slot_of_[j] - chunk.first_slot);
    }
    chunk.last_slot = static_cast<int>(slot_particle.size());
  }
  const int slots = static_cast<int>(slot_particle.size());
  slot_count = slots + 1;

  // The slots of each particle, in their order, in slot_of_.
  slot_begin_.assign(particles + 1, 0);
  for (int j : slot_particle) ++slot_begin_[j + 1];
  for (int j = 0; j < particles; ++j) slot_begin_[j + 1] += slot_begin_[j];
  ResizeWithRoom(slot_of_, slots);
  for (int slot = slots - 1; slot >= 0; --slot) slot_of_[--slot_begin_[slot_particle[slot] + 1]] = slot;
  // Filling from the back moved each end down to the start of its own row, one place too high.
  std::copy(slot_begin_.begin() + 1, slot_begin_.end(), slot_begin_.begin());
  slot_begin_[particles] = slots;

  ResizeWithRoom(first_slot, particles);
  more_slots.clear();
  more_begin.clear();
  for (int j = 0; j < particles; ++j) {
    if (j % kParticlesPerChunk == 0) more_begin.push_back(static_cast<int>(more_slots.size()));
    first_slot[j] = slot_begin_[j] < slot_begin_[j + 1] ? slot_of_[slot_begin_[j]] : slots;
    for (int n = slot_begin_[j] + 1; n < slot_begin_[j + 1]; ++n) more_slots.push_back({slot_of_[n], first_slot[j]});
  }
  more_begin.push_back(static_cast<int>(more_slots.size()));
}

}  // namespace meshless_cutting
