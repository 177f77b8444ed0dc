// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace limitsurf::test {

/// Expects `call` to throw an Error whose message holds every one of `parts`.
template <typename Error, typename Call>
void expectThrow(const Call& call, const std::vector<std::string>& parts) {
  try {
    call();
  } catch (const Error& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << "\"" << error.what() << "\" does not name \"" << part << "\"";
    }
    return;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "threw another exception: " << error.what();
    return;
  }
  ADD_FAILURE() << "threw nothing";
}

}  // namespace limitsurf::test
