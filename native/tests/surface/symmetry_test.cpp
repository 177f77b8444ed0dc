// SPDX-License-Identifier: Apache-2.0
//
// Properties that every surface must have, which need no truth to compare with.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "support/cages/meshes.h"
#include "support/truth/corner_points.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

std::vector<std::pair<std::string, Cage>> someCages() {
  return {{"cross", cross()},
          {"cube", perturbed(cube(), 0.2, 1)},
          {"prism", perturbed(prism(5, true), 0.2, 2)},
          {"closed fan", fan(7, true, 3)},
          {"open fan", fan(8, false, 4)},
          {"polygon", ngon(6, 5)},
          {"mixture", mixture(6)},
          {"another mixture", mixture(7)},
          {"torus", perturbed(torus(6, 5), 0.2, 8)}};
}

/// The same place in the parameters of the two faces of an inner edge.
struct SharedPlace {
  Location left, right;
};

/// The point at `t` on side `side` of a Ptex face, counted from its corner `side`.
Location alongSide(int face, int side, double t) {
  switch (side) {
    case 0:
      return {face, t, 0};
    case 1:
      return {face, 1, t};
    case 2:
      return {face, 1 - t, 1};
    default:
      return {face, 0, 1 - t};
  }
}

/// The sides that two quads share. (N-gons are left out, because their Ptex sides are half edges.)
std::vector<SharedPlace> sharedPlaces(const Cage& cage, const std::vector<double>& parameters) {
  std::map<std::pair<int, int>, std::pair<int, int>> side_of;  // directed edge -> ptex face, side
  const std::vector<PtexFace> ptex = ptexFaces(cage);
  for (int face = 0; face < static_cast<int>(ptex.size()); ++face) {
    if (!ptex[face].quad) continue;
    const std::vector<int>& vertices = cage.faces[ptex[face].base_face];
    for (int side = 0; side < 4; ++side) {
      side_of[{vertices[side], vertices[(side + 1) % 4]}] = {face, side};
    }
  }
  std::vector<SharedPlace> places;
  for (const auto& [edge, left] : side_of) {
    const auto right = side_of.find({edge.second, edge.first});
    if (right == side_of.end() || edge.first > edge.second) continue;
    for (double t : parameters) {
      places.push_back({alongSide(left.first, left.second, t),
                        alongSide(right->second.first, right->second.second, 1 - t)});
    }
  }
  return places;
}

TEST(Symmetry, BothFacesOfAnEdgeAgree) {
  // 1 - t must be exact, so that both name the same place.
  std::vector<double> parameters = {0, 1, 0.5, 0.25, 0.625};
  for (int n : {4, 6, 11, 20, 40, 53}) {
    parameters.push_back(std::ldexp(1.0, -n));
    parameters.push_back(1 - std::ldexp(1.0, -n));
  }
  for (const auto& [name, cage] : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    const CornerPoints corners(cage);
    std::vector<Location> left, right;
    for (const SharedPlace& place : sharedPlaces(cage, parameters)) {
      left.push_back(place.left);
      right.push_back(place.right);
    }
    const Evaluation a = surface.evaluate(left, Derivatives::first, true);
    const Evaluation b = surface.evaluate(right, Derivatives::first, true);
    for (int i = 0; i < static_cast<int>(left.size()); ++i) {
      EXPECT_LE((a.position.row(i) - b.position.row(i)).norm(),
                kPositionError * diagonal(cage.positions))
          << name << ", " << describe(left[i]) << " and " << describe(right[i]);
      const Vector3 du = a.du.row(i), dv = a.dv.row(i);
      const bool sound =
          du.allFinite() && dv.allFinite() && du.normalized().cross(dv.normalized()).norm() > 1e-3;
      if (sound && !corners.insideSmoothCorner(left[i])) {
        EXPECT_LE(angle(a.normal.row(i), b.normal.row(i)), 2 * kNormalError)
            << name << ", " << describe(left[i]) << " and " << describe(right[i]);
      }
    }
  }
}

