// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/cages/strange_meshes.h"

namespace limitsurf::test {

/// Half a pole: triangles around the vertex 0, which is on the boundary.
Cage openFan(int triangles);

/// A cage in the plane z = 0.
Cage flattened(Cage cage);

/// Cages with many faces around the vertex 0, which is corner 0 of face 0: regular and crooked
/// ones, closed and open ones, cones and a plane.
NamedCages poles();

}  // namespace limitsurf::test
