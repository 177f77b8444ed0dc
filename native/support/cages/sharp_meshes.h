// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "support/cages/cage.h"
#include "support/random.h"

namespace limitsurf::test {

/// Every edge once.
std::vector<std::pair<int, int>> edgesOf(const Cage& cage);

void sharpenEdge(Cage& cage, int a, int b, double sharpness);
void sharpenVertex(Cage& cage, int vertex, double sharpness);

/// One edge in `edges_per_sharp` and one vertex in `vertices_per_sharp` made sharp, by values drawn
/// from the list.
void sharpenAtRandom(Cage& cage, Random& random, int edges_per_sharp, int vertices_per_sharp,
                     const std::vector<double>& values);

}  // namespace limitsurf::test
