// SPDX-License-Identifier: Apache-2.0
#include "support/cages/benchmark_cages.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "limitsurf/pi.h"
#include "support/cages/cage_builder.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// Raises or lowers every vertex by at most `size`.
Cage withHeights(Cage cage, BenchmarkRandom& random, double size) {
  for (int v = 0; v < cage.vertexCount(); ++v) cage.positions(v, 2) += random.uniform(-size, size);
  return cage;
}

/// Adds `sectors` rhombic grids of side x side quads around a vertex at (x, y), as a closed ring or
/// as an open fan.
void addFan(CageBuilder& builder, BenchmarkRandom& random, double x, double y, int sectors,
            bool closed, int side) {
  const int spoke_count = closed ? sectors : sectors + 1;
  const double angle = (closed ? 2 * kPi<double> : 1.5 * kPi<double>) / sectors;
  const auto place = [&](double s, double t, int sector) {
    const double a = angle * sector;
    return builder.addVertex({x + s * std::cos(a) + t * std::cos(a + angle),
                              y + s * std::sin(a) + t * std::sin(a + angle),
                              random.uniform(-0.5, 0.5)});
  };
  std::vector<std::vector<int>> spokes(spoke_count);
  const int center = place(0, 0, 0);
  for (int k = 0; k < spoke_count; ++k) {
    spokes[k].push_back(center);
    for (int i = 1; i <= side; ++i) spokes[k].push_back(place(i, 0, k));
  }
  for (int k = 0; k < sectors; ++k) {
    std::vector<int> row = spokes[k];
    for (int j = 1; j <= side; ++j) {
      std::vector<int> next = {spokes[(k + 1) % spoke_count][j]};
      for (int i = 1; i <= side; ++i) next.push_back(place(i, j, k));
      for (int i = 0; i < side; ++i) builder.addFace({row[i], row[i + 1], next[i + 1], next[i]});
      row = next;
    }
  }
}

/// A bumpy torus of size x size quads, without those for which `is_hole` is true.
Cage bumpyTorus(int size, const std::function<bool(int, int)>& is_hole) {
  CageBuilder builder;
  BenchmarkRandom random(11);
  std::map<std::pair<int, int>, int> known;
  const auto at = [&](int i, int j) {
    const auto [entry, is_new] = known.try_emplace({i % size, j % size}, -1);
    if (is_new) {
      const double a = 2 * kPi<double> * i / size, b = 2 * kPi<double> * j / size;
      const double tube = 1 + random.uniform(-0.05, 0.05), ring = 3 + tube * std::cos(b);
      entry->second =
          builder.addVertex({ring * std::cos(a), ring * std::sin(a), tube * std::sin(b)});
    }
    return entry->second;
  };
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      if (!is_hole(i, j)) builder.addFace({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return builder.build();
}

}  // namespace

Cage everyClassCage() {
  constexpr int kSide = 12, kArm = 4;
  const auto inArm = [](int i) { return i / kArm == 1; };
  std::vector<int> holes;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      if (!inArm(i) && !inArm(j)) holes.push_back(i + kSide * j);
    }
  }
  BenchmarkRandom random(1);
  CageBuilder builder;
  builder.append(withHeights(gridWithHoles(kSide, kSide, holes), random, 0.5));
  double x = 30;
  for (int valence = 4; valence <= 7; ++valence, x += 20)
    addFan(builder, random, x, 0, valence - 1, false, 6);
  for (const int valence : {3, 5, 6}) {
    addFan(builder, random, x, 0, valence, true, 6);
    x += 20;
  }
  return builder.build();
}

Cage crossesCage() {
  CageBuilder builder;
  BenchmarkRandom random(2);
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) {
      builder.append(withHeights(placed(cross(), 1, {4. * i, 4. * j, 0}), random, 0.2));
    }
  }
  return builder.build();
}

Cage polygonsCage() {
  const Cage squares = fullGrid(32, 16);
  const auto square = [&](int i, int j) { return squares.faces[i + 32 * j]; };
  Cage cage;
  cage.positions = squares.positions;
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 32; i += 2) {
      const std::vector<int> a = square(i, j), b = square(i + 1, j);
      cage.faces.push_back({a[0], a[1], a[3]});
      cage.faces.push_back({a[1], b[1], b[2], a[2], a[3]});
    }
  }
  BenchmarkRandom random(3);
  return withHeights(compacted(cage), random, 0.3);
}

Cage torusCage() {
  return bumpyTorus(36, [](int, int) { return false; });
}

