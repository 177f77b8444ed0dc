// SPDX-License-Identifier: Apache-2.0
//
// The inputs that the fuzzers start from, and what they found: every build runs them, with whatever
// compiler and sanitizer it has.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "fuzz/require.h"
#include "fuzz/targets.h"

namespace limitsurf::test {
namespace {

using Target = void (*)(const std::uint8_t*, std::size_t);

std::vector<std::uint8_t> bytesOf(const std::string& digits) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

void replay(const std::string& name, Target target) {
  std::ifstream file(LIMITSURF_FUZZ_CORPUS "/" + name + ".hex");
  std::string line;
  int inputs = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') {
      continue;
    }
    const std::vector<std::uint8_t> bytes = bytesOf(line);
    ASSERT_EQ(2 * bytes.size(), line.size()) << line;
    try {
      target(bytes.data(), bytes.size());
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << ": " << line;
    }
    ++inputs;
  }
  EXPECT_GE(inputs, 30) << "the corpus of " << name << " is missing";
}

TEST(FuzzCorpus, Meshes) { replay("mesh", fuzz::meshTarget); }
TEST(FuzzCorpus, Queries) { replay("query", fuzz::queryTarget); }
TEST(FuzzCorpus, Maps) { replay("map", fuzz::mapTarget); }

TEST(FuzzCorpus, APropertyThatDoesNotHoldIsNoticed) {
  EXPECT_THROW(fuzz::require(false, "nothing"), fuzz::Broken);
  EXPECT_FALSE(fuzz::accepts([] { throw std::invalid_argument("a reason"); }));
  EXPECT_THROW(fuzz::accepts([] { throw std::runtime_error("no documented error"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace limitsurf::test
