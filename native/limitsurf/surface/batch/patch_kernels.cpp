// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/patch_kernels.h"

#include <atomic>
#include <cmath>
#include <cstddef>

#include "limitsurf/eigen/derivative_nets.h"

#if LIMITSURF_X86_SETS
#include <immintrin.h>
#endif

namespace limitsurf {
namespace {

namespace baseline {
#include "limitsurf/surface/batch/lanes.inl.h"
/// Two vectors. Compilers would keep one that is larger than a register in memory.
template <>
struct Lanes<4> {
  struct Numbers {
    Lanes<2> low, high;
    double operator[](int i) const { return i < 2 ? low.numbers[i] : high.numbers[i - 2]; }
  } numbers;

  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return {{a.numbers.low + b.numbers.low, a.numbers.high + b.numbers.high}};
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return {{a.numbers.low - b.numbers.low, a.numbers.high - b.numbers.high}};
  }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return {{a.numbers.low * b.numbers.low, a.numbers.high * b.numbers.high}};
  }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, double b) { return a * of(b); }
  [[gnu::always_inline]] friend Lanes operator*(double a, const Lanes& b) { return of(a) * b; }
  [[gnu::always_inline]] static Lanes of(double a) { return {{Lanes<2>::of(a), Lanes<2>::of(a)}}; }
  [[gnu::always_inline]] static Lanes load(const double* from) {
    return {{Lanes<2>::load(from), Lanes<2>::load(from + 2)}};
  }
  [[gnu::always_inline]] void store(double* to) const {
    numbers.low.store(to);
    numbers.high.store(to + 2);
  }
};
constexpr int kLanes = 2, kFewLanes = 2;
constexpr std::size_t kFewestLanes = 2;
inline double squareRoot(double a) { return __builtin_sqrt(a); }
inline Lanes<kLanes> squareRoot(const Lanes<kLanes>& a) {
  Lanes<kLanes> result = a;
  for (int i = 0; i < kLanes; ++i) {
    result.numbers[i] = std::sqrt(a.numbers[i]);
  }
  return result;
}
inline Lanes<2> pairOf(double a, double b) {
  const double both[2] = {a, b};
  return Lanes<2>::load(both);
}
inline void interleave(const Lanes<2> xyz[3], Lanes<2> out[3]) {
  const auto &x = xyz[0].numbers, &y = xyz[1].numbers, &z = xyz[2].numbers;
  out[0] = pairOf(x[0], y[0]);
  out[1] = pairOf(z[0], x[1]);
  out[2] = pairOf(y[1], z[1]);
}
inline void interleavePadded(const Lanes<2> xyz[3], Lanes<2> out[4]) {
  const auto &x = xyz[0].numbers, &y = xyz[1].numbers, &z = xyz[2].numbers;
  for (int row = 0; row < 2; ++row) {
    out[2 * row] = pairOf(x[row], y[row]);
    out[2 * row + 1] = pairOf(z[row], 0);
  }
}
[[gnu::always_inline]] inline void storeThree(double* to, const Lanes<4>& point) {
  Lanes<2>{{point.numbers[0], point.numbers[1]}}.store(to);
  to[2] = point.numbers[2];
}
#include "limitsurf/surface/batch/patch_kernels.inl.h"
}  // namespace baseline

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx2.inl.h"
namespace avx2 {
#include "limitsurf/surface/batch/lanes.inl.h"
constexpr int kLanes = 4, kFewLanes = 4;
constexpr std::size_t kFewestLanes = 3;
inline double squareRoot(double a) { return __builtin_sqrt(a); }
inline Lanes<4> squareRoot(const Lanes<4>& a) { return {_mm256_sqrt_pd(a.numbers)}; }
#include "limitsurf/surface/batch/interleave_four.inl.h"
[[gnu::always_inline]] inline void storeThree(double* to, const Lanes<4>& point) {
  Lanes<2>{{point.numbers[0], point.numbers[1]}}.store(to);
  to[2] = point.numbers[2];
}
#include "limitsurf/surface/batch/patch_kernels.inl.h"
}  // namespace avx2
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

