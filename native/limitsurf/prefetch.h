// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#if defined(_MSC_VER) && (defined(_M_X64) || defined(_M_IX86))
#include <xmmintrin.h>
#endif

namespace limitsurf {

/// Has the processor bring an object into its caches, because it is going to be read soon. It
/// changes no result, and does nothing where the compiler knows no way.
template <typename T>
void prefetch(const T& object) {
  constexpr std::size_t kCacheLine = 64, kSize = sizeof(T);
  const char* const begin = reinterpret_cast<const char*>(&object);
  for (std::size_t at = 0; at < kSize; at += kCacheLine) {
#if defined(__GNUC__)
    __builtin_prefetch(begin + at);
#elif defined(_MSC_VER) && (defined(_M_X64) || defined(_M_IX86))
    _mm_prefetch(begin + at, _MM_HINT_T0);
#else
    (void)begin;
#endif
  }
}

}  // namespace limitsurf
