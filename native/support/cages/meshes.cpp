// SPDX-License-Identifier: Apache-2.0
#include "support/cages/meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "limitsurf/pi.h"
#include "support/cages/cage_builder.h"
#include "support/random.h"

namespace limitsurf::test {
Cage compacted(const Cage& cage) {
  CageBuilder builder;
  std::map<int, int> kept;
  for (std::vector<int> face : cage.faces) {
    for (int& vertex : face) {
      const auto [found, is_new] = kept.try_emplace(vertex, -1);
      if (is_new) found->second = builder.addVertex(cage.positions.row(vertex));
      vertex = found->second;
    }
    builder.addFace(std::move(face));
  }
  Cage result = builder.build();
  result.options = cage.options;
  return result;
}

Cage fan(int faces, bool closed, std::uint64_t seed) {
  // Sector i spans the directions i and i + 1; (a, b) are steps along these, up to two.
  Random random(seed);
  std::map<std::vector<int>, int> index;
  CageBuilder builder;
  const double turn =
      closed ? 2 * kPi<double> : std::min(1.7 * kPi<double>, 0.5 * kPi<double> * faces);
  const auto vertex = [&](int sector, int a, int b) {
    if (a == 0 && b > 0) {
      sector = closed ? (sector + 1) % faces : sector + 1;
      a = b;
      b = 0;
    }
    if (a == 0) sector = 0;
    const auto [found, is_new] = index.try_emplace(std::vector<int>{sector, a, b}, -1);
    if (is_new) {
      const auto direction = [&](int i) {
        const double angle = turn * i / faces;
        return Vector3(std::cos(angle), std::sin(angle), 0);
      };
      const Vector3 regular = a * direction(sector) + b * direction(sector + 1);
      found->second = builder.addVertex(regular + random.vector(0.15));
    }
    return found->second;
  };
  for (int sector = 0; sector < faces; ++sector) {
    for (int b = 0; b < 2; ++b) {
      for (int a = 0; a < 2; ++a) {
        builder.addFace({vertex(sector, a, b), vertex(sector, a + 1, b),
                         vertex(sector, a + 1, b + 1), vertex(sector, a, b + 1)});
      }
    }
  }
  return builder.build();
}

Cage pole(int triangles) {
  Cage cage;
  cage.positions.resize(triangles + 1, 3);
  cage.positions.row(0) << 0, 0, 0.5;
  for (int i = 0; i < triangles; ++i) {
    const double angle = 2 * kPi<double> * i / triangles;
    cage.positions.row(i + 1) << std::cos(angle), std::sin(angle), 0;
    cage.faces.push_back({0, i + 1, (i + 1) % triangles + 1});
  }
  return cage;
}

Cage ngon(int sides, std::uint64_t seed) {
  Random random(seed);
  CageBuilder builder;
  for (double radius : {1.0, 2.0}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * kPi<double> * i / sides;
      builder.addVertex(radius * Vector3(std::cos(angle), std::sin(angle), 0) + random.vector(0.1));
    }
  }
  std::vector<int> polygon(sides);
  std::iota(polygon.begin(), polygon.end(), 0);
  builder.addFace(polygon);
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    builder.addFace({i, sides + i, sides + next, next});
  }
  return builder.build();
}

Cage grid(int columns, int rows) { return gridWithHoles(columns, rows, {}); }

Cage gridWithHoles(int columns, int rows, const std::vector<int>& holes) {
  Cage cage = fullGrid(columns, rows);
  std::vector<std::vector<int>> kept;
  for (std::size_t i = 0; i < cage.faces.size(); ++i) {
    if (std::count(holes.begin(), holes.end(), static_cast<int>(i)) == 0) {
      kept.push_back(cage.faces[i]);
    }
  }
  cage.faces = std::move(kept);
  return compacted(cage);
}

Cage fullGrid(int columns, int rows) {
  Cage cage;
  cage.positions.resize((columns + 1) * (rows + 1), 3);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) cage.positions.row(j * (columns + 1) + i) << i, j, 0;
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + columns + 1;
      cage.faces.push_back({a, a + 1, b + 1, b});
    }
  }
  return cage;
}

Cage cross() {
  const double z = 1.29481;
  Cage cage;
  cage.positions.resize(12, 3);
  cage.positions << -0.5, -1.5, 0, 0.5, -1.5, 0, 0.5, -0.5, z, -0.5, -0.5, z, -1.5, -0.5, 0, -0.5,
      0.5, z, -1.5, 0.5, 0, 0.5, 0.5, z, 1.5, -0.5, 0, 1.5, 0.5, 0, 0.5, 1.5, 0, -0.5, 1.5, 0;
  cage.faces = {{0, 1, 2, 3}, {4, 3, 5, 6}, {3, 2, 7, 5}, {2, 8, 9, 7}, {5, 7, 10, 11}};
  return cage;
}

