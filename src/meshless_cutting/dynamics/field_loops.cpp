#include "dynamics/field_loops.h"

#include "dynamics/instruction_sets.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between inlined functions of this file alone

namespace meshless_cutting {
namespace {

/// A SingleVector4 as the compiler's vector type, and what dot products are summed in: the compiler packs the loops
/// over doubles by itself, but not these.
typedef float Four __attribute__((vector_size(16)));
typedef double WideFour __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Four Load(const SingleVector4& a) {
  Four four;
  __builtin_memcpy(&four, &a.x, sizeof(four));
  return four;
}
[[gnu::always_inline]] inline void Store(const Four& four, SingleVector4& to) {
  __builtin_memcpy(&to.x, &four, sizeof(four));
}
[[gnu::always_inline]] inline WideFour Widened(const Four& four) { return __builtin_convertvector(four, WideFour); }
[[gnu::always_inline]] inline double Sum(const WideFour& a) { return (a[0] + a[1]) + (a[2] + a[3]); }

template <class Sums>
[[gnu::always_inline]] inline void GatherMore(const ParticleRange& range, const Sums& sums) {
  const int chunk = range.begin / kParticlesPerChunk;
  for (int n = sums.more_begin[chunk]; n < sums.more_begin[chunk + 1]; ++n) {
    const SlotPair& pair = sums.more_slots[n];
    sums.buffer[pair.to] += sums.buffer[pair.from];
  }
}

}  // namespace

MESHLESS_CUTTING_CLONES void GatherSlots(const ParticleRange& range, const SlotSums& sums, double factor, Vector4* to) {
  GatherMore(range, sums);
  for (int j = range.begin; j < range.end; ++j) to[j - range.begin] += factor * sums.buffer[sums.first_slot[j]];
}

MESHLESS_CUTTING_CLONES double GatherProduct(const ParticleRange& range, const SingleSlotSums& sums, double factor,
                                             const double* free, const double* inertia, const SingleVector4* p,
                                             SingleVector4* q) {
  GatherMore(range, sums);
  const auto single_factor = static_cast<float>(factor);
  WideFour dot = {};
  for (int j = range.begin; j < range.end; ++j) {
    const Four sum = Load(sums.buffer[sums.first_slot[j]]), direction = Load(p[j]);
    const Four product =
        static_cast<float>(free[j]) * (static_cast<float>(inertia[j]) * direction + single_factor * sum);
    Store(product, q[j]);
    dot += Widened(direction * product);
  }
  return Sum(dot);
}

MESHLESS_CUTTING_CLONES GradientSums GatherGradient(const ParticleRange& range, const SlotSums& sums,
                                                    const double* free, const double* inertia, const double* weight,
                                                    const Vector4* y, const Vector4* target, Vector4* gradient) {
  GatherMore(range, sums);
  Vector4 inertia_sum, residual, terms;
  for (int j = range.begin; j < range.end; ++j) {
    const Vector4& sum = sums.buffer[sums.first_slot[j]];
    const Vector4 way = y[j] - target[j], term = free[j] * (gradient[j] + sum);
    const Vector4 pull = (free[j] * inertia[j]) * way, total = term + pull;
    gradient[j] = total;
    inertia_sum += Multiply(pull, way);
    residual += weight[j] * Multiply(total, total);
    terms += weight[j] * Multiply(term, term);
  }
  return {Sum(inertia_sum), Sum(residual), Sum(terms)};
}

MESHLESS_CUTTING_CLONES double AddMaskedAndDot(const ParticleRange& range, const double* mask, const Vector4* more,
                                               const SingleVector4* p, SingleVector4* q) {
  WideFour sum = {};
  for (int j = range.begin; j < range.end; ++j) {
    q[j] += Round(mask[j] * more[j]);
    sum += Widened(Load(p[j]) * Load(q[j]));
  }
  return Sum(sum);
}

MESHLESS_CUTTING_CLONES SolutionSums AdvanceSolution(const ParticleRange& range, double alpha,
                                                     const SingleVector4* direction, const SingleVector4* product,
                                                     const double* weight, const SingleBlock* inverse,
                                                     SingleVector4* step, SingleVector4* residual,
                                                     SingleVector4* scaled) {
  const auto way = static_cast<float>(alpha);
  WideFour of_residual = {}, of_scaled = {};
  for (int j = range.begin; j < range.end; ++j) {
    Store(Load(step[j]) + way * Load(direction[j]), step[j]);
    const Four r = Load(residual[j]) - way * Load(product[j]);
    Store(r, residual[j]);
    of_residual += weight[j] * Widened(r * r);
    const SingleBlock& a = inverse[j];
    const Four s = (r[0] * Load(a.x) + r[1] * Load(a.y)) + r[2] * Load(a.z);
    Store(s, scaled[j]);
    of_scaled += Widened(r * s);
  }
  return {Sum(of_residual), Sum(of_scaled)};
}

MESHLESS_CUTTING_CLONES void Restrict(const int* particles, int count, const SingleVector4* basis,
                                      const SingleVector4* r, SingleVector4* coarse) {
  Four s0 = {}, s1 = {}, s2 = {}, s3 = {};
  for (int i = 0; i < count; ++i) {
    const Four b = Load(basis[particles[i]]), v = Load(r[particles[i]]);
    s0 += b[0] * v;
    s1 += b[1] * v;
    s2 += b[2] * v;
    s3 += b[3] * v;
  }
  Store(s0, coarse[0]);
  Store(s1, coarse[1]);
  Store(s2, coarse[2]);
  Store(s3, coarse[3]);
}

MESHLESS_CUTTING_CLONES void NextDirection(const ParticleRange& range, double beta, const SingleVector4* scaled,
                                           const int* aggregate, const SingleVector4* basis,
                                           const SingleVector4* coarse, SingleVector4* direction) {
  const auto share = static_cast<float>(beta);
  for (int j = range.begin; j < range.end; ++j) {
    Four z = Load(scaled[j]);
    if (aggregate[j] >= 0) {
      const Four b = Load(basis[j]);
      const SingleVector4* u = coarse + CoarseMatrix::kFunctions * aggregate[j];
      z += (b[0] * Load(u[0]) + b[1] * Load(u[1])) + (b[2] * Load(u[2]) + b[3] * Load(u[3]));
    }
    Store(z + share * Load(direction[j]), direction[j]);
  }
}

}  // namespace meshless_cutting
