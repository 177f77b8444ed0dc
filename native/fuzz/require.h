// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace limitsurf::fuzz {

/// A property that does not hold. No target catches it, so that a fuzzer ends with it.
struct Broken : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& property) {
  if (!holds) {
    throw Broken(property);
  }
}

/// Calls `run`. The errors that the library documents for wrong input are all right.
template <typename Run>
bool accepts(const Run& run) {
  try {
    run();
    return true;
  } catch (const std::invalid_argument& error) {
    require(error.what()[0] != 0, "an error has a message");
    require(std::string(error.what()).size() < 1000, "an error's message is short");
    return false;
  }
}

}  // namespace limitsurf::fuzz
