// SPDX-License-Identifier: Apache-2.0
//
// From lanes to the rows of a result. To be included as patch_kernels.inl.h is.

/// Puts x y z of each row, behind which there is a fourth number, where the row belongs.
template <int kCount, typename Real>
[[gnu::always_inline]] inline void putPadded(Real* to, const Lanes<kCount> padded[4],
                                             const std::size_t* rows, int count) {
  // With a fourth number in each row, no row is read from memory that two instructions have
  // written: processors do not read such a row until both have reached the cache.
  Real numbers[4 * kCount];
  for (int i = 0; i < 4; ++i) {
    padded[i].store(numbers + i * kCount);
  }
  for (int lane = 0; lane < count; ++lane) {
    __builtin_memcpy(to + 3 * rows[lane], numbers + 4 * lane, 3 * sizeof(Real));
  }
}

/// Where the results of up to kCount rows go.
template <int kCount>
struct RowPlaces {
  RowPlaces(const std::size_t* rows_, int count_)
      : rows(rows_),
        count(count_),
        contiguous(count_ == kCount && rows_[kCount - 1] - rows_[0] == kCount - 1) {}

  template <typename Real>
  [[gnu::always_inline]] void put(Real* to, const Lanes<kCount> vectors[3]) const {
    if (contiguous) {
      Lanes<kCount> interleaved[3];
      interleave(vectors, interleaved);
      for (int i = 0; i < 3; ++i) {
        interleaved[i].store(to + 3 * rows[0] + i * kCount);
      }
      return;
    }
    Lanes<kCount> padded[4];
    interleavePadded(vectors, padded);
    putPadded(to, padded, rows, count);
  }

  const std::size_t* rows;
  int count;
  bool contiguous;  ///< whether there are kCount rows that follow each other
};
