// SPDX-License-Identifier: Apache-2.0
#include "support/cages/strange_meshes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

using Faces = std::vector<std::vector<int>>;

constexpr int kSide = 4;

/// kSide x kSide squares; vertex i + 5 j lies at (i, j, 0).
Cage lattice() { return fullGrid(kSide, kSide); }

int add(Cage& cage, const Vector3& position) {
  cage.positions.conservativeResize(cage.positions.rows() + 1, 3);
  cage.positions.bottomRows(1) = position.transpose();
  return cage.vertexCount() - 1;
}

/// Raises a row of squares on a chain of edges, each joined to the next; `winding` turns square i
/// over where it is odd at place i.
void raise(Cage& cage, const std::vector<int>& chain, const Vector3& up,
           const std::vector<int>& turned = {}) {
  std::vector<int> top;
  for (int vertex : chain) {
    top.push_back(add(cage, Vector3(cage.positions.row(vertex)) + up));
  }
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    std::vector<int> face = {chain[i], chain[i + 1], top[i + 1], top[i]};
    if (std::count(turned.begin(), turned.end(), static_cast<int>(i)) != 0) {
      std::reverse(face.begin(), face.end());
    }
    cage.faces.push_back(face);
  }
}

Cage raised(const std::vector<int>& chain, const std::vector<int>& turned = {}) {
  Cage cage = lattice();
  raise(cage, chain, {0.1, 0.2, 1}, turned);
  return cage;
}

/// Closed or open fans of triangles around one vertex, each turned into another direction.
Cage fans(const std::vector<std::pair<int, bool>>& sizes_and_closed) {
  Cage cage;
  const int tip = add(cage, {0, 0, 0});
  int direction = 0;
  for (const auto& [triangles, closed] : sizes_and_closed) {
    const double height = direction++ % 2 == 0 ? 1 : -1;
    std::vector<int> rim;
    for (int i = 0; i < triangles + !closed; ++i) {
      const double angle = 6.283185307179586 * i / (triangles + !closed) + direction;
      rim.push_back(add(cage, {std::cos(angle), std::sin(angle), height}));
    }
    for (int i = 0; i < triangles; ++i) {
      std::vector<int> face = {tip, rim[i], rim[(i + 1) % rim.size()]};
      if (height < 0) std::swap(face[1], face[2]);
      cage.faces.push_back(face);
    }
  }
  return cage;
}

/// Two boxes side by side, without the faces between them.
Cage boxes() {
  Cage cage = cube();
  for (const Vector3& p :
       {Vector3(2, 0, 0), Vector3(2, 0, 1), Vector3(2, 1, 1), Vector3(2, 1, 0)}) {
    add(cage, p);
  }
  const Faces more = {{8, 9, 10, 11}, {1, 8, 11, 3}, {5, 7, 10, 9}, {1, 5, 9, 8}, {3, 11, 10, 7}};
  cage.faces.pop_back();
  cage.faces.insert(cage.faces.end(), more.begin(), more.end());
  return cage;
}

Cage boxesWithWall(const Faces& wall) {
  Cage cage = boxes();
  cage.faces.insert(cage.faces.end(), wall.begin(), wall.end());
  return cage;
}

Cage without(Cage cage, const Faces& faces) {
  cage.faces = faces;
  return cage;
}

Cage withTurned(Cage cage, const std::vector<int>& faces) {
  for (int face : faces) std::reverse(cage.faces[face].begin(), cage.faces[face].end());
  return cage;
}

/// Adds faces, triangles or quads, around the vertex, from each new rim point to the next.
void addFaces(Cage& cage, int vertex, const std::vector<int>& rim, bool quads) {
  for (std::size_t i = 0; i + 1 < rim.size(); ++i) {
    cage.faces.push_back({vertex, rim[i], rim[i + 1]});
    if (quads) {
      const Vector3 a = cage.positions.row(rim[i]), b = cage.positions.row(rim[i + 1]);
      const int corner = add(cage, 0.7 * (a + b) - 0.4 * Vector3(cage.positions.row(vertex)));
      cage.faces.back().insert(cage.faces.back().begin() + 2, corner);
    }
  }
}

