// Arrays of millions of entries, in huge pages where the system grants them: scattered accesses
// then cause far fewer TLB misses.
//
// Example:
//
//   LargeArray<float> values;
//   values.resize(1'000'000);  // uninitialised
//   for (float& value : values) value = 1;
//   LargeVector<float> zeros(1'000'000);  // a std::vector
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace broadmark {

/// A deleter for std::unique_ptr of memory from allocateLarge().
struct FreeMemory {
  void operator()(void* memory) const { std::free(memory); }
};

/// Allocates `bytes` uninitialised bytes, to be released by std::free(). From 2 MiB on, the size of
/// a huge page, they are in huge pages, if possible, and aligned to one; otherwise aligned to
/// `alignment`, a power of two. The size is rounded up to a multiple of the alignment. Throws
/// std::bad_alloc.
inline void* allocateLarge(std::size_t bytes, std::size_t alignment = 64) {
  constexpr std::size_t kHugePage = std::size_t{1} << 21;
  if (bytes >= kHugePage) alignment = kHugePage;
  bytes = (bytes + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, bytes);
  if (memory == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
  if (bytes >= kHugePage) {
    // Reused memory may consist of small pages: releases them, if possible.
    ::madvise(memory, bytes, MADV_DONTNEED);
    ::madvise(memory, bytes, MADV_HUGEPAGE);
  }
#endif
  return memory;
}

/// An allocator for standard containers, with huge pages for large ones. Aligns to 64 bytes.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  explicit(false) LargeAllocator(const LargeAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(allocateLarge(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  bool operator==(const LargeAllocator&) const = default;
};
/// A std::vector in huge pages; unlike a LargeArray, it initialises its entries.
template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

/// A growing array of uninitialised entries, aligned to 64 bytes. Retains its memory when it
/// shrinks. Movable, not copyable; one moved from may only be destroyed or assigned to.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// New entries are uninitialised; existing entries are kept. Amortised O(1) per new entry; growth
  /// beyond the capacity invalidates pointers. Throws std::bad_alloc, which changes nothing.
  void resize(std::size_t size) {
    if (size > capacity_) {
      // Grow geometrically, so that repeated small growth rarely reallocates.
      const std::size_t capacity = size + size / 8 + 64;
      // NOLINTNEXTLINE(bugprone-sizeof-expression): T may be a pointer
      std::unique_ptr<T[], FreeMemory> bigger(static_cast<T*>(allocateLarge(capacity * sizeof(T))));
      for (std::size_t i = 0; i < size_; ++i) bigger[i] = memory_[i];
      memory_ = std::move(bigger);
      capacity_ = capacity;
    }
    size_ = size;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  T* data() { return memory_.get(); }
  [[nodiscard]] const T* data() const { return memory_.get(); }
  T& operator[](std::size_t i) { return memory_[i]; }
  const T& operator[](std::size_t i) const { return memory_[i]; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }

 private:
  std::unique_ptr<T[], FreeMemory> memory_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace broadmark
