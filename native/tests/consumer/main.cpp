// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <vector>

#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"

int main() {
  // One square, its corners rounded: the boundary is a closed B-spline curve.
  limitsurf::Points positions(4, 3);
  positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  const limitsurf::ControlMesh cage(positions, {4}, {0, 1, 2, 3});
  const limitsurf::LimitSurface surface(cage);

  const std::vector<limitsurf::Location> at = {{0, 0.0, 0.0}, {0, 0.5, 0.5}};
  const limitsurf::Evaluation limit =
      surface.evaluate(at, limitsurf::Derivatives::first, /*normals=*/true);
  for (int i = 0; i < limit.position.rows(); ++i) {
    std::printf("(%g, %g): position %.6f %.6f %.6f, normal %g %g %g\n", at[i].u, at[i].v,
                limit.position(i, 0), limit.position(i, 1), limit.position(i, 2),
                limit.normal(i, 0), limit.normal(i, 1), limit.normal(i, 2));
  }

  const limitsurf::SurfaceSearch search(surface);
  limitsurf::Points above(1, 3);
  above << 0.5, 0.25, 2;
  const limitsurf::Hits near = search.closest(above);
  std::printf("closest: %.6f %.6f %.6f, distance %g\n", near.position(0, 0), near.position(0, 1),
              near.position(0, 2), near.distance[0]);
}
