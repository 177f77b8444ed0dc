// SPDX-License-Identifier: Apache-2.0
//
// Ends target_avx2.inl.h or target_avx512.inl.h.
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
