// The inner loops over particles of the linear solver, each over a range that one task takes.
#pragma once

#include <vector>

#include "dynamics/coarse_matrix.h"
#include "dynamics/field.h"
#include "dynamics/force_term.h"

namespace meshless_cutting {

/// Particles [begin, end).
struct ParticleRange {
  int begin, end;
  ParticleRange(int chunk, int count)
      : begin(chunk * kParticlesPerChunk),
        end(begin + kParticlesPerChunk < count ? begin + kParticlesPerChunk : count) {}
};

/// to[j - begin] += factor times the sum of buffer[slots[n]] over n in [slot_begin[j], slot_begin[j + 1]).
void GatherSlots(const ParticleRange& range, const Vector4* buffer, const int* slot_begin, const int* slots,
                 double factor, Vector4* to);

/// What the loop over points left for the particles.
struct SlotSums {
  const Vector4* buffer;
  const int *slot_begin, *slots;
};

/// q[j] = free[j] (inertia[j] p[j] + factor (sum of its slots)); returns the sum of p[j] . q[j].
double GatherProduct(const ParticleRange& range, const SlotSums& sums, double factor, const double* free,
                     const double* inertia, const Vector4* p, Vector4* q);

/// gradient[j] (in: of all other terms) += sum of its slots + inertia[j] (y[j] - target[j]), zero where not free.
struct GradientSums {
  double inertia = 0;              // sum of inertia |y - target|^2, J
  double residual = 0, terms = 0;  // weighted sums of |gradient|^2 with and without inertia, N^2
};
GradientSums GatherGradient(const ParticleRange& range, const SlotSums& sums, const double* free, const double* inertia,
                            const double* weight, const Vector4* y, const Vector4* target, Vector4* gradient);

/// q[j] *= mask[j]; returns the sum of p[j] . q[j].
double MaskAndDot(const ParticleRange& range, const double* mask, const Vector4* p, Vector4* q);

/// step += alpha direction, residual -= alpha product; returns the weighted sum of |residual|^2.
double AdvanceSolution(const ParticleRange& range, double alpha, const Vector4* direction, const Vector4* product,
                       const double* weight, Vector4* step, Vector4* residual);

/// direction = scaled + beta direction.
void NextDirection(const ParticleRange& range, double beta, const Vector4* scaled, Vector4* direction);

/// coarse[3 c + i] = sum over the listed particles of basis_c r_i.
void Restrict(const int* particles, int count, const Vector4* basis, const Vector4* r, double* coarse);

/// z[j] = inverse[j] r[j] + sum_c basis_c(j) coarse[aggregate of j][c], the latter not for particles of none; returns
/// the sum of r . z.
double ScaleAndProlong(const ParticleRange& range, const SymmetricBlock* inverse, const int* aggregate,
                       const Vector4* basis, const double* coarse, const Vector4* r, Vector4* z);

}  // namespace meshless_cutting
