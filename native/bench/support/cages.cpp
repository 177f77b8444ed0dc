// SPDX-License-Identifier: Apache-2.0
#include "bench/support/cages.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "bench/support/random.h"
#include "limitsurf/pi.h"

namespace limitsurf::bench {
namespace {

/// Collects vertices and faces.
class CageBuilder {
 public:
  int addVertex(double x, double y, double z) {
    vertices_.push_back({x, y, z});
    return static_cast<int>(vertices_.size()) - 1;
  }
  void addFace(const std::vector<int>& vertices) {
    sizes_.push_back(static_cast<std::int64_t>(vertices.size()));
    corners_.insert(corners_.end(), vertices.begin(), vertices.end());
  }
  Cage build() const {
    Cage cage;
    cage.positions.resize(static_cast<Eigen::Index>(vertices_.size()), 3);
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      for (int k = 0; k < 3; ++k) cage.positions(static_cast<Eigen::Index>(i), k) = vertices_[i][k];
    }
    cage.face_sizes = sizes_;
    cage.face_vertices = corners_;
    return cage;
  }

 private:
  std::vector<std::array<double, 3>> vertices_;
  std::vector<std::int64_t> sizes_, corners_;
};

/// Vertices on an integer lattice. Each is made by the first call that needs it.
class Lattice {
 public:
  using Place = std::function<int(int, int)>;
  explicit Lattice(Place place) : place_(std::move(place)) {}
  int operator()(int i, int j) {
    const auto [entry, is_new] = known_.try_emplace({i, j}, -1);
    if (is_new) entry->second = place_(i, j);
    return entry->second;
  }
  std::vector<int> quad(int i, int j) {
    return {(*this)(i, j), (*this)(i + 1, j), (*this)(i + 1, j + 1), (*this)(i, j + 1)};
  }

 private:
  Place place_;
  std::map<std::pair<int, int>, int> known_;
};

/// Adds `sectors` rhombic grids of side x side quads around a vertex at (x, y), as a closed ring or
/// as an open fan.
void addFan(CageBuilder& builder, Random& random, double x, double y, int sectors, bool closed,
            int side) {
  const int spoke_count = closed ? sectors : sectors + 1;
  const double angle = (closed ? 2 * kPi<double> : 1.5 * kPi<double>) / sectors;
  const auto place = [&](double s, double t, int sector) {
    const double a = angle * sector;
    return builder.addVertex(x + s * std::cos(a) + t * std::cos(a + angle),
                             y + s * std::sin(a) + t * std::sin(a + angle),
                             random.between(-0.5, 0.5));
  };
  const int center = place(0, 0, 0);
  std::vector<std::vector<int>> spokes(spoke_count);
  for (int k = 0; k < spoke_count; ++k) {
    spokes[k].push_back(center);
    for (int i = 1; i <= side; ++i) spokes[k].push_back(place(i, 0, k));
  }
  for (int k = 0; k < sectors; ++k) {
    Lattice lattice([&](int i, int j) {
      if (j == 0) return spokes[k][i];
      if (i == 0) return spokes[(k + 1) % spoke_count][j];
      return place(i, j, k);
    });
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) builder.addFace(lattice.quad(i, j));
    }
  }
}

/// A torus of size x size quads, without those for which `is_hole` is true.
Cage torus(int size, const std::function<bool(int, int)>& is_hole) {
  CageBuilder builder;
  Random random(11);
  std::map<std::pair<int, int>, int> known;
  const auto at = [&](int i, int j) {
    const auto [entry, is_new] = known.try_emplace({i % size, j % size}, -1);
    if (is_new) {
      const double a = 2 * kPi<double> * i / size, b = 2 * kPi<double> * j / size;
      const double tube = 1 + random.between(-0.05, 0.05), ring = 3 + tube * std::cos(b);
      entry->second = builder.addVertex(ring * std::cos(a), ring * std::sin(a), tube * std::sin(b));
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

int Cage::ptexFaceCount() const {
  int count = 0;
  for (const std::int64_t size : face_sizes) count += size == 4 ? 1 : static_cast<int>(size);
  return count;
}

double Cage::diagonal() const {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

Cage everyClassCage() {
  CageBuilder builder;
  Random random(1);
  Lattice plus([&](int i, int j) { return builder.addVertex(i, j, random.between(-0.5, 0.5)); });
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 12; ++i) {
      const bool in_column = i >= 4 && i < 8, in_row = j >= 4 && j < 8;
      if (in_column || in_row) builder.addFace(plus.quad(i, j));
    }
  }
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
  constexpr double kHeight = 1.294810;
  constexpr double kVertices[12][3] = {
      {-0.5, -1.5, 0}, {0.5, -1.5, 0},       {0.5, -0.5, kHeight}, {-0.5, -0.5, kHeight},
      {-1.5, -0.5, 0}, {-0.5, 0.5, kHeight}, {-1.5, 0.5, 0},       {0.5, 0.5, kHeight},
      {1.5, -0.5, 0},  {1.5, 0.5, 0},        {0.5, 1.5, 0},        {-0.5, 1.5, 0}};
  constexpr int kFaces[5][4] = {
      {0, 1, 2, 3}, {4, 3, 5, 6}, {3, 2, 7, 5}, {2, 8, 9, 7}, {5, 7, 10, 11}};
  CageBuilder builder;
  Random random(2);
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) {
      const int first = 12 * (10 * j + i);
      for (const auto& p : kVertices)
        builder.addVertex(p[0] + 4 * i, p[1] + 4 * j, p[2] + random.between(-0.2, 0.2));
      for (const auto& f : kFaces)
        builder.addFace({first + f[0], first + f[1], first + f[2], first + f[3]});
    }
  }
  return builder.build();
}

