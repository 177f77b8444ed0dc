// SPDX-License-Identifier: Apache-2.0
//
// What follows is compiled for AVX2, until target_end.inl.h is included.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