TEST(Symmetry, RotatingAFacesVerticesRotatesUv) {
  Random random(1);
  for (const auto& [name, cage] : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<PtexFace> ptex = ptexFaces(cage);
    for (int turn = 1; turn < 4; ++turn) {
      Cage turned = cage;
      for (std::vector<int>& face : turned.faces) {
        if (face.size() == 4) std::rotate(face.begin(), face.begin() + turn, face.end());
      }
      const LimitSurface turned_surface = limitSurface(turned);
      for (int face = 0; face < static_cast<int>(ptex.size()); ++face) {
        if (!ptex[face].quad) continue;
        std::vector<Location> at = shells(face, 0, {3, 10, 40});
        at += shells(face, 2, {3, 20});
        at += anywhere(face, 4, random);
        std::vector<Location> turned_at;
        for (const Location& location : at) {
          double u = location.u, v = location.v;
          for (int step = 0; step < turn; ++step) {
            const double old_u = u;
            u = v;
            v = 1 - old_u;
          }
          turned_at.push_back({face, u, v});
        }
        const Evaluation a = surface.evaluate(at), b = turned_surface.evaluate(turned_at);
        for (int i = 0; i < static_cast<int>(at.size()); ++i) {
          EXPECT_LE((a.position.row(i) - b.position.row(i)).norm(),
                    kPositionError * diagonal(cage.positions))
              << name << ", " << describe(at[i]) << " turned by " << turn;
        }
      }
    }
  }
}

TEST(Symmetry, ReversingAllFacesMirrorsUvAndTurnsNormals) {
  Random random(2);
  for (const auto& [name, cage] : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    // A reversed quad begins with its former last vertex. It has to begin with its former first
    // one, so that (u, v) becomes (v, u).
    Cage mirrored = reversed(cage);
    for (std::vector<int>& face : mirrored.faces) {
      std::rotate(face.begin(), face.end() - 1, face.end());
    }
    const LimitSurface mirrored_surface = limitSurface(mirrored);
    const std::vector<PtexFace> ptex = ptexFaces(cage);
    for (int face = 0; face < static_cast<int>(ptex.size()); ++face) {
      const int size = static_cast<int>(cage.faces[ptex[face].base_face].size());
      const int corner = ptex[face].corner;
      const int mirrored_face = ptex[face].quad ? face : face - corner + (size - corner) % size;
      std::vector<Location> at = anywhere(face, 3, random), mirrored_at;
      for (int c = 0; c < 4; ++c) {
        at.push_back(cornerLocation(face, c));
        at += shells(face, c, {2, 9, 30});
      }
      for (const Location& l : at) mirrored_at.push_back({mirrored_face, l.v, l.u});
      const Evaluation a = surface.evaluate(at, Derivatives::second, true);
      const Evaluation b = mirrored_surface.evaluate(mirrored_at, Derivatives::second, true);
      const double size3 = diagonal(cage.positions);
      const CornerPoints corners(cage);
      for (int i = 0; i < static_cast<int>(at.size()); ++i) {
        const std::string where = name + ", " + describe(at[i]);
        EXPECT_LE((a.position.row(i) - b.position.row(i)).norm(), kPositionError * size3) << where;
        const auto compare = [&](const Points& x, const Points& y, double error) {
          if (x.row(i).hasNaN() || y.row(i).hasNaN()) {
            EXPECT_TRUE(x.row(i).hasNaN() && y.row(i).hasNaN()) << where;
            return;
          }
          EXPECT_LE((x.row(i) - y.row(i)).norm(), 2 * error * std::max(size3, x.row(i).norm()))
              << where;
        };
        compare(a.du, b.dv, kFirstDerivativeError);
        compare(a.dv, b.du, kFirstDerivativeError);
        compare(a.duu, b.dvv, kSecondDerivativeError);
        compare(a.duv, b.duv, kSecondDerivativeError);
        compare(a.dvv, b.duu, kSecondDerivativeError);
        EXPECT_EQ(a.normal.row(i).hasNaN(), b.normal.row(i).hasNaN()) << where;
        const Vector3 du = a.du.row(i), dv = a.dv.row(i);
        if (a.normal.row(i).allFinite() && !corners.insideSmoothCorner(at[i]) &&
            du.normalized().cross(dv.normalized()).norm() > 1e-3) {
          EXPECT_LE(angle(a.normal.row(i), -b.normal.row(i)), 2 * kNormalError) << where;
        }
      }
    }
  }
}

