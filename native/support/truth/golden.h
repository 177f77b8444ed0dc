// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "support/cages/cage.h"

namespace limitsurf::test {

enum Quantity { kPosition, kDu, kDv, kDuu, kDuv, kDvv, kNormal, kQuantities };
constexpr const char* kQuantityNames[kQuantities] = {"position", "du",  "dv",    "duu",
                                                     "duv",      "dvv", "normal"};

/// True values of a limit surface, read from data/golden (its README.md describes the format).
struct Golden {
  std::string name;
  Cage cage;
  std::vector<Location> at;
  std::array<Points, kQuantities> values;  ///< NaN where a value is missing

  bool hasSharpness() const {
    return !cage.options.edge_sharpness.values.empty() ||
           !cage.options.vertex_sharpness.values.empty();
  }
};

std::vector<std::string> goldenNames();
Golden readGolden(const std::string& name);

}  // namespace limitsurf::test