#if LIMITSURF_X86_SETS
#include "limitsurf/surface/batch/target_avx512.inl.h"
namespace avx512 {
#include "limitsurf/surface/batch/lanes.inl.h"
constexpr int kLanes = 8, kFewLanes = 4;
constexpr std::size_t kFewestLanes = 3;
inline double squareRoot(double a) { return __builtin_sqrt(a); }
inline Lanes<4> squareRoot(const Lanes<4>& a) { return {_mm256_sqrt_pd(a.numbers)}; }
inline Lanes<8> squareRoot(const Lanes<8>& a) { return {_mm512_maskz_sqrt_pd(0xff, a.numbers)}; }
#include "limitsurf/surface/batch/interleave_four.inl.h"
/// x0 y0 z0 x1 y1 z1 ... from x0 x1 ..., y0 y1 ..., z0 z1 ...
inline void interleave(const Lanes<8> xyz[3], Lanes<8> out[3]) {
  const auto &x = xyz[0].numbers, &y = xyz[1].numbers, &z = xyz[2].numbers;
  out[0].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 8, 0, 1, 9, 0, 2, 10),
                                           z, 0, 1, 8, 3, 4, 9, 6, 7);
  out[1].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 3, 11, 0, 4, 12, 0, 5),
                                           z, 10, 1, 2, 11, 4, 5, 12, 7);
  out[2].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 13, 0, 6, 14, 0, 7, 15, 0),
                                           z, 0, 13, 2, 3, 14, 5, 6, 15);
}
/// x0 y0 z0 _ x1 y1 z1 _ ...
inline void interleavePadded(const Lanes<8> xyz[3], Lanes<8> out[4]) {
  const auto &x = xyz[0].numbers, &y = xyz[1].numbers, &z = xyz[2].numbers;
  out[0].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 8, 0, 0, 1, 9, 0, 0), z,
                                           0, 1, 8, 3, 4, 5, 9, 7);
  out[1].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 2, 10, 0, 0, 3, 11, 0, 0),
                                           z, 0, 1, 10, 3, 4, 5, 11, 7);
  out[2].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 4, 12, 0, 0, 5, 13, 0, 0),
                                           z, 0, 1, 12, 3, 4, 5, 13, 7);
  out[3].numbers = __builtin_shufflevector(__builtin_shufflevector(x, y, 6, 14, 0, 0, 7, 15, 0, 0),
                                           z, 0, 1, 14, 3, 4, 5, 15, 7);
}
/// Writes three of four numbers by one instruction, which touches no memory behind them.
[[gnu::always_inline]] inline void storeThree(double* to, __m256d numbers) {
  // GCC would join the extraction of half a register with the masked write: VEXTRACTF64X4, which
  // faults if there is no memory behind the three numbers, although it does not write there. So the
  // half is in a register of its own here.
  __asm__("" : "+v"(numbers));
  _mm256_mask_storeu_pd(to, 7, numbers);
}
[[gnu::always_inline]] inline void storeThree(double* to, const Lanes<4>& point) {
  storeThree(to, point.numbers);
}
[[gnu::always_inline]] inline void putPadded(double* to, const Lanes<8> padded[4],
                                             const std::size_t* rows, int count) {
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    const auto& two = padded[i].numbers;
    if (2 * i < count) {
      storeThree(to + 3 * rows[2 * i], __builtin_shufflevector(two, two, 0, 1, 2, 3));
    }
    if (2 * i + 1 < count) {
      storeThree(to + 3 * rows[2 * i + 1], __builtin_shufflevector(two, two, 4, 5, 6, 7));
    }
  }
}
[[gnu::always_inline]] inline void putPadded(double* to, const Lanes<4> padded[4],
                                             const std::size_t* rows, int count) {
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    if (i < count) {
      storeThree(to + 3 * rows[i], padded[i]);
    }
  }
}
#include "limitsurf/surface/batch/patch_kernels.inl.h"
}  // namespace avx512
#include "limitsurf/surface/batch/target_end.inl.h"
#endif

InstructionSet bestSet() {
  return isAvailable(InstructionSet::avx512) ? InstructionSet::avx512
         : isAvailable(InstructionSet::avx2) ? InstructionSet::avx2
                                             : InstructionSet::baseline;
}

std::atomic<InstructionSet>& setInUse() {
  static std::atomic<InstructionSet> set{bestSet()};
  return set;
}

}  // namespace

bool isAvailable(InstructionSet set) {
  if (set == InstructionSet::baseline) {
    return true;
  }
#if LIMITSURF_X86_SETS
  __builtin_cpu_init();
  return set == InstructionSet::avx2
             ? __builtin_cpu_supports("avx2")
             : __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

InstructionSet instructionSet() { return setInUse().load(std::memory_order_relaxed); }

void useInstructionSet(InstructionSet set) { setInUse() = set; }

const PatchKernels& PatchKernels::get() {
#if LIMITSURF_X86_SETS
  return inUse(&baseline::kKernels, &avx2::kKernels, &avx512::kKernels);
#else
  return baseline::kKernels;
#endif
}

}  // namespace limitsurf
