#include "dynamics/field_loops.h"

#include "dynamics/instruction_sets.h"

namespace meshless_cutting {

MESHLESS_CUTTING_CLONES void GatherSlots(const ParticleRange& range, const Vector4* buffer, const int* slot_begin,
                                         const int* slots, double factor, Vector4* to) {
  for (int j = range.begin; j < range.end; ++j) {
    Vector4 sum;
    for (int n = slot_begin[j]; n < slot_begin[j + 1]; ++n) sum += buffer[slots[n]];
    to[j - range.begin] += factor * sum;
  }
}

MESHLESS_CUTTING_CLONES double GatherProduct(const ParticleRange& range, const SlotSums& sums, double factor,
                                             const double* free, const double* inertia, const Vector4* p, Vector4* q) {
  Vector4 dot;
  for (int j = range.begin; j < range.end; ++j) {
    Vector4 sum;
    for (int n = sums.slot_begin[j]; n < sums.slot_begin[j + 1]; ++n) sum += sums.buffer[sums.slots[n]];
    q[j] = free[j] * (inertia[j] * p[j] + factor * sum);
    dot += Multiply(p[j], q[j]);
  }
  return Sum(dot);
}

MESHLESS_CUTTING_CLONES GradientSums GatherGradient(const ParticleRange& range, const SlotSums& sums,
                                                    const double* free, const double* inertia, const double* weight,
                                                    const Vector4* y, const Vector4* target, Vector4* gradient) {
  Vector4 inertia_sum, residual, terms;
  for (int j = range.begin; j < range.end; ++j) {
    Vector4 sum;
    for (int n = sums.slot_begin[j]; n < sums.slot_begin[j + 1]; ++n) sum += sums.buffer[sums.slots[n]];
    const Vector4 way = y[j] - target[j], term = free[j] * (gradient[j] + sum);
    const Vector4 pull = (free[j] * inertia[j]) * way, total = term + pull;
    gradient[j] = total;
    inertia_sum += Multiply(pull, way);
    residual += weight[j] * Multiply(total, total);
    terms += weight[j] * Multiply(term, term);
  }
  return {Sum(inertia_sum), Sum(residual), Sum(terms)};
}

MESHLESS_CUTTING_CLONES double MaskAndDot(const ParticleRange& range, const double* mask, const Vector4* p,
                                          Vector4* q) {
  Vector4 sum;
  for (int j = range.begin; j < range.end; ++j) {
    q[j] = mask[j] * q[j];
    sum += Multiply(p[j], q[j]);
  }
  return Sum(sum);
}

MESHLESS_CUTTING_CLONES double AdvanceSolution(const ParticleRange& range, double alpha, const Vector4* direction,
                                               const Vector4* product, const double* weight, Vector4* step,
                                               Vector4* residual) {
  Vector4 sum;
  for (int j = range.begin; j < range.end; ++j) {
    step[j] += alpha * direction[j];
    const Vector4 r = residual[j] - alpha * product[j];
    residual[j] = r;
    sum += weight[j] * Multiply(r, r);
  }
  return Sum(sum);
}

MESHLESS_CUTTING_CLONES void NextDirection(const ParticleRange& range, double beta, const Vector4* scaled,
                                           Vector4* direction) {
  for (int j = range.begin; j < range.end; ++j) direction[j] = scaled[j] + beta * direction[j];
}

MESHLESS_CUTTING_CLONES void Restrict(const int* particles, int count, const Vector4* basis, const Vector4* r,
                                      double* coarse) {
  Vector4 s0, s1, s2, s3;
  for (int i = 0; i < count; ++i) {
    const Vector4 &b = basis[particles[i]], &v = r[particles[i]];
    s0 += b.x * v;
    s1 += b.y * v;
    s2 += b.z * v;
    s3 += b.w * v;
  }
  const Vector4 sums[4] = {s0, s1, s2, s3};
  for (int c = 0; c < 4; ++c) {
    coarse[3 * c] = sums[c].x;
    coarse[3 * c + 1] = sums[c].y;
    coarse[3 * c + 2] = sums[c].z;
  }
}

MESHLESS_CUTTING_CLONES double ScaleAndProlong(const ParticleRange& range, const SymmetricBlock* inverse,
                                               const int* aggregate, const Vector4* basis, const double* coarse,
                                               const Vector4* r, Vector4* z) {
  Vector4 sum;
  for (int j = range.begin; j < range.end; ++j) {
    const SymmetricBlock& a = inverse[j];
    const Vector4 &v = r[j], &b = basis[j];
    const Vector4 local =
        (v.x * Vector4{a.xx, a.xy, a.xz, 0} + v.y * Vector4{a.xy, a.yy, a.yz, 0}) + v.z * Vector4{a.xz, a.yz, a.zz, 0};
    if (aggregate[j] < 0) {
      z[j] = local;
      sum += Multiply(v, local);
      continue;
    }
    const double* u = coarse + CoarseMatrix::kUnknowns * aggregate[j];
    const Vector4 affine = (b.x * Vector4{u[0], u[1], u[2], 0} + b.y * Vector4{u[3], u[4], u[5], 0}) +
                           (b.z * Vector4{u[6], u[7], u[8], 0} + b.w * Vector4{u[9], u[10], u[11], 0});
    z[j] = local + affine;
    sum += Multiply(v, z[j]);
  }
  return Sum(sum);
}

}  // namespace meshless_cutting