TEST(Symmetry, AffineMapsOfTheCageMapTheSurface) {
  Eigen::Matrix3d linear;
  linear << 2, 0.3, -0.1, 0.2, -1.5, 0.4, 0.1, 0.7, 3;
  const Eigen::RowVector3d shift(5, -7, 11);
  Random random(3);
  for (const auto& [name, cage] : someCages()) {
    Cage mapped = cage;
    mapped.positions = (cage.positions * linear.transpose()).rowwise() + shift;
    std::vector<Location> at;
    for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
      at += anywhere(face, 2, random);
      for (int corner = 0; corner < 4; ++corner) {
        at.push_back(cornerLocation(face, corner));
        at += shells(face, corner, {3, 30});
      }
    }
    const Evaluation a = limitSurface(cage).evaluate(at, Derivatives::first);
    const Evaluation b = limitSurface(mapped).evaluate(at, Derivatives::first);
    const double size = diagonal(mapped.positions) + shift.norm();
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      EXPECT_LE((a.position.row(i) * linear.transpose() + shift - b.position.row(i)).norm(),
                2 * kPositionError * size)
          << name << ", " << describe(at[i]);
      if (a.du.row(i).hasNaN()) continue;
      EXPECT_LE((a.du.row(i) * linear.transpose() - b.du.row(i)).norm(),
                2 * kFirstDerivativeError * std::max(size, b.du.row(i).norm()))
          << name << ", " << describe(at[i]);
    }
  }
}

TEST(Symmetry, BoundaryCurvesDependOnBoundaryVerticesAlone) {
  for (Boundary rule : {Boundary::smooth, Boundary::corners}) {
    for (int faces : {1, 2, 3, 4, 8, 15}) {
      Cage cage = fan(faces, false, faces);
      cage.options.boundary = rule;
      std::vector<bool> on_boundary(cage.vertexCount(), false);
      const CornerPoints corners(cage);
      std::vector<Location> at;
      const std::vector<PtexFace> ptex = ptexFaces(cage);
      for (int face = 0; face < static_cast<int>(ptex.size()); ++face) {
        for (int c = 0; c < 4; ++c) {
          const CornerPoint& point = corners.at(face, c);
          if (!point.closed) on_boundary[point.vertex] = true;
        }
      }
      for (double t : {0.0, 1e-11, 0.1, 0.5, 0.9, 1.0}) {
        at.push_back({0, t, 0});
        at.push_back({4 * (faces - 1), 0, t});
      }
      Cage moved = cage;
      Random random(faces);
      for (int v = 0; v < cage.vertexCount(); ++v) {
        if (!on_boundary[v]) moved.positions.row(v) += random.vector(1);
      }
      const Evaluation a = limitSurface(cage).evaluate(at), b = limitSurface(moved).evaluate(at);
      const double size = diagonal(moved.positions) + diagonal(cage.positions);
      for (int i = 0; i < static_cast<int>(at.size()); ++i) {
        EXPECT_LE((a.position.row(i) - b.position.row(i)).norm(), kPositionError * size)
            << faces << " faces, " << describe(at[i]);
      }
    }
  }
}

TEST(Symmetry, NeighbouringTilesMeet) {
  // The surface is piecewise polynomial with borders at 2^-n. Across a border, values differ by no
  // more than by the step between neighbouring doubles.
  for (const auto& [name, cage] : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    const CornerPoints corners(cage);
    for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
      std::vector<Location> at;
      for (int n = 1; n <= 40; ++n) {
        const double seam = std::ldexp(1.0, -n);
        for (double along : {0.6 * seam, seam, 0.0}) {
          for (double u : {std::nextafter(seam, 0), seam, std::nextafter(seam, 1)}) {
            at.push_back({face, u, along});
          }
          for (double v : {std::nextafter(seam, 0), seam, std::nextafter(seam, 1)}) {
            at.push_back({face, along, v});
          }
        }
      }
      const Evaluation e = surface.evaluate(at, Derivatives::second);
      const double size = diagonal(cage.positions);
      for (int i = 0; i < static_cast<int>(at.size()); i += 3) {
        for (int side : {0, 2}) {
          const std::string where = name + ", " + describe(at[i + side]);
          EXPECT_LE((e.position.row(i + side) - e.position.row(i + 1)).norm(),
                    2 * kPositionError * size)
              << where;
          for (const Points* d : {&e.du, &e.dv}) {
            EXPECT_LE((d->row(i + side) - d->row(i + 1)).norm(),
                      2 * kFirstDerivativeError * std::max(size, d->row(i + 1).norm()))
                << where;
          }
          for (const Points* d : {&e.duu, &e.duv, &e.dvv}) {
            // The step changes a second derivative by up to the third one's size, which is 2^n
            // times its own.
            EXPECT_LE((d->row(i + side) - d->row(i + 1)).norm(),
                      2 * kSecondDerivativeError * std::max(size, d->row(i + 1).norm()))
                << where;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
