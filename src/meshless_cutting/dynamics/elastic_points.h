// All loops over integration points, in parallel: stress, tangent, products. Sums over the points of a particle are gathered
// in a fixed order, so that the bits do not depend on the threads.
#pragma once

#include <vector>

#include "dynamics/field_loops.h"
#include "dynamics/force_term.h"
#include "dynamics/point_groups.h"
#include "dynamics/point_kernels.h"
#include "dynamics/thread_pool.h"

namespace meshless_cutting {

/// The tangent at some state, per group of points.
template <class Number>
struct BasicPointTangent {
  std::vector<AlignedVector<Number>> groups;
};
using PointTangent = BasicPointTangent<double>;
/// Half the size, for the linear solver.
using SinglePointTangent = BasicPointTangent<float>;

/// The potential damping / 2 (x - still)^T K (x - still) of forces that oppose the way from `still`.
struct PointDamping {
  const PointTangent* tangent = nullptr;  // K
  const Field* still = nullptr;           // m
  double damping = 0;
};

class ElasticPoints {
 public:
  /// `pool` must outlive this.
  ElasticPoints(const MaterialConfig& material, ThreadPool& pool)
      : ElasticPoints(std::vector<MaterialConfig>{material}, 1, pool) {}
  /// One material per value of Tissue::point_material. `stabilisation`: weight of the term against zero-energy modes.
  ElasticPoints(const std::vector<MaterialConfig>& materials, double stabilisation, ThreadPool& pool);

  void TissueChanged(const Tissue& tissue);

  /// Strain energy and stabilisation, J; leaves the gradient, N, in the slots. The caller gathers.
  double EvaluateInSlots(const Field& x);
  /// The same with damping, which costs half of what a loop of its own would.
  double EvaluateInSlots(const Field& x, const PointDamping& damping);
  /// Leaves tangent p in the slots.
  void ProductInSlots(const PointTangent& tangent, const Field& p);
  SlotSums slot_sums() { return {slots_.data(), groups_}; }
  /// In those of single precision.
  void ProductInSlots(const SinglePointTangent& tangent, const SingleField& p);
  SingleSlotSums single_slot_sums() { return {single_slots_.data(), groups_}; }

  /// Strain energy and stabilisation, J; adds its gradient, N.
  double Evaluate(const Field& x, Field& gradient);
  /// Sizes a tangent for the tissue as it is; before Linearise.
  template <class Tangent>
  void Resize(Tangent& tangent) const;
  /// filtered: made positive semidefinite.
  template <class Tangent>
  void Linearise(const Field& x, bool filtered, Tangent& tangent);
  /// q += factor tangent p.
  void AddProduct(const PointTangent& tangent, double factor, const Field& p, Field& q);
  template <class Tangent>
  void AddDiagonal(const Tangent& tangent, double factor, BlockField& blocks);

  template <class Tangent>
  void AddCoarse(const Tangent& tangent, double factor, CoarseMatrix& matrix);

  const PointGroups& groups() const { return groups_; }
  ThreadPool& pool() { return pool_; }
  /// Of the stiffest material.
  const LameConstants& lame() const { return stiffest_; }

 private:
  KernelArguments Arguments(const PointChunk& chunk);
  template <class Tangent>
  KernelArguments Arguments(const PointChunk& chunk, const Tangent& tangent);

  double SumOfEnergies() const;

  /// to[n] += factor times the slots of the n-th particle of a chunk.
  void Gather(int chunk, Vector4* buffer, double factor, Vector4* to) const;

  ThreadPool& pool_;
  std::vector<LameConstants> lame_;  // per material
  LameConstants stiffest_;
  std::vector<double> stabilisation_;  // per material, Pa
  std::vector<PointKernels> kernels_;  // per group
  PointGroups groups_;
  std::vector<double> chunk_energy_;
  Field slots_;
  SingleField single_slots_;
  int particles_ = 0;
};

}  // namespace meshless_cutting