Cage polygonsCage() {
  CageBuilder builder;
  Random random(3);
  Lattice at([&](int i, int j) { return builder.addVertex(i, j, random.between(-0.3, 0.3)); });
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 32; i += 2) {
      builder.addFace({at(i, j), at(i + 1, j), at(i, j + 1)});
      builder.addFace(
          {at(i + 1, j), at(i + 2, j), at(i + 2, j + 1), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return builder.build();
}

Cage torusCage() {
  return torus(36, [](int, int) { return false; });
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
  Random random(4);
  std::map<std::array<long, 3>, int> known;
  const auto at = [&](const Vector3& p) {
    const std::array<long, 3> key = {std::lround(p.x() * 1e6), std::lround(p.y() * 1e6),
                                     std::lround(p.z() * 1e6)};
    const auto [entry, is_new] = known.try_emplace(key, -1);
    if (is_new) {
      const double scale = 1 + random.between(-0.05, 0.05);
      entry->second = builder.addVertex(scale * p.x(), scale * p.y(), scale * p.z());
    }
    return entry->second;
  };
  for (const auto& t : kTriangles) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 &a = corners[t[k]], &b = corners[t[(k + 1) % 3]], &c = corners[t[(k + 2) % 3]];
      const Vector3 quad[4] = {a, (a + b) / 2, (a + b + c) / 3, (a + c) / 2};
      Lattice lattice([&](int i, int j) {
        const double u = i / 3.0, v = j / 3.0;
        return at((1 - u) * (1 - v) * quad[0] + u * (1 - v) * quad[1] + u * v * quad[2] +
                  (1 - u) * v * quad[3]);
      });
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) builder.addFace(lattice.quad(i, j));
      }
    }
  }
  return builder.build();
}

Cage boundaryEvCage() {
  return torus(36, [](int i, int j) { return i % 6 < 2 && j % 6 < 2; });
}

Cage cornersCage() {
  CageBuilder builder;
  Random random(5);
  for (int k = 0; k < 144; ++k) {
    const double x = 4.0 * (k % 12), y = 4.0 * (k / 12);
    Lattice at(
        [&](int i, int j) { return builder.addVertex(x + i, y + j, random.between(-0.5, 0.5)); });
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) builder.addFace(at.quad(i, j));
    }
  }
  return builder.build();
}

Cage largeCage(int side) {
  // One in eight blocks of 8x8 quads has a missing face or a turned edge, which makes about ten
  // faces irregular.
  constexpr int kBlock = 8;
  constexpr double kDefectiveBlocks = 0.128;
  CageBuilder builder;
  Random random(6);
  std::vector<char> defects(static_cast<std::size_t>(side / kBlock + 1) * (side / kBlock + 1));
  for (char& d : defects) d = random.unit() < kDefectiveBlocks ? (random.unit() < 0.5 ? 1 : 2) : 0;
  for (int j = 0; j <= side; ++j) {
    for (int i = 0; i <= side; ++i) builder.addVertex(i, j, random.between(-0.5, 0.5));
  }
  const auto at = [&](int i, int j) { return j * (side + 1) + i; };
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const char defect = defects[(j / kBlock) * (side / kBlock + 1) + i / kBlock];
      const bool in_middle_row = j % kBlock == 3;
      if (defect == 1 && in_middle_row && i % kBlock == 3) continue;
      if (defect == 2 && in_middle_row && i % kBlock == 3 && i + 1 < side) {
        builder.addFace({at(i, j), at(i + 1, j), at(i + 2, j), at(i + 2, j + 1)});
        builder.addFace({at(i, j), at(i + 2, j + 1), at(i + 1, j + 1), at(i, j + 1)});
        continue;
      }
      if (defect == 2 && in_middle_row && i % kBlock == 4) continue;
      builder.addFace({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return builder.build();
}

Cage semiSharpCage(int side) {
  CageBuilder builder;
  Random random(7);
  for (int j = 0; j <= side; ++j) {
    for (int i = 0; i <= side; ++i) builder.addVertex(i, j, random.between(-0.5, 0.5));
  }
  const auto at = [&](int i, int j) { return j * (side + 1) + i; };
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      builder.addFace({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  Cage cage = builder.build();
  for (int j = 0; j <= side; ++j) {
    for (int i = 0; i < side; ++i) {
      cage.edge_sharpness.edges.emplace_back(at(i, j), at(i + 1, j));
      cage.edge_sharpness.edges.emplace_back(at(j, i), at(j, i + 1));
    }
  }
  for (std::size_t i = 0; i < cage.edge_sharpness.edges.size(); ++i) {
    cage.edge_sharpness.values.push_back(random.between(0.5, 4));
  }
  return cage;
}

}  // namespace limitsurf::bench