Cage cube() {
  Cage cage;
  cage.positions.resize(8, 3);
  for (int i = 0; i < 8; ++i) cage.positions.row(i) << i % 2, i / 2 % 2, i / 4;
  cage.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cage;
}

Cage tetrahedron() {
  Cage cage;
  cage.positions.resize(4, 3);
  cage.positions << 1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1;
  cage.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return cage;
}

Cage prism(int sides, bool closed) {
  Cage cage;
  cage.positions.resize(2 * sides, 3);
  std::vector<int> bottom, top;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi<double> * i / sides;
    cage.positions.row(i) << std::cos(angle), std::sin(angle), -0.7;
    cage.positions.row(sides + i) << std::cos(angle), std::sin(angle), 0.7;
    const int next = (i + 1) % sides;
    cage.faces.push_back({i, next, sides + next, sides + i});
    bottom.insert(bottom.begin(), i);
    top.push_back(sides + i);
  }
  if (closed) {
    cage.faces.push_back(bottom);
    cage.faces.push_back(top);
  }
  return cage;
}

Cage torus(int around, int across) {
  Cage cage;
  cage.positions.resize(around * across, 3);
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * kPi<double> * i / around, b = 2 * kPi<double> * j / across;
      const double radius = 2 + 0.7 * std::cos(b);
      cage.positions.row(i * across + j) << radius * std::cos(a), radius * std::sin(a),
          0.7 * std::sin(b);
      const int k = (i + 1) % around, l = (j + 1) % across;
      cage.faces.push_back({i * across + j, k * across + j, k * across + l, i * across + l});
    }
  }
  return cage;
}

Cage valenceTwo() {
  // The middle square of a 5x5 grid, cut along a bent diagonal: a new vertex joined to two opposite
  // corners only.
  Cage cage = grid(5, 5);
  const std::vector<int> middle = cage.faces[12];
  const int centre = cage.vertexCount();
  cage.positions.conservativeResize(centre + 1, 3);
  cage.positions.row(centre) << 2.4, 2.55, 0.3;
  cage.faces[12] = {middle[0], middle[1], middle[2], centre};
  cage.faces.push_back({middle[0], centre, middle[2], middle[3]});
  return cage;
}

Cage mixture(std::uint64_t seed) {
  Random random(seed);
  for (;;) {
    const int columns = 4 + random.below(3), rows = 4 + random.below(3);
    const Cage squares = grid(columns, rows);
    Cage cage;
    cage.positions = squares.positions;
    const auto square = [&](int i, int j) { return squares.faces[i + columns * j]; };
    std::vector<bool> used(columns * rows, false);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        if (used[i + columns * j]) continue;
        const std::vector<int> a = square(i, j);
        const int kind = random.below(10);
        if (kind == 0) continue;  // a hole
        if (kind <= 2) {
          const int turn = random.below(2);
          cage.faces.push_back({a[turn], a[turn + 1], a[turn + 2]});
          cage.faces.push_back({a[turn], a[turn + 2], a[(turn + 3) % 4]});
        } else if (kind <= 4 && i + 1 < columns && !used[i + 1 + columns * j]) {
          const std::vector<int> b = square(i + 1, j);
          used[i + 1 + columns * j] = true;
          if (random.below(2) == 0) {
            cage.faces.push_back({a[0], a[1], b[1], b[2], a[2], a[3]});  // both as one
          } else {
            cage.faces.push_back({a[0], a[1], b[1], a[2], a[3]});  // and a triangle
            cage.faces.push_back({b[1], b[2], a[2]});
          }
        } else {
          cage.faces.push_back(a);
        }
      }
    }
    if (cage.faces.size() < 6 || !isManifold(cage.faces)) continue;
    for (std::vector<int>& face : cage.faces) {
      std::rotate(face.begin(), face.begin() + random.below(static_cast<int>(face.size())),
                  face.end());
    }
    return perturbed(compacted(cage), 0.25, random.bits());
  }
}

Cage perturbed(Cage cage, double size, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < cage.vertexCount(); ++i) cage.positions.row(i) += random.vector(size);
  return cage;
}

Cage placed(Cage cage, double factor, const Vector3& offset) {
  cage.positions = (factor * cage.positions).rowwise() + offset.transpose();
  return cage;
}

Cage reversed(Cage cage) {
  for (std::vector<int>& face : cage.faces) std::reverse(face.begin(), face.end());
  return cage;
}

Cage inTriangles(Cage cage) {
  std::vector<std::vector<int>> halves;
  for (const std::vector<int>& f : cage.faces) {
    halves.push_back({f[0], f[1], f[2]});
    halves.push_back({f[0], f[2], f[3]});
  }
  cage.faces = halves;
  return cage;
}

}  // namespace limitsurf::test
