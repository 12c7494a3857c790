// Requests memory before it is needed. Affects nothing but run time.
#pragma once

#include <cstddef>

namespace needlework {

/// Prefetches the cache lines of an object.
template <class T>
void prefetch([[maybe_unused]] const T* object) {
#ifdef __GNUC__
  constexpr std::size_t line = 64;
  const char* bytes = reinterpret_cast<const char*>(object);
  for (std::size_t at = 0; at < sizeof(T); at += line) __builtin_prefetch(bytes + at);
  // GCC leaves out calls of functions that do nothing else: it takes them for pure.
  asm volatile("");
#endif
}

}  // namespace needlework
