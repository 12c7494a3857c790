// Arrays with an entry for each needle, in huge pages if possible.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace needlework {

/// Requests huge pages for arrays that fill at least one. Events access needles in random order,
/// and with 4 KiB pages each access would need another address translation. Where huge pages are
/// missing or forbidden, arrays use normal pages.
template <class T>
struct LargePages {
  using value_type = T;

  static constexpr std::size_t page = std::size_t{1} << 21;

  LargePages() = default;
  template <class Other>
  LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(n));
#if defined(__linux__)
    if (bytes >= page) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) noexcept { ::operator delete(memory, alignment(n)); }

  template <class Other>
  bool operator==(const LargePages<Other>&) const {
    return true;
  }

 private:
  static std::align_val_t alignment(std::size_t n) {
    return std::align_val_t{n * sizeof(T) >= page ? page : alignof(T)};
  }
};

template <class T>
using LargeArray = std::vector<T, LargePages<T>>;

}  // namespace needlework
