// The integration points as the loops over them want them: sorted by the shape of their support, eight side by side.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "dynamics/field.h"
#include "dynamics/point_support.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Points that one instruction works on. The last batch of a group is filled up with copies of a point that weigh nothing.
constexpr int kLanes = 8;

/// Particles that one task of a parallel loop can have at most. It takes some microseconds, and what it reads of the particles
/// and sums for them stays in the first level cache.
constexpr int kSlotsPerChunk = 2048;

/// A particle of a task: its place among those of the task.
using Slot = std::uint16_t;

/// Batches that one task takes.
constexpr int BatchesPerChunk(int support) { return kSlotsPerChunk / (kLanes * support); }

/// Points of one shape. Arrays are indexed [batch][...][lane]; a lane is a point.
struct PointGroup {
  SupportShape shape = SupportShape::kGeneral;
  int material = 0;
  int support = 8;  // K
  int batches = 0;
  int placed = 0;  // while it is built

  std::vector<int> point;             // [batch][lane] index in Tissue; -1 in filling lanes
  std::vector<int> particle;          // [batch][K][lane]; corners of a box in the order of their bits
  std::vector<Slot> slot;             // [batch][K][lane]; of the particle, counted from the first of the chunk
  AlignedVector<double> volume;         // [batch][lane] V, m^3
  AlignedVector<double> stabilisation;  // [batch][lane] S, N/m: energy S/2 sum_k |x_k - affine fit|^2

  AlignedVector<double> box;        // boxes: [batch][3][lane] c_1x, c_2y, c_4z, 1/m
  AlignedVector<double> hourglass;  // kBox: [batch][4][3][lane] c_3, c_5, c_6, c_7, 1/m
  AlignedVector<double> gradient;   // kGeneral: [batch][K][3][lane] dphi_k/dX, 1/m
  AlignedVector<double> fit;        // kGeneral: [batch][K][3][lane] affine fit: its gradient is sum_k x_k (x) fit_k, 1/m
  AlignedVector<double> offset;     // kGeneral: [batch][K][3][lane] X_k less the mean of the K, m
};

/// A stretch of batches of one group: one task of a parallel loop. It sums what it has for a particle in a *slot* of its own, one
/// per particle that it touches, [first_slot, last_slot), and reads the particle's vector from a copy in the same order.
struct PointChunk {
  int group, begin, end;  // batches
  int first_slot, last_slot;
};

/// A slot whose sum is added to that of another.
struct SlotPair {
  int from, to;
};

/// Where a point is.
struct PointPlace {
  int group, batch, lane;
};

/// All points, neighbours close to each other, and the way of their sums to the particles: a loop over chunks leaves a
/// Vector4 in every slot, a loop over particles gathers them. The order of all sums is fixed here.
struct PointGroups {
  std::vector<PointGroup> groups;  // kSupportShapes per material
  std::vector<PointPlace> places;  // per point of the tissue
  std::vector<PointChunk> chunks;
  int slot_count = 0;  // size of a buffer of slots; the last of them is no chunk's and zero
  std::vector<int> slot_particle;  // per slot but the last

  // Most particles have one slot. Where chunks meet there are more: they are added to the first, in their order.
  std::vector<int> first_slot;       // per particle; the last of all if no point has it
  std::vector<SlotPair> more_slots;  // in the order of the particles
  std::vector<int> more_begin;       // per kParticlesPerChunk particles, and the end

  /// Rebuilds from `tissue`. `stiffness` per material: alpha mu, Pa. The stabilisation of a point is alpha mu V / (8 h^2) 8 / K with
  /// h^2 = 4/3 of the mean square distance of the K rest positions from their mean (h of a cube of edge h).
  /// Allocates only to grow. Points that were there before keep their order; a tissue with fewer points is a new one.
  void Build(const Tissue& tissue, const std::vector<double>& stiffness);

 private:
  void SortNewPoints(const Tissue& tissue);
  /// Whether supports_[p] is what DescribeSupport would say again: gradients follow from the centroid and the particles.
  bool IsDescribed(const Tissue& tissue, int p) const;
  void BuildSlots(int particles);

  std::vector<PointSupport> supports_;   // of the points whose centroid and particles were:
  std::vector<Eigen::Vector3d> described_rest_;
  std::vector<int> described_particles_;
  std::vector<int> counts_;              // scratch, per group
  std::vector<int> order_;               // points along a space-filling curve
  std::vector<std::uint64_t> curve_;     // place of each point on it
  std::vector<int> slot_of_, slot_begin_;
  std::vector<std::pair<double, PointChunk>> chunk_order_;
};

}  // namespace meshless_cutting
