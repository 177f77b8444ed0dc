// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/cages/strange_meshes.h"
#include "support/random.h"

namespace limitsurf::test {

/// Small cages with everything that makes a surface hard to search: creases of all kinds, darts,
/// corners, boundaries, extraordinary vertices of valence 2 to 100, polygons, pinned sectors, holes
/// and refused faces, sheets that meet, the bilinear scheme, planes.
NamedCages queryCages();

/// Every n-th of some cages, for tests that are repeated with all of them among the slow ones.
NamedCages everyNth(const NamedCages& cages, std::size_t n);

/// The query cages that have no boundaries.
NamedCages closedCages();

/// Degenerate cages: points, lines, faces without area.
NamedCages degenerateCages();

/// `count` locations on faces that have a surface: anywhere, on sides, at corners and within 2^-5
/// to 2^-40 of these.
std::vector<Location> searchedLocations(const LimitSurface& surface, int count, Random& random);

}  // namespace limitsurf::test
