// SPDX-License-Identifier: Apache-2.0
//
// What follows is compiled for AVX-512, until target_end.inl.h is included.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq,avx512vl"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#endif
