// The inner loops over particles of the linear solver, each over a range that one task takes.
#pragma once

#include <vector>

#include "dynamics/coarse_matrix.h"
#include "dynamics/field.h"
#include "dynamics/force_term.h"
#include "dynamics/point_groups.h"

namespace meshless_cutting {

/// Particles [begin, end).
struct ParticleRange {
  int begin, end;
  ParticleRange(int chunk, int count)
      : begin(chunk * kParticlesPerChunk),
        end(begin + kParticlesPerChunk < count ? begin + kParticlesPerChunk : count) {}
};

/// What a loop over points left for the particles. Gathering it leaves the sums in the first slots: once only.
template <class Vector>
struct BasicSlotSums {
  BasicSlotSums(Vector* buffer_, const PointGroups& groups)
      : buffer(buffer_),
        first_slot(groups.first_slot.data()),
        more_begin(groups.more_begin.data()),
        more_slots(groups.more_slots.data()) {}

  Vector* buffer;
  const int *first_slot, *more_begin;
  const SlotPair* more_slots;
};
using SlotSums = BasicSlotSums<Vector4>;
using SingleSlotSums = BasicSlotSums<SingleVector4>;

/// to[j - begin] += factor times the sum of the slots of j.
void GatherSlots(const ParticleRange& range, const SlotSums& sums, double factor, Vector4* to);

/// q[j] = free[j] (inertia[j] p[j] + factor (sum of its slots)); returns the sum of p[j] . q[j].
double GatherProduct(const ParticleRange& range, const SingleSlotSums& sums, double factor, const double* free,
                     const double* inertia, const SingleVector4* p, SingleVector4* q);

/// gradient[j] (in: of all other terms) += sum of its slots + inertia[j] (y[j] - target[j]), zero where not free.
struct GradientSums {
  double inertia = 0;              // sum of inertia |y - target|^2, J
  double residual = 0, terms = 0;  // weighted sums of |gradient|^2 with and without inertia, N^2
};
GradientSums GatherGradient(const ParticleRange& range, const SlotSums& sums, const double* free, const double* inertia,
                            const double* weight, const Vector4* y, const Vector4* target, Vector4* gradient);

/// q[j] += mask[j] more[j]; returns the sum of p[j] . q[j].
double AddMaskedAndDot(const ParticleRange& range, const double* mask, const Vector4* more, const SingleVector4* p,
                       SingleVector4* q);

/// The columns of a symmetric 3 x 3 block.
struct SingleBlock {
  SingleVector4 x, y, z;
};

/// step += alpha direction, residual -= alpha product, scaled = inverse residual.
struct SolutionSums {
  double residual = 0;  // weighted sum of |residual|^2
  double scaled = 0;    // sum of residual . scaled
};
SolutionSums AdvanceSolution(const ParticleRange& range, double alpha, const SingleVector4* direction,
                             const SingleVector4* product, const double* weight, const SingleBlock* inverse,
                             SingleVector4* step, SingleVector4* residual, SingleVector4* scaled);

/// coarse[c] = sum over the listed particles of basis_c r.
void Restrict(const int* particles, int count, const SingleVector4* basis, const SingleVector4* r,
              SingleVector4* coarse);

/// direction[j] = z + beta direction[j] with z = scaled[j] + sum_c basis_c(j) coarse[aggregate of j][c], the latter not for
/// particles of none.
void NextDirection(const ParticleRange& range, double beta, const SingleVector4* scaled, const int* aggregate,
                   const SingleVector4* basis, const SingleVector4* coarse, SingleVector4* direction);

}  // namespace meshless_cutting
