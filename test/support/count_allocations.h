// Counts what goes through operator new. Include in one file of a test program only: it replaces the global operators.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace meshless_cutting {

inline std::atomic<long>& AllocationCount() {
  static std::atomic<long> count{0};
  return count;
}

/// Sum of the sizes that were asked for and not given back yet.
inline std::atomic<long>& LiveBytes() {
  static std::atomic<long> bytes{0};
  return bytes;
}

namespace counting {

/// The size of a block stands in front of it.
inline std::size_t HeaderOf(std::size_t alignment) { return std::max(alignment, alignof(std::max_align_t)); }

inline void* Allocate(std::size_t size, std::size_t alignment) {
  const std::size_t a = HeaderOf(alignment);
  char* memory = static_cast<char*>(std::aligned_alloc(a, (size + 2 * a - 1) / a * a));
  if (!memory) throw std::bad_alloc();
  *reinterpret_cast<std::size_t*>(memory) = size;
  ++AllocationCount();
  LiveBytes() += static_cast<long>(size);
  return memory + a;
}

inline void Free(void* block, std::size_t alignment) {
  if (!block) return;
  char* memory = static_cast<char*>(block) - HeaderOf(alignment);
  LiveBytes() -= static_cast<long>(*reinterpret_cast<std::size_t*>(memory));
  std::free(memory);
}

}  // namespace counting
}  // namespace meshless_cutting

void* operator new(std::size_t size) { return meshless_cutting::counting::Allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return meshless_cutting::counting::Allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return meshless_cutting::counting::Allocate(size, 1);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept { meshless_cutting::counting::Free(memory, 1); }
void operator delete(void* memory, std::size_t) noexcept { meshless_cutting::counting::Free(memory, 1); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { meshless_cutting::counting::Free(memory, 1); }
void operator delete(void* memory, std::align_val_t alignment) noexcept {
  meshless_cutting::counting::Free(memory, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory, std::size_t, std::align_val_t alignment) noexcept {
  meshless_cutting::counting::Free(memory, static_cast<std::size_t>(alignment));
}
