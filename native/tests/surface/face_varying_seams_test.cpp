// SPDX-License-Identifier: Apache-2.0
//
// Channels whose seams meet edges of different sharpness: what lies beyond a seam counts in how
// sharpness decays there. The truth is OpenSubdiv's own refinement of the channel until all
// sharpness has decayed, and its limit masks on the plain mesh that the rest is.
#include <gtest/gtest.h>

#include <cstdio>

#include "limitsurf/mesh/face_varying_mesh.h"
#include "limitsurf/surface/surface_data.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/truth/channels.h"
#include "support/truth/far_limit.h"
#include "support/truth/far_refinement.h"

namespace limitsurf::test {
namespace {

constexpr int kLevels = 4;  // sharpness up to 3 has decayed by then

/// Sums of a few of these are exact in single precision, so that the order in which OpenSubdiv adds
/// them does not matter.
const std::vector<double> kSharpness = {0.5, 0.75, 1, 1.25, 1.5, 2, 2.75, 3};

FaceVaryingMesh derivedMesh(const Cage& cage, const Channel& channel, Interpolation rule) {
  const ControlMesh mesh = controlMesh(cage);
  return faceVaryingMesh(mesh, Topology(mesh), channel.indices, channel.value_count, rule);
}

/// A channel whose sharpness has decayed, as a cage.
Cage settledChannel(const Cage& cage, const RefinedChannel& refined, Interpolation rule) {
  const FaceVaryingMesh derived = derivedMesh(cage, refined.channel, rule);
  EXPECT_TRUE(derived.seams.averaged_edges.empty() && derived.seams.corners.empty());
  Cage result;
  result.options = derived.mesh.options();
  result.positions.resize(derived.mesh.vertexCount(), 3);
  for (int v = 0; v < derived.mesh.vertexCount(); ++v) {
    result.positions.row(v) = refined.values.row(derived.values[v]);
  }
  for (int face = 0; face < derived.mesh.faceCount(); ++face) {
    const Span<int> vertices = derived.mesh.faceVertices(face);
    result.faces.emplace_back(vertices.begin(), vertices.end());
  }
  return result;
}

/// The largest error of the channel's limit at the corners of the refined faces.
double limitError(const Cage& cage, const Channel& channel, Interpolation rule, Random& random) {
  const DataRows values = randomRows(channel.value_count, 3, random.bits());
  const FarRefinement refinement(cage, kLevels);
  const RefinedChannel refined = subdivided(cage, kLevels, channel, values, rule);
  const FarLimit far = farLimit(settledChannel(subdivided(cage, kLevels), refined, rule), 0);
  std::vector<Location> at;
  for (const FarSquare& square : refinement.squares) {
    for (int corner = 0; corner < 4; ++corner) {
      const Location unit = cornerLocation(0, corner);
      at.push_back({square.face, square.u + square.size * unit.u, square.v + square.size * unit.v});
    }
  }
  const SurfaceData data = limitSurface(cage).faceVarying(values, channel.indices, rule);
  return (data.evaluate(at).value - DataRows(far.position)).cwiseAbs().maxCoeff();
}

/// Whether no vertex has more than three sharp edges, so that averages are exact as well.
bool hasFewSharpEdges(const Cage& cage) {
  std::vector<int> count(cage.vertexCount(), 0);
  for (const auto& [a, b] : cage.options.edge_sharpness.edges) {
    if (++count[a] > 3 || ++count[b] > 3) return false;
  }
  return true;
}

/// Whether the sharpness of an edge falls from above 1 to 0 at one of its ends, as Chaikin's rule
/// may have it: there OpenSubdiv extrapolates, and its documentation does not.
bool extrapolates(const Cage& cage) {
  const FarRefinement far(cage, kLevels);
  for (int level = 0; level < kLevels; ++level) {
    const auto &parent = far.refiner->GetLevel(level), &child = far.refiner->GetLevel(level + 1);
    for (int edge = 0; edge < parent.GetNumEdges(); ++edge) {
      if (parent.GetEdgeSharpness(edge) <= 1) continue;
      for (const int half : parent.GetEdgeChildEdges(edge)) {
        if (half >= 0 && child.GetEdgeSharpness(half) == 0) return true;
      }
    }
  }
  return false;
}

void compareChannels(int rounds) {
  double worst = 0;
  int channels = 0, averaged = 0, corners = 0;
  const NamedCages cages = {{"grid", grid(4, 3)},
                            {"cube", cube()},
                            {"torus", torus(5, 4)},
                            {"prism", prism(5, true)},
                            {"closed fan", fan(5, true, 1)},
                            {"open fan", fan(4, false, 1)},
                            {"hexagon", ngon(6, 1)},
                            {"mixture", mixture(1)}};
  std::uint64_t seed = 0;
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [name, smooth] : cages) {
      Random random(++seed);
      Cage cage = smooth;
      do {
        cage.options = smooth.options;
        cage.options.creasing = round % 3 == 2 ? Creasing::uniform : Creasing::chaikin;
        sharpenAtRandom(cage, random, 4, 1000, kSharpness);
      } while (!hasFewSharpEdges(cage) || extrapolates(cage));
      const Channel channel = randomChannel(cage, random);
      for (const auto& [rule, interpolation] : kInterpolations) {
        if (interpolation == Interpolation::all) continue;
        const FaceVaryingMesh derived = derivedMesh(cage, channel, interpolation);
        averaged += !derived.seams.averaged_edges.empty();
        corners += !derived.seams.corners.empty();
        ++channels;
        const double error = limitError(cage, channel, interpolation, random);
        EXPECT_LE(error, kPositionError) << name << ", round " << round << ", " << rule;
        worst = std::max(worst, error);
      }
    }
  }
  std::printf("  worst value %.2e; of %d channels %d with averages, %d with corners beyond seams\n",
              worst, channels, averaged, corners);
  EXPECT_GE(averaged, channels / 4);
}

