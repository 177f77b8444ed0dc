// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <vector>

#include "limitsurf/surface/limit_surface.h"

int main() {
  limitsurf::Points square(4, 3);  // one face, whose corners are rounded
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  const limitsurf::LimitSurface surface(limitsurf::ControlMesh(square, {4}, {0, 1, 2, 3}));
  const std::vector<limitsurf::Location> at = {{0, 0.0, 0.0}};  // face 0, u = v = 0
  const limitsurf::Evaluation limit = surface.evaluate(at);
  std::printf("%.6f %.6f\n", limit.position(0, 0), limit.position(0, 1));  // 0.166667 0.166667
}
