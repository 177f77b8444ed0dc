// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <optional>

#include "limitsurf/pi.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

using Frame = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Frame frameOf(const LimitSurface& surface, const Location& at) {
  const std::vector<Location> one = {at};
  const auto rows = surface.frames(one);
  return Eigen::Map<const Frame>(rows.data());
}

/// Tangent along du, normal x tangent, normal.
Frame frameFrom(const Vector3& du, const Vector3& normal) {
  Frame frame;
  frame.col(0) = du.normalized();
  frame.col(2) = normal;
  frame.col(1) = normal.cross(frame.col(0));
  return frame;
}

TEST(Frames, AreRotationsEverywhere) {
  for (const Cage& cage : {cross(), cube(), perturbed(valenceTwo(), 0.1, 1), fan(5, false, 2),
                           fan(4, false, 3), fan(9, true, 4), mixture(5), ngon(5, 6)}) {
    const LimitSurface surface = limitSurface(cage);
    std::vector<Location> at;
    Random random(1);
    for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
      at += anywhere(face, 3, random);
      for (int corner = 0; corner < 4; ++corner) {
        at.push_back(cornerLocation(face, corner));
        at += shells(face, corner, {3, 20, 40});
      }
    }
    const auto frames = surface.frames(at);
    ASSERT_EQ(frames.rows(), static_cast<int>(at.size()));
    for (int i = 0; i < frames.rows(); ++i) {
      const Frame frame = Eigen::Map<const Frame>(frames.data() + 9 * i);
      EXPECT_LE((frame.transpose() * frame - Frame::Identity()).cwiseAbs().maxCoeff(), 1e-14)
          << describe(at[i]);
      EXPECT_NEAR(frame.determinant(), 1, 1e-14) << describe(at[i]);
    }
  }
}

TEST(Frames, FollowDuAndTheNormal) {
  const Cage cage = mixture(6);
  const LimitSurface surface = limitSurface(cage);
  std::vector<Location> at;
  Random random(1);
  for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
    at += anywhere(face, 10, random);
  }
  const Evaluation e = surface.evaluate(at, Derivatives::first, true);
  const auto frames = surface.frames(at);
  for (int i = 0; i < frames.rows(); ++i) {
    const Frame frame = Eigen::Map<const Frame>(frames.data() + 9 * i);
    EXPECT_LE((frame - frameFrom(e.du.row(i), e.normal.row(i))).norm(), 1e-14) << describe(at[i]);
  }
}

/// The frame on the diagonal towards (0, 0), at a depth at which it does not change any more. There
/// is none where this would take too long: where leading eigenvalues are close to each other or
/// have a Jordan block.
std::optional<Frame> diagonalLimit(DeepSubdivision& deep, int face) {
  const auto at = [&](int n) {
    const double t = std::ldexp(1.0, -n);
    const Truth truth = deep.evaluate({face, t, t});
    return frameFrom(truth[kDu], truth[kNormal]);
  };
  // The error shrinks geometrically: at twice the depth it is squared.
  const Frame halfway = at(225), limit = at(450);
  if ((halfway - limit).norm() > 1e-6) return std::nullopt;
  return limit;
}

/// Compares the frame at the vertex with the limit along the diagonal, where subdivision reaches
/// that limit (it does not where two leading eigenvalues are close to each other).
void compareAtVertices(const std::vector<Cage>& fans, int least_compared) {
  int compared = 0;
  double worst = 0;
  for (const Cage& cage : fans) {
    const int faces = static_cast<int>(cage.faces.size()) / 4;
    const LimitSurface surface = limitSurface(cage);
    DeepSubdivision deep(cage);
    for (int sector = 0; sector < faces; ++sector) {
      const std::optional<Frame> limit = diagonalLimit(deep, 4 * sector);
      if (!limit) continue;
      ++compared;
      const double error = (frameOf(surface, {4 * sector, 0, 0}) - *limit).norm();
      worst = std::max(worst, error);
      EXPECT_LE(error, 1e-10) << faces << " faces, sector " << sector << ": is\n"
                              << frameOf(surface, {4 * sector, 0, 0}) << "\nshould be\n"
                              << *limit;
    }
  }
  std::printf("  %d frames compared, worst %.1e\n", compared, worst);
  EXPECT_GE(compared, least_compared);
}