TEST(FaceVaryingSeams, LimitsAreOpenSubdivs) { compareChannels(3); }
TEST(SlowFaceVaryingSeams, LimitsAreOpenSubdivs) { compareChannels(60); }

TEST(FaceVaryingSeams, CreasesAcrossAndAlongASeam) {
  Cage cage = grid(5, 2);
  cage.options.creasing = Creasing::chaikin;
  const auto at = [&](double x, double y) {
    int vertex = 0;
    while (cage.positions(vertex, 0) != x || cage.positions(vertex, 1) != y) ++vertex;
    return vertex;
  };
  sharpenEdge(cage, at(1, 0), at(1, 1), 3);
  sharpenEdge(cage, at(0, 1), at(1, 1), 1.5);
  Channel channel;  // the seam runs between the rows of faces
  for (std::size_t face = 0; face < cage.faces.size(); ++face) {
    for (const int v : cage.faces[face]) channel.indices.push_back(v + (face < 5 ? 0 : 18));
  }
  channel.value_count = 36;
  Random random(1);
  for (const auto& [rule, interpolation] : kInterpolations) {
    if (interpolation == Interpolation::all) continue;
    EXPECT_FALSE(derivedMesh(cage, channel, interpolation).seams.averaged_edges.empty()) << rule;
    EXPECT_LE(limitError(cage, channel, interpolation, random), kPositionError) << rule;
  }
}

TEST(FaceVaryingSeams, ACornerMayLastAsNoFloatDoes) {
  // Three edges on one side whose average after the first step has more bits than a sharpness has.
  Cage cage = fan(9, true, 1);
  Channel channel;
  int face = 0;
  for (const std::vector<int>& vertices : cage.faces) {
    const bool beyond = face++ >= 28;  // the last two sectors
    for (int v : vertices) channel.indices.push_back(beyond ? cage.vertexCount() + v : v);
  }
  channel.value_count = 2 * cage.vertexCount();
  sharpenEdge(cage, 0, cage.faces[4][1], 1.5);
  sharpenEdge(cage, 0, cage.faces[8][1], 1.25);
  sharpenEdge(cage, 0, cage.faces[12][1], 1.5);
  Random random(1);
  for (const Interpolation rule : {Interpolation::corners_plus1, Interpolation::corners_plus2}) {
    EXPECT_EQ(derivedMesh(cage, channel, rule).seams.corners.size(), 1u);
    EXPECT_LE(limitError(cage, channel, rule, random), kPositionError);
  }
}

}  // namespace
}  // namespace limitsurf::test