/// A point of a circle below a vertex.
int addRimPoint(Cage& cage, int vertex, double turns) {
  const double angle = 6.283185307179586 * turns;
  const Vector3 p = cage.positions.row(vertex);
  return add(cage, p + Vector3(std::cos(angle), std::sin(angle), -1));
}

/// Adds a closed fan of faces around the vertex.
void addTip(Cage& cage, int vertex, int faces, bool quads) {
  std::vector<int> rim;
  for (int i = 0; i < faces; ++i) {
    rim.push_back(addRimPoint(cage, vertex, (i + 0.3) / faces));
  }
  rim.push_back(rim[0]);
  addFaces(cage, vertex, rim, quads || faces == 2);
}

/// Adds a fan of faces around the vertex that begins and ends at the edge to `end`.
void addLoop(Cage& cage, int vertex, int end, int faces, bool quads) {
  std::vector<int> rim = {end};
  for (int i = 1; i < faces; ++i) {
    rim.push_back(addRimPoint(cage, vertex, i / static_cast<double>(faces)));
  }
  rim.push_back(end);
  addFaces(cage, vertex, rim, quads || faces == 2);
}

Cage withAgain(Cage cage, int face, bool turned) {
  cage.faces.push_back(cage.faces[face]);
  if (turned) std::reverse(cage.faces.back().begin(), cage.faces.back().end());
  return cage;
}

/// `count` squares in a row whose ends are joined upside down.
Cage moebius(int count) {
  Cage cage;
  for (int i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * i / count;
    const Vector3 out(std::cos(angle), std::sin(angle), 0);
    const Vector3 across = std::cos(angle / 2) * Vector3(0, 0, 1) + std::sin(angle / 2) * out;
    add(cage, 3 * out - across);
    add(cage, 3 * out + across);
  }
  for (int i = 0; i < count; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % count), swap = i + 1 == count;
    cage.faces.push_back({a, b + swap, b + 1 - swap, a + 1});
  }
  return cage;
}

}  // namespace

Cage book(int pages) {
  Cage cage;
  cage.positions.resize(2 + 2 * Eigen::Index{pages}, 3);
  cage.positions.topRows(2) << 0, 0, 0, 0, 0, 2;
  for (int page = 0; page < pages; ++page) {
    const int bottom = 2 + 2 * page;
    cage.positions.row(bottom) << std::cos(page), std::sin(page), 0.1;
    cage.positions.row(bottom + 1) << std::cos(page), std::sin(page), 2.1;
    cage.faces.push_back({0, 1, bottom + 1, bottom});
  }
  return cage;
}

