// SPDX-License-Identifier: Apache-2.0
#include "support/cages/query_cages.h"

#include <cmath>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"

namespace limitsurf::test {
namespace {

const std::vector<double> kSharpness = {0.3, 1, 1.7, 2.5, 4.2, 10};

Cage sharpened(Cage cage, std::uint64_t seed, const std::vector<double>& values = kSharpness) {
  Random random(seed);
  sharpenAtRandom(cage, random, 3, 8, values);
  return cage;
}

Cage with(Cage cage, Boundary boundary) {
  cage.options.boundary = boundary;
  return cage;
}

Cage chaikin(Cage cage) {
  cage.options.creasing = Creasing::chaikin;
  return cage;
}

Cage bilinear(Cage cage) {
  cage.options.scheme = Scheme::bilinear;
  return cage;
}

Cage withHoles(Cage cage, std::vector<std::int64_t> holes) {
  cage.options.holes = std::move(holes);
  return cage;
}

Cage dart(Cage cage) {
  const auto edges = edgesOf(cage);
  sharpenEdge(cage, edges[0].first, edges[0].second, 10);
  return cage;
}

/// A cone of triangles whose rim is sharp.
Cage sharpPole(int triangles) {
  Cage cage = pole(triangles);
  for (int i = 0; i < triangles; i += 3) sharpenEdge(cage, 0, i + 1, 10);
  return cage;
}

Cage single(int corners) {
  Cage cage = prism(corners, true);
  cage.faces.erase(cage.faces.begin(), cage.faces.end() - 1);
  for (int& vertex : cage.faces[0]) vertex -= corners;
  cage.positions = Points(cage.positions.bottomRows(corners));
  return cage;
}

template <typename Change>
Cage moved(Cage cage, const Change& change) {
  for (int v = 0; v < cage.vertexCount(); ++v) change(cage.positions.row(v));
  return cage;
}

}  // namespace

NamedCages everyNth(const NamedCages& cages, std::size_t n) {
  NamedCages some;
  for (std::size_t i = n / 2; i < cages.size(); i += n) {
    some.push_back(cages[i]);
  }
  return some;
}

NamedCages closedCages() {
  return {{"cube", cube()},
          {"crooked cube", perturbed(cube(), 0.2, 1)},
          {"cube with a dart", dart(cube())},
          {"cube with semi-sharp edges", sharpened(perturbed(cube(), 0.1, 2), 3)},
          {"tetrahedron", tetrahedron()},
          {"sharp tetrahedron", sharpened(tetrahedron(), 4, {2.4, 10})},
          {"closed prism", prism(7, true)},
          {"torus", torus(6, 5)},
          {"crooked torus, chaikin", chaikin(sharpened(perturbed(torus(6, 5), 0.2, 8), 5))},
          {"bilinear prism", bilinear(perturbed(prism(5, true), 0.1, 6))}};
}

NamedCages queryCages() {
  NamedCages cages = closedCages();
  const auto corners = Boundary::corners;
  cages.insert(
      cages.end(),
      {{"cross", cross()},
       {"cross with corners", with(cross(), corners)},
       {"open prism", prism(6, false)},
       {"single triangle", single(3)},
       {"single square", single(4)},
       {"pinned square", with(perturbed(single(4), 0.2, 9), corners)},
       {"single hexagon", single(6)},
       {"valence 2", perturbed(valenceTwo(), 0.1, 10)},
       {"valence 3", fan(3, true, 11)},
       {"valence 5", fan(5, true, 12)},
       {"valence 17", fan(17, true, 13)},
       {"valence 100", pole(100)},
       {"sharp pole", sharpPole(12)},
       {"open fan of 4", fan(4, false, 14)},
       {"open fan of 5, pinned", with(fan(5, false, 15), corners)},
       {"open fan of 9", fan(9, false, 16)},
       {"polygon of 7", ngon(7, 17)},
       {"mixture", mixture(3)},
       {"mixture with corners", with(mixture(18), corners)},
       {"sharp mixture", with(sharpened(mixture(19), 20), corners)},
       {"sharp mixture, chaikin", chaikin(sharpened(mixture(21), 22))},
       {"infinitely sharp mixture", sharpened(mixture(23), 24, {10})},
       {"bilinear mixture", bilinear(mixture(25))},
       {"mixture with holes", withHoles(mixture(26), {1, 4})},
       {"plane", grid(4, 3)},
       {"crooked plane",
        moved(perturbed(gridWithHoles(5, 4, {6, 12}), 0.3, 27), [](auto row) { row[2] = 0; })},
       {"wavy grid", moved(grid(5, 4), [](auto row) { row[2] = std::sin(2 * row[0] + row[1]); })},
       {"refused face", gridWithFace({0, 1, 2, 1})}});
  for (auto& cage : nonManifoldCages()) cages.push_back(std::move(cage));
  return cages;
}

NamedCages degenerateCages() {
  const Cage grid44 = grid(4, 4);
  return {
      {"all points equal", moved(mixture(3), [](auto row) { row << 1, 2, 3; })},
      {"cube of equal points", moved(cube(), [](auto row) { row << 0.1, 0.2, 0.3; })},
      {"collinear grid", moved(grid44, [](auto row) { row << row[0] + row[1], 0, 0; })},
      {"collinear mixture", moved(mixture(4), [](auto row) { row << row[0], row[0] / 3, 0; })},
      {"columns that coincide",
       moved(grid(6, 3), [](auto row) { row[0] = row[0] < 2   ? 0
                                                 : row[0] < 5 ? 1
                                                              : 2; })},
      {"folded grid", moved(grid44, [](auto row) { row[0] = std::abs(row[0] - 2); })},
      {"cube with a collapsed face", moved(cube(),
                                           [](auto row) {
                                             if (row[2] > 0.5) row << 0.5, 0.5, 1;
                                           })},
      {"pole of no width", moved(pole(9), [](auto row) { row[0] = 0; })},
      {"flat torus", moved(torus(6, 5), [](auto row) { row[2] = 0; })},
      {"twisted square", moved(with(single(4), Boundary::corners),
                               [](auto row) { row << row[0], std::abs(row[1]), row[0] * row[1]; })},
  };
}

std::vector<Location> searchedLocations(const LimitSurface& surface, int count, Random& random) {
  std::vector<Location> at;
  while (static_cast<int>(at.size()) < count) {
    const int face = random.below(surface.faceCount());
    if (surface.refused().count(surface.baseFace()[face]) != 0) continue;
    const double u = random.uniform(), v = random.uniform();
    Location corner = cornerLocation(face, random.below(4));
    switch (random.below(6)) {
      case 0:
        at.push_back(corner);
        break;
      case 1:
        at.push_back(random.below(2) == 0 ? Location{face, corner.u, v}
                                          : Location{face, u, corner.v});
        break;
      case 2: {
        const double size = std::ldexp(1., -5 - random.below(36));
        at.push_back({face, std::abs(corner.u - u * size), std::abs(corner.v - v * size)});
        break;
      }
      default:
        at.push_back({face, u, v});
    }
  }
  return at;
}

}  // namespace limitsurf::test
