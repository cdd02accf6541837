// Counts what goes through operator new. Include in one file of a test program only: it replaces the global operators.
#pragma once

#include <atomic>
#include <cstdlib>
#include <new>

namespace meshless_cutting {

inline std::atomic<long>& AllocationCount() {
  static std::atomic<long> count{0};
  return count;
}

}  // namespace meshless_cutting

void* operator new(std::size_t size) {
  ++meshless_cutting::AllocationCount();
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++meshless_cutting::AllocationCount();
  const std::size_t a = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(a, (size + a - 1) / a * a)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