NamedCages nonManifoldCages() {
  NamedCages cages;
  const auto take = [&](const std::string& name, Cage cage) {
    cages.emplace_back(name, perturbed(std::move(cage), 0.1, cages.size() + 1));
  };
  // Three faces on an edge.
  take("one fin", raised({11, 12}));
  take("two fins", raised({11, 12, 13}));
  take("fins across", raised({10, 11, 12, 13, 14}));
  take("fins across, turned", raised({10, 11, 12, 13, 14}, {0, 1, 2, 3}));
  take("fins of alternating winding", raised({10, 11, 12, 13, 14}, {1, 3}));
  take("fins round a corner", raised({11, 12, 17}));
  take("fins all around a face", raised({6, 7, 12, 11, 6}));
  take("fin at the boundary", raised({0, 1, 2}));
  Cage cage = raised({2, 7, 12, 17, 22});
  const int over_middle = 27;
  cage.faces.push_back({11, 12, over_middle, add(cage, {1, 2, 1})});
  cage.faces.push_back({12, 13, add(cage, {3, 2, 1}), over_middle});
  take("cross of fins", cage);
  cage = raised({11, 12, 13});
  cage.faces.push_back({10, 11, add(cage, {0, 2, 1})});
  take("triangle beside fins", cage);
  take("boxes with a wall", boxesWithWall({{1, 3, 7, 5}}));
  // Four faces on an edge.
  cage = raised({10, 11, 12, 13, 14});
  raise(cage, {10, 11, 12, 13, 14}, {0, 0.1, -1});
  take("two sheets that cross", cage);
  cage = raised({10, 11, 12, 13, 14});
  raise(cage, {11, 12, 13}, {0, 0.1, -1});
  take("three and four faces on an edge", cage);
  take("boxes with two walls", boxesWithWall({{1, 3, 7, 5}, {1, 5, 7, 3}}));
  take("five pages", book(5));
  // Opposite winding.
  take("one face turned", withTurned(lattice(), {5}));
  take("half of the faces turned", withTurned(lattice(), {8, 9, 10, 11, 12, 13, 14, 15}));
  take("corner face turned", withTurned(lattice(), {0}));
  take("Moebius strip", moebius(7));
  take("all faces clockwise", reversed(lattice()));
  // Faces on top of each other.
  take("pillow", without(lattice(), {{0, 1, 6, 5}, {5, 6, 1, 0}}));
  take("triangular pillow", without(lattice(), {{0, 1, 6}, {6, 1, 0}}));
  take("pentagonal pillow", without(lattice(), {{0, 1, 2, 7, 5}, {5, 7, 2, 1, 0}}));
  take("one face twice", without(lattice(), {{0, 1, 6, 5}, {0, 1, 6, 5}}));
  take("inner face twice", withAgain(lattice(), 5, false));
  take("inner face twice, turned", withAgain(lattice(), 5, true));
  take("corner face twice", withAgain(lattice(), 0, false));
  take("corner face twice, turned", withAgain(lattice(), 0, true));
  take("boundary face three times", withAgain(withAgain(lattice(), 1, false), 1, true));
  // Several fans at a vertex.
  take("two cones", fans({{5, true}, {4, true}}));
  take("cone and open fan", fans({{5, true}, {2, false}}));
  take("cone and triangle", fans({{6, true}, {1, false}}));
  take("three open fans", fans({{1, false}, {2, false}, {3, false}}));
  take("cones and fans", fans({{3, true}, {4, true}, {1, false}, {5, false}}));
  cage = raised({11, 12, 13});
  cage.faces.push_back(
      {12, add(cage, {2, 2.5, -1}), add(cage, {2, 2, -1.5}), add(cage, {2, 1.5, -1})});
  take("quad on a crease of fins", cage);
  for (auto& [name, c] : cages) {  // vertices that no face uses may be anywhere
    std::vector<bool> used(c.vertexCount(), false);
    for (const std::vector<int>& face : c.faces) {
      for (int vertex : face) used[vertex] = true;
    }
    for (int v = 0; v < c.vertexCount(); ++v) {
      if (!used[v]) c.positions.row(v) = c.positions.row(c.faces[0][0]);
    }
  }
  return cages;
}

NamedCages fansOnACrease() {
  NamedCages cages;
  const auto take = [&](const std::string& name, Cage cage) {
    cages.emplace_back(name, perturbed(std::move(cage), 0.1, cages.size() + 1));
  };
  for (const int faces : {2, 3, 4, 5, 8}) {
    Cage cage = raised({10, 11, 12, 13, 14});
    addTip(cage, 12, faces, faces % 2 == 0);
    take("tip of " + std::to_string(faces) + " faces", cage);
  }
  for (const int faces : {2, 3, 4, 5, 6}) {
    Cage cage = raised({10, 11, 12, 13, 14});
    addLoop(cage, 12, 13, faces, faces % 2 == 0);
    take("loop of " + std::to_string(faces) + " faces", cage);
  }
  Cage cage = raised({10, 11, 12, 13, 14});
  addTip(cage, 11, 3, true);
  addTip(cage, 12, 4, false);
  addTip(cage, 12, 5, true);
  addLoop(cage, 13, 12, 3, true);
  addLoop(cage, 13, 14, 2, false);
  addLoop(cage, 12, 13, 4, true);
  take("tips and loops", cage);
  return cages;
}

Cage gridWithFace(const std::vector<int>& corners) {
  Cage cage = perturbed(lattice(), 0.1, 1);
  std::vector<int> face;
  for (int corner : corners) face.push_back(cage.faces[5][corner]);
  cage.faces[5] = face;
  return cage;
}

}  // namespace limitsurf::test
