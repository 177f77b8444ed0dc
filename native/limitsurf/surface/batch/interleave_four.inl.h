// SPDX-License-Identifier: Apache-2.0
//
// Vectors of four rows, from lanes to the order of memory. To be included as lanes.inl.h is, after
// it, where 256-bit instructions are there.

/// x0 y0 z0 x1 y1 z1 ... from x0 x1 ..., y0 y1 ..., z0 z1 ...
inline void interleave(const Lanes<4> xyz[3], Lanes<4> out[3]) {
  const auto &x = xyz[0].numbers, &y = xyz[1].numbers, &z = xyz[2].numbers;
  out[0].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 4, 0, 1), z, 0, 1, 4, 3);
  out[1].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 5, 0, 2, 6), z, 0, 5, 2, 3);
  out[2].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 3, 7, 0), z, 6, 1, 2, 7);
}
/// x0 y0 z0 _ x1 y1 z1 _ ...
inline void interleavePadded(const Lanes<4> xyz[3], Lanes<4> out[4]) {
  const auto &x = xyz[0].numbers, &y = xyz[1].numbers, &z = xyz[2].numbers;
  out[0].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 0, 4, 0, 0), z, 0, 1, 4, 3);
  out[1].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 1, 5, 0, 0), z, 0, 1, 5, 3);
  out[2].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 2, 6, 0, 0), z, 0, 1, 6, 3);
  out[3].numbers =
      __builtin_shufflevector(__builtin_shufflevector(x, y, 3, 7, 0, 0), z, 0, 1, 7, 3);
}
