// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/part_kernels.h"

#include <cstdint>

#include "limitsurf/surface/batch/instruction_sets.h"

#if LIMITSURF_X86_SETS
#include <immintrin.h>
#endif

namespace limitsurf {

#if LIMITSURF_X86_SETS

namespace {

#include "limitsurf/surface/batch/target_avx512.inl.h"
namespace avx512 {

constexpr unsigned kLanes = 8;

/// A bit for each row from `begin` on that there is.
inline __mmask8 rowsFrom(const TileRows& rows, unsigned begin) {
  const unsigned left = rows.count - begin;
  return static_cast<__mmask8>(left < kLanes ? (1u << left) - 1 : 0xffu);
}

/// The parts of up to kLanes rows.
struct Parts {
  __mmask8 rows[PartKernels::kParts];

  Parts(__m512d u, __m512d v, __m512d bound, __mmask8 all) {
    const unsigned right = _mm512_mask_cmp_pd_mask(all, u, bound, _CMP_GE_OQ),
                   top = _mm512_mask_cmp_pd_mask(all, v, bound, _CMP_GE_OQ);
    rows[0] = static_cast<__mmask8>(all & ~(right | top));
    rows[1] = static_cast<__mmask8>(right & ~top);
    rows[2] = static_cast<__mmask8>(top & ~right);
    rows[3] = static_cast<__mmask8>(right & top);
  }
};

inline unsigned sizeOf(__mmask8 rows) {
  return static_cast<unsigned>(__builtin_popcount(static_cast<unsigned>(rows)));
}

void count(const TileRows& rows, double bound, unsigned counts[PartKernels::kParts]) {
  const __m512d bounds = _mm512_set1_pd(bound);
  unsigned right_or_top[2] = {0, 0}, both = 0;
  for (unsigned i = 0; i < rows.count; i += kLanes) {
    const Parts parts(_mm512_loadu_pd(rows.u + i), _mm512_loadu_pd(rows.v + i), bounds,
                      rowsFrom(rows, i));
    right_or_top[0] += sizeOf(parts.rows[1]);
    right_or_top[1] += sizeOf(parts.rows[2]);
    both += sizeOf(parts.rows[3]);
  }
  counts[0] = rows.count - right_or_top[0] - right_or_top[1] - both;
  counts[1] = right_or_top[0];
  counts[2] = right_or_top[1];
  counts[3] = both;
}

template <bool kByChild>
inline void sortRows(const TileRows& rows, double bound, unsigned next[PartKernels::kParts],
                     const TileRows& to) {
  static_assert(sizeof(std::size_t) == sizeof(std::int64_t));
  const __m512d bounds = _mm512_set1_pd(bound), one = _mm512_set1_pd(1);
  for (unsigned i = 0; i < rows.count; i += kLanes) {
    const __mmask8 all = rowsFrom(rows, i);
    __m512d u = _mm512_loadu_pd(rows.u + i), v = _mm512_loadu_pd(rows.v + i);
    const __m512i numbers = _mm512_maskz_loadu_epi64(all, rows.rows + i);
    const Parts parts(u, v, bounds, all);
    if (kByChild) {
      const auto right = static_cast<__mmask8>(parts.rows[1] | parts.rows[3]);
      const auto top = static_cast<__mmask8>(parts.rows[2] | parts.rows[3]);
      u = _mm512_mask_sub_pd(u, right, one, u);
      v = _mm512_mask_sub_pd(v, top, one, v);
      u = _mm512_add_pd(u, u);
      v = _mm512_add_pd(v, v);
    }
#pragma GCC unroll 4
    for (unsigned part = 0; part < PartKernels::kParts; ++part) {
      const bool is_turned = kByChild && (part == 1 || part == 2);
      const __mmask8 here = parts.rows[part];
      const unsigned size = sizeOf(here), at = next[part];
      const auto first = static_cast<__mmask8>((1u << size) - 1);
      _mm512_mask_storeu_pd(to.u + at, first, _mm512_maskz_compress_pd(here, is_turned ? v : u));
      _mm512_mask_storeu_pd(to.v + at, first, _mm512_maskz_compress_pd(here, is_turned ? u : v));
      _mm512_mask_storeu_epi64(to.rows + at, first, _mm512_maskz_compress_epi64(here, numbers));
      next[part] = at + size;
    }
  }
}

void sort(const TileRows& rows, double bound, unsigned next[PartKernels::kParts],
          const TileRows& to) {
  sortRows<false>(rows, bound, next, to);
}

void sortByChild(const TileRows& rows, unsigned next[PartKernels::kParts], const TileRows& to) {
  sortRows<true>(rows, 0.5, next, to);
}

constexpr PartKernels kKernels = {&count, &sort, &sortByChild};

}  // namespace avx512
#include "limitsurf/surface/batch/target_end.inl.h"

}  // namespace

const PartKernels* PartKernels::get() {
  return instructionSet() == InstructionSet::avx512 ? &avx512::kKernels : nullptr;
}

#else

const PartKernels* PartKernels::get() { return nullptr; }

#endif

}  // namespace limitsurf
