// SPDX-License-Identifier: Apache-2.0
#include "support/truth/spline_grid.h"

#include <algorithm>

namespace limitsurf::test {
namespace {

/// Values of the four uniform cubic B-splines at t, or their first or second derivatives.
std::array<Real, 4> splines(const Real& t, int derivative) {
  const Real s = 1 - t;
  switch (derivative) {
    case 0:
      return {s * s * s / 6, (t * t * (3 * t - 6) + 4) / 6, (s * s * (3 * s - 6) + 4) / 6,
              t * t * t / 6};
    case 1:
      return {-s * s / 2, t * (3 * t - 4) / 2, -s * (3 * s - 4) / 2, t * t / 2};
    default:
      return {s, 3 * t - 2, 1 - 3 * t, t};
  }
}

/// The face that has the directed edge, its vertices rotated to begin with it.
std::vector<int> faceFrom(const LocalMesh& mesh, int a, int b) {
  std::vector<int> face = mesh.faces.at(mesh.faceAt(a, b));
  std::rotate(face.begin(), std::find(face.begin(), face.end(), a), face.end());
  return face;
}

}  // namespace

SplineGrid gridAround(const LocalMesh& mesh) {
  // Grid coordinates of the face's corners; beyond corner k lies outer[k].
  constexpr int inner[4][2] = {{1, 1}, {2, 1}, {2, 2}, {1, 2}};
  constexpr int outer[4][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
  const std::vector<int>& face = mesh.faces[0];
  SplineGrid grid;
  const auto cell = [&](int i, int j) -> Point& { return grid[j][i]; };
  const auto point = [&](int vertex) { return mesh.vertices[vertex].point; };
  const auto mirrored = [](const Point& at, const Point& in) { return Real(2) * at - in; };

  for (int k = 0; k < 4; ++k) cell(inner[k][0], inner[k][1]) = point(face[k]);
  bool open[4];
  for (int k = 0; k < 4; ++k) {  // beyond the side from corner k to corner l
    const int l = (k + 1) % 4;
    const int step_i = inner[k][0] - inner[(k + 3) % 4][0];
    const int step_j = inner[k][1] - inner[(k + 3) % 4][1];
    Point& beyond_k = cell(inner[k][0] + step_i, inner[k][1] + step_j);
    Point& beyond_l = cell(inner[l][0] + step_i, inner[l][1] + step_j);
    open[k] = mesh.isOpen(face[k], face[l]);
    if (open[k]) {
      beyond_k = mirrored(point(face[k]), point(face[(k + 3) % 4]));
      beyond_l = mirrored(point(face[l]), point(face[(l + 1) % 4]));
    } else {
      const std::vector<int> across = faceFrom(mesh, face[l], face[k]);
      beyond_k = point(across[2]);
      beyond_l = point(across[3]);
    }
  }
  for (int k = 0; k < 4; ++k) {
    const int before = (k + 3) % 4;
    const int oi = outer[k][0], oj = outer[k][1], ii = inner[k][0], ij = inner[k][1];
    Point& corner = cell(oi, oj);
    if (!open[before] && !open[k]) {
      const int spoke = faceFrom(mesh, face[k], face[before])[3];
      corner = point(faceFrom(mesh, face[k], spoke).at(2));
    } else if (!open[before] || !open[k]) {
      // Along the row beyond the side that is not open, over the one that is.
      const bool row = (k % 2 == 0) == open[before];  // whether the row runs in u
      corner = row ? mirrored(cell(ii, oj), cell(2 * ii - oi, oj))
                   : mirrored(cell(oi, ij), cell(oi, 2 * ij - oj));
    } else {
      corner = mirrored(cell(ii, oj), cell(2 * ii - oi, oj));
    }
  }
  return grid;
}

Point evaluate(const SplineGrid& grid, const Real& u, const Real& v, int du, int dv) {
  const std::array<Real, 4> bu = splines(u, du), bv = splines(v, dv);
  Point sum;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) sum += (bu[i] * bv[j]) * grid[j][i];
  }
  return sum;
}

}  // namespace limitsurf::test
