// One vector per particle, as the loops of the solver want it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <new>
#include <vector>

namespace meshless_cutting {

/// Three components and one that is always zero, so that a particle is one aligned load.
template <class Number>
struct alignas(4 * sizeof(Number)) BasicVector4 {
  Number x = 0, y = 0, z = 0, w = 0;

  Eigen::Vector3d vector() const { return {x, y, z}; }
  static BasicVector4 From(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z(), 0}; }

  BasicVector4& operator+=(const BasicVector4& b) { return *this = *this + b; }
  friend BasicVector4 operator+(const BasicVector4& a, const BasicVector4& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
  }
  friend BasicVector4 operator-(const BasicVector4& a, const BasicVector4& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
  }
  friend BasicVector4 operator*(Number s, const BasicVector4& a) { return {s * a.x, s * a.y, s * a.z, s * a.w}; }
  friend BasicVector4 Multiply(const BasicVector4& a, const BasicVector4& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w};
  }
  friend Number Sum(const BasicVector4& a) { return (a.x + a.y) + (a.z + a.w); }
  friend Number Dot(const BasicVector4& a, const BasicVector4& b) { return Sum(Multiply(a, b)); }
};
using Vector4 = BasicVector4<double>;
/// Of the linear solver: it gains one digit at a time, and Newton's method corrects what it rounds.
using SingleVector4 = BasicVector4<float>;

inline Vector4 Widen(const SingleVector4& a) { return {a.x, a.y, a.z, a.w}; }
inline SingleVector4 Round(const Vector4& a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z), static_cast<float>(a.w)};
}

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
using SingleField = AlignedVector<SingleVector4>;

/// Sizes an array that cuts make longer. There is room for twice as much, made while the object is loaded: to double all arrays
/// in the frame of the first cut took 25 ms for 10,000 particles.
template <class T, class Allocator>
void ResizeWithRoom(std::vector<T, Allocator>& array, std::size_t size) {
  if (size > array.capacity()) array.reserve(2 * size);
  array.resize(size);
}

/// Particles that one task of a parallel loop takes. Fixed, so that sums do not depend on the number of threads.
constexpr int kParticlesPerChunk = 256;

inline int ChunkCount(int count, int per_chunk) { return (count + per_chunk - 1) / per_chunk; }

}  // namespace meshless_cutting