Cage interiorEvCage() {
  // Every triangle of an icosahedron becomes three quads, every quad 3x3.
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Vector3> corners = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                        {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                        {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  constexpr int kTriangles[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  CageBuilder builder;
  BenchmarkRandom random(4);
  std::map<std::array<long, 3>, int> known;
  const auto at = [&](const Vector3& p) {
    const std::array<long, 3> key = {std::lround(p.x() * 1e6), std::lround(p.y() * 1e6),
                                     std::lround(p.z() * 1e6)};
    const auto [entry, is_new] = known.try_emplace(key, -1);
    if (is_new) {
      const double scale = 1 + random.uniform(-0.05, 0.05);
      entry->second = builder.addVertex(scale * p);
    }
    return entry->second;
  };
  for (const auto& t : kTriangles) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 &a = corners[t[k]], &b = corners[t[(k + 1) % 3]], &c = corners[t[(k + 2) % 3]];
      const Vector3 quad[4] = {a, (a + b) / 2, (a + b + c) / 3, (a + c) / 2};
      const auto vertex = [&](int i, int j) {
        const double u = i / 3.0, v = j / 3.0;
        return at((1 - u) * (1 - v) * quad[0] + u * (1 - v) * quad[1] + u * v * quad[2] +
                  (1 - u) * v * quad[3]);
      };
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
          builder.addFace({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
      }
    }
  }
  return builder.build();
}

Cage boundaryEvCage() {
  return bumpyTorus(36, [](int i, int j) { return i % 6 < 2 && j % 6 < 2; });
}

Cage cornersCage() {
  CageBuilder builder;
  BenchmarkRandom random(5);
  for (int k = 0; k < 144; ++k) {
    const Vector3 offset(4.0 * (k % 12), 4.0 * (k / 12), 0);
    builder.append(withHeights(placed(grid(3, 3), 1, offset), random, 0.5));
  }
  return builder.build();
}

Cage largeCage(int side) {
  // One in eight blocks of 8x8 quads has a missing face or a turned edge, which makes about ten
  // faces irregular.
  constexpr int kBlock = 8;
  constexpr double kDefectiveBlocks = 0.128;
  BenchmarkRandom random(6);
  std::vector<char> defects(static_cast<std::size_t>(side / kBlock + 1) * (side / kBlock + 1));
  for (char& d : defects) {
    d = random.uniform() < kDefectiveBlocks ? (random.uniform() < 0.5 ? 1 : 2) : 0;
  }
  Cage cage = withHeights(fullGrid(side, side), random, 0.5);
  std::vector<std::vector<int>> squares;
  squares.swap(cage.faces);
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const std::vector<int>& square = squares[i + static_cast<std::size_t>(side) * j];
      const char defect = defects[(j / kBlock) * (side / kBlock + 1) + i / kBlock];
      const bool in_middle_row = j % kBlock == 3;
      if (defect == 1 && in_middle_row && i % kBlock == 3) continue;
      if (defect == 2 && in_middle_row && i % kBlock == 3 && i + 1 < side) {
        const std::vector<int>& beside = squares[i + 1 + static_cast<std::size_t>(side) * j];
        cage.faces.push_back({square[0], square[1], beside[1], beside[2]});
        cage.faces.push_back({square[0], beside[2], square[2], square[3]});
        continue;
      }
      if (defect == 2 && in_middle_row && i % kBlock == 4) continue;
      cage.faces.push_back(square);
    }
  }
  return cage;
}

Cage semiSharpCage(int side) {
  BenchmarkRandom random(7);
  Cage cage = withHeights(fullGrid(side, side), random, 0.5);
  const auto at = [&](int i, int j) { return j * (side + 1) + i; };
  for (int j = 0; j <= side; ++j) {
    for (int i = 0; i < side; ++i) {
      sharpenEdge(cage, at(i, j), at(i + 1, j), random.uniform(0.5, 4));
      sharpenEdge(cage, at(j, i), at(j, i + 1), random.uniform(0.5, 4));
    }
  }
  return cage;
}

Cage characterCage(int side) {
  constexpr std::size_t kQuadsPerCut = 40;
  constexpr int kFirstLoop = 10, kRowsPerLoop = 20;
  Cage cage = largeCage(side);
  std::vector<std::vector<int>> quads;
  quads.swap(cage.faces);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const std::vector<int>& quad = quads[i];
    if (i % kQuadsPerCut == kQuadsPerCut - 1) {
      cage.faces.push_back({quad[0], quad[1], quad[2]});
      cage.faces.push_back({quad[0], quad[2], quad[3]});
    } else {
      cage.faces.push_back(quad);
    }
  }
  for (const auto& [a, b] : edgesOf(cage)) {
    const int row = a / (side + 1);
    if (b - a == 1 && b / (side + 1) == row && row % kRowsPerLoop == kFirstLoop) {
      sharpenEdge(cage, a, b, 2.5);
    }
  }
  return cage;
}

Cage scanCage(int side) {
  constexpr double kNoise = 0.15, kShift = 0.2, kHeight = 0.2;
  BenchmarkRandom random(5);
  Cage cage = fullGrid(side, side);
  std::vector<std::vector<int>> quads;
  quads.swap(cage.faces);
  for (const std::vector<int>& quad : quads) {
    const int turn = random.uniform() < 0.5 ? 0 : 1;
    const auto corner = [&](int i) { return quad[static_cast<std::size_t>((turn + i) % 4)]; };
    cage.faces.push_back({corner(0), corner(1), corner(2)});
    cage.faces.push_back({corner(2), corner(3), corner(0)});
  }
  for (Eigen::Index v = 0; v < cage.positions.rows(); ++v) {
    const double x = cage.positions(v, 0) / side, y = cage.positions(v, 1) / side;
    const double wave = side * kHeight * std::sin(5 * x) * std::cos(4 * y);
    cage.positions(v, 2) = wave + random.uniform(-kNoise, kNoise);
    cage.positions(v, 0) += random.uniform(-kShift, kShift);
    cage.positions(v, 1) += random.uniform(-kShift, kShift);
  }
  return cage;
}

}  // namespace limitsurf::test