std::vector<Cage> fans(bool closed, Boundary boundary, const std::vector<int>& faces) {
  std::vector<Cage> cages;
  for (int count : faces) {
    cages.push_back(fan(count, closed, 10 + count));
    cages.back().options.boundary = boundary;
  }
  return cages;
}

/// Closed fans with sharp edges at the given spokes, the vertex sharp or not.
std::vector<Cage> sharpFans(const std::vector<int>& spokes, bool sharp_vertex,
                            const std::vector<int>& faces) {
  std::vector<Cage> cages = fans(true, Boundary::smooth, faces);
  for (Cage& cage : cages) {
    const int vertex = cage.faces[0][0];
    for (int spoke : spokes) sharpenEdge(cage, vertex, cage.faces[4 * spoke][1], 10);
    if (sharp_vertex) sharpenVertex(cage, vertex, 10);
  }
  return cages;
}

TEST(SlowFrames, AtInteriorVerticesAreTheLimitAlongTheDiagonal) {
  compareAtVertices(fans(true, Boundary::smooth, {3, 4, 5, 6, 7, 8, 9}), 20);
}

TEST(Frames, AtSmoothBoundariesAreTheLimitAlongTheDiagonal) {
  compareAtVertices(fans(false, Boundary::smooth, {2, 3, 5, 6, 7}), 15);
}

TEST(Frames, AtPinnedBoundariesAreTheLimitAlongTheDiagonal) {
  compareAtVertices(fans(false, Boundary::corners, {1, 2, 3, 5, 6, 7}), 10);
}

TEST(Frames, AtDartsAreTheLimitAlongTheDiagonal) {
  compareAtVertices(sharpFans({0}, false, {3, 4, 5, 6, 7, 8, 9, 10, 12}), 7);
}

TEST(Frames, AtConesAreTheLimitAlongTheDiagonal) {
  compareAtVertices(sharpFans({}, true, {3, 4, 5, 6, 7}), 15);
}

TEST(Frames, AtCreasesAreTheLimitAlongTheDiagonal) {
  compareAtVertices(sharpFans({0, 2}, false, {5, 6, 7}), 10);
  compareAtVertices(sharpFans({0, 3}, false, {5, 6, 7}), 10);
}

TEST(Frames, AtSharpCornersAreTheLimitAlongTheDiagonal) {
  compareAtVertices(sharpFans({0}, true, {3, 5, 6}), 5);
  compareAtVertices(sharpFans({0, 1, 3}, false, {5, 6, 7, 9}), 6);
}

/// The known masks of Catmull and Clark's tangents at a vertex of n quads.
TEST(Frames, AtVerticesWithManyFacesHaveTheNormalOfTheTangentMasks) {
  for (const int count : {5, 127, 128, 129, 300}) {
    const Cage cage = fan(count, true, 3);
    const double turn = 2 * kPi<double> / count;
    const double edges =
        1 + std::cos(turn) + std::cos(turn / 2) * std::sqrt(2 * (9 + std::cos(turn)));
    Vector3 tangents[2] = {Vector3::Zero(), Vector3::Zero()};
    for (int i = 0; i < count; ++i) {
      const std::vector<int>& face = cage.faces[4 * i];  // the vertex, an edge's end, across, next
      const Vector3 edge = cage.positions.row(face[1]), across = cage.positions.row(face[2]);
      for (int t = 0; t < 2; ++t) {
        const auto wave = [&](int k) { return t == 0 ? std::cos(turn * k) : std::sin(turn * k); };
        tangents[t] += edges * wave(i) * edge + (wave(i) + wave(i + 1)) * across;
      }
    }
    const Vector3 normal = tangents[0].cross(tangents[1]).normalized();
    const LimitSurface surface = limitSurface(cage);
    for (const int sector : {0, count / 3, count - 1}) {
      const Location at{4 * sector, 0, 0};
      const Vector3 found = surface.evaluate({&at, 1}, Derivatives::first, true).normal.row(0);
      EXPECT_LE((found - normal).norm(), 1e-10) << count << " faces, sector " << sector;
      EXPECT_LE((frameOf(surface, at).col(2) - normal).norm(), 1e-10) << count;
    }
  }
}

