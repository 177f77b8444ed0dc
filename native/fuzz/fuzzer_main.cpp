// SPDX-License-Identifier: Apache-2.0
//
// What libFuzzer calls; compiled once for each function of targets.h.
#include "fuzz/targets.h"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(
    const std::uint8_t* data, std::size_t size) {
  limitsurf::fuzz::LIMITSURF_FUZZ_TARGET(data, size);
  return 0;
}
