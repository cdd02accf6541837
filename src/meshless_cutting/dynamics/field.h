// One vector per particle, as the loops of the solver want it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <new>
#include <vector>

namespace meshless_cutting {

/// Three components and one that is always zero, so that a particle is one aligned load.
struct alignas(32) Vector4 {
  double x = 0, y = 0, z = 0, w = 0;

  Eigen::Vector3d vector() const { return {x, y, z}; }
  static Vector4 From(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z(), 0}; }

  Vector4& operator+=(const Vector4& b) { return *this = *this + b; }
  friend Vector4 operator+(const Vector4& a, const Vector4& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
  }
  friend Vector4 operator-(const Vector4& a, const Vector4& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
  }
  friend Vector4 operator*(double s, const Vector4& a) { return {s * a.x, s * a.y, s * a.z, s * a.w}; }
  friend Vector4 Multiply(const Vector4& a, const Vector4& b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }
  friend double Sum(const Vector4& a) { return (a.x + a.y) + (a.z + a.w); }
  friend double Dot(const Vector4& a, const Vector4& b) { return Sum(Multiply(a, b)); }
};

/// Begins arrays at a cache line, so that no load of a whole vector register straddles two.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
  void deallocate(T* data, std::size_t) { ::operator delete(data, kAlignment); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
  friend bool operator!=(const CacheLineAllocator&, const CacheLineAllocator&) { return false; }
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

using Field = AlignedVector<Vector4>;

/// Particles that one task of a parallel loop takes. Fixed, so that sums do not depend on the number of threads.
constexpr int kParticlesPerChunk = 256;

inline int ChunkCount(int count, int per_chunk) { return (count + per_chunk - 1) / per_chunk; }

}  // namespace meshless_cutting