/// The ring of a vertex on a smooth boundary, relative to the vertex and in a unit of its own.
struct BoundaryRing {
  std::vector<Vector3> edges, faces;

  /// Catmull and Clark's rules.
  void subdivide() {
    const std::size_t count = faces.size();
    const Vector3 vertex = (edges.front() + edges.back()) / 8;
    for (std::size_t i = 0; i < count; ++i) faces[i] = (edges[i] + edges[i + 1] + faces[i]) / 4;
    for (std::size_t i = 1; i < count; ++i) edges[i] = (edges[i] + faces[i - 1] + faces[i]) / 4;
    edges.front() /= 2;
    edges.back() /= 2;
    double largest = 0;
    for (auto* points : {&edges, &faces}) {
      for (Vector3& point : *points) {
        point -= vertex;
        largest = std::max(largest, point.norm());
      }
    }
    for (auto* points : {&edges, &faces}) {
      for (Vector3& point : *points) point /= largest;
    }
  }

  /// The part of the edges that varies as a sine with so many half waves.
  Vector3 wave(int half_waves) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(faces.size());
      sum += std::sin(kPi<double> * half_waves * share) * edges[i];
    }
    return sum;
  }
};

/// Subdivision leaves the two slowest sines of a large sector, which have the same normal on all of
/// its faces. Beside the boundary both are small and nearly parallel.
TEST(Frames, AtBoundaryVerticesWithManyFacesHaveTheNormalOfTheSlowestWaves) {
  for (const int count : {12, 127, 560, 2000, 20000}) {
    const Cage cage = fan(count, false, 3);
    BoundaryRing ring;
    const Vector3 vertex = cage.positions.row(cage.faces[0][0]);
    for (int i = 0; i < count; ++i) {
      const std::vector<int>& face = cage.faces[4 * i];  // the vertex, an edge's end, across, next
      ring.edges.push_back(Vector3(cage.positions.row(face[1])) - vertex);
      ring.faces.push_back(Vector3(cage.positions.row(face[2])) - vertex);
    }
    ring.edges.push_back(Vector3(cage.positions.row(cage.faces[4 * (count - 1)][3])) - vertex);
    for (int step = 0; step < 160; ++step) ring.subdivide();
    const Vector3 normal = ring.wave(2).cross(ring.wave(1)).normalized();
    const LimitSurface surface = limitSurface(cage);
    for (const int sector : {0, 1, count / 3, count - 2, count - 1}) {
      const Vector3 found = frameOf(surface, {4 * sector, 0, 0}).col(2);
      EXPECT_LE((found - normal).norm(), 1e-8) << count << " faces, sector " << sector;
    }
  }
}

TEST(Frames, AtOtherCornersAreTheSameAsSeenFromTheVertex) {
  // If the face's vertices are turned, so that the vertex lies at another corner, du becomes dv and
  // so on, while the normal stays the same.
  const Cage cage = fan(5, true, 3);
  const Frame frame = frameOf(limitSurface(cage), {0, 0, 0});
  for (int turn = 1; turn < 4; ++turn) {
    Cage turned = cage;
    std::rotate(turned.faces[0].begin(), turned.faces[0].begin() + turn, turned.faces[0].end());
    const int corner = 4 - turn;
    const Frame other = frameOf(limitSurface(turned), cornerLocation(0, corner));
    EXPECT_LE((other.col(2) - frame.col(2)).norm(), 1e-12) << "turned by " << turn;
    DeepSubdivision deep(turned);
    const Location vertex = cornerLocation(0, corner);
    const double t = 0x1p-50;
    const Truth truth = deep.evaluate({0, std::abs(vertex.u - t), std::abs(vertex.v - t)});
    EXPECT_LE((other - frameFrom(truth[kDu], truth[kNormal])).norm(), 1e-6) << "turned " << turn;
  }
}

}  // namespace
}  // namespace limitsurf::test
