// SPDX-License-Identifier: Apache-2.0
//
// The control mesh derived from a face-varying channel, refined as positions are, against
// OpenSubdiv's own refinement of the channel.
#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "limitsurf/mesh/face_varying_mesh.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/throws.h"
#include "support/truth/channels.h"

namespace limitsurf::test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int kLevels = 4;           // sharpness up to 3 has decayed by then
constexpr double kRounding = 1e-15;  // of values in [-1, 1]

struct Value {
  double x = 0;

  void Clear() { x = 0; }
  void AddWithWeight(const Value& other, double weight) { x += weight * other.x; }
};

std::vector<float> sharpness(const std::vector<double>& values) {
  std::vector<float> result;
  for (double value : values) result.push_back(static_cast<float>(std::min(value, 10.0)));
  return result;
}

/// OpenSubdiv's uniform refinement of the mesh, with the channel if there is one.
std::unique_ptr<Far::TopologyRefiner> refined(const ControlMesh& mesh, const Channel& channel = {},
                                              Interpolation interpolation = Interpolation::all) {
  const MeshOptions& o = mesh.options();
  std::vector<int> sizes = mesh.faceSizes(), crease_ends;
  for (const auto& [a, b] : o.edge_sharpness.edges) {
    crease_ends.push_back(static_cast<int>(a));
    crease_ends.push_back(static_cast<int>(b));
  }
  const std::vector<int> corners(o.vertex_sharpness.vertices.begin(),
                                 o.vertex_sharpness.vertices.end());
  const std::vector<float> creases = sharpness(o.edge_sharpness.values);
  const std::vector<float> corner_weights = sharpness(o.vertex_sharpness.values);
  const std::vector<int> indices(channel.indices.begin(), channel.indices.end());
  Far::TopologyDescriptor::FVarChannel fvar;
  fvar.numValues = channel.value_count;
  fvar.valueIndices = indices.data();
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = mesh.vertexCount();
  descriptor.numFaces = mesh.faceCount();
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = mesh.faceVertices().data();
  descriptor.numCreases = static_cast<int>(creases.size());
  descriptor.creaseVertexIndexPairs = crease_ends.data();
  descriptor.creaseWeights = creases.data();
  descriptor.numCorners = static_cast<int>(corners.size());
  descriptor.cornerVertexIndices = corners.data();
  descriptor.cornerWeights = corner_weights.data();
  descriptor.numFVarChannels = indices.empty() ? 0 : 1;
  descriptor.fvarChannels = &fvar;

  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(o.boundary == Boundary::smooth
                                          ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                          : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetTriangleSubdivision(o.triangles == Triangles::smooth ? Sdc::Options::TRI_SUB_SMOOTH
                                                                  : Sdc::Options::TRI_SUB_CATMARK);
  options.SetCreasingMethod(o.creasing == Creasing::chaikin ? Sdc::Options::CREASE_CHAIKIN
                                                            : Sdc::Options::CREASE_UNIFORM);
  using Rule = Sdc::Options::FVarLinearInterpolation;
  options.SetFVarLinearInterpolation(
      interpolation == Interpolation::none            ? Rule::FVAR_LINEAR_NONE
      : interpolation == Interpolation::corners_only  ? Rule::FVAR_LINEAR_CORNERS_ONLY
      : interpolation == Interpolation::corners_plus1 ? Rule::FVAR_LINEAR_CORNERS_PLUS1
      : interpolation == Interpolation::corners_plus2 ? Rule::FVAR_LINEAR_CORNERS_PLUS2
      : interpolation == Interpolation::boundaries    ? Rule::FVAR_LINEAR_BOUNDARIES
                                                      : Rule::FVAR_LINEAR_ALL);
  const Sdc::SchemeType scheme =
      o.scheme == Scheme::bilinear ? Sdc::SCHEME_BILINEAR : Sdc::SCHEME_CATMARK;
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(descriptor, Factory::Options(scheme, options)));
  Far::TopologyRefiner::UniformOptions uniform(kLevels);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  return refiner;
}

struct Difference {
  double worst = 0;
  bool has_seams = false;  ///< whether the derived mesh alone is not the whole channel
};

/// Marks the faces that share a vertex with a face of a vertex whose decay the derived mesh alone
/// does not have. face_varying_seams_test.cpp looks at these.
void markSeams(const FaceVaryingMesh& derived, std::vector<bool>& faces) {
  const auto at = [&](int face) { return derived.mesh.faceVertices(face); };
  std::vector<bool> near(derived.mesh.vertexCount(), false);
  for (const auto& [vertex, edges] : derived.seams.averaged_edges) near[vertex] = true;
  for (const auto& [vertex, corner] : derived.seams.corners) near[vertex] = true;
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<bool> before = near;
    for (int face = 0; face < derived.mesh.faceCount(); ++face) {
      if (std::none_of(at(face).begin(), at(face).end(), [&](int v) { return before[v]; }))
        continue;
      if (ring == 1) faces[face] = true;
      for (const int vertex : at(face)) near[vertex] = true;
    }
  }
}

/// The largest difference, over all levels and all corners of faces that the derived mesh alone
/// describes, for random values in [-1, 1].
Difference difference(const ControlMesh& mesh, const Channel& channel, Interpolation interpolation,
                      std::uint64_t seed) {
  const Topology topology(mesh);
  const FaceVaryingMesh derived =
      faceVaryingMesh(mesh, topology, channel.indices, channel.value_count, interpolation);
  const auto truth = refined(mesh, channel, interpolation), ours = refined(derived.mesh);
  const Far::PrimvarRefinerReal<double> true_values(*truth), our_values(*ours);
  Random random(seed);
  std::vector<Value> values(channel.value_count), points;
  for (Value& value : values) value.x = random.uniform(-1, 1);
  for (int value : derived.values) points.push_back(values[value]);
  double worst = 0;
  std::vector<bool> refused(mesh.faceCount(), false);
  for (const auto& [face, reason] : topology.refused()) refused[face] = true;
  markSeams(derived, refused);
  for (int l = 0; l <= kLevels; ++l) {
    const Far::TopologyLevel &a = truth->GetLevel(l), &b = ours->GetLevel(l);
    if (l > 0) {
      std::vector<bool> children(a.GetNumFaces());
      for (int face = 0; face < truth->GetLevel(l - 1).GetNumFaces(); ++face) {
        for (int child : truth->GetLevel(l - 1).GetFaceChildFaces(face)) {
          children[child] = refused[face];
        }
      }
      refused = std::move(children);
      std::vector<Value> next(a.GetNumFVarValues()), next_points(b.GetNumVertices());
      true_values.InterpolateFaceVarying(l, values, next);
      our_values.Interpolate(l, points, next_points);
      values = std::move(next);
      points = std::move(next_points);
    }
    for (int face = 0; face < a.GetNumFaces(); ++face) {
      if (refused[face]) continue;
      const auto corners = a.GetFaceFVarValues(face);
      const auto vertices = b.GetFaceVertices(face);
      for (int i = 0; i < corners.size(); ++i) {
        worst = std::max(worst, std::abs(values[corners[i]].x - points[vertices[i]].x));
      }
    }
  }
  return {worst, !derived.seams.averaged_edges.empty() || !derived.seams.corners.empty()};
}

NamedCages manyCages() {
  NamedCages cages = {{"grid", grid(4, 3)},
                      {"bow-tie", gridWithHoles(5, 5, {7, 13})},
                      {"holes", gridWithHoles(6, 5, {7, 9, 17, 22})},
                      {"cross", cross()},
                      {"cube", cube()},
                      {"tetrahedron", tetrahedron()},
                      {"torus", torus(5, 4)},
                      {"prism", prism(5, true)},
                      {"tube", prism(6, false)},
                      {"valence two", valenceTwo()},
                      {"closed fan", fan(5, true, 1)},
                      {"open fan", fan(4, false, 1)},
                      {"hexagon", ngon(6, 1)},
                      {"pole", pole(7)},
                      fansOnACrease().back(),
                      {"a vertex twice", gridWithFace({0, 1, 2, 1})}};
  for (const auto& cage : nonManifoldCages()) cages.push_back(cage);
  for (int seed = 1; seed <= 6; ++seed) {
    cages.emplace_back("mixture " + std::to_string(seed), mixture(seed));
  }
  return cages;
}

struct Tally {
  double worst = 0;
  int compared = 0, with_seams = 0;
};

/// Compares one channel in each round, with all interpolations under both boundary rules.
Tally compareAll(Creasing creasing, int edges_per_sharp, int rounds) {
  const std::vector<double> all_sharpness = {0.4, 0.75, 1, 1.25, 1.3, 2, 2.5, 3, 10, 12};
  Tally tally;
  std::uint64_t seed = 0;
  for (const auto& [name, smooth] : manyCages()) {
    for (int round = 0; round < rounds; ++round) {
      Random random(++seed);
      Cage cage = smooth;
      cage.options.creasing = creasing;
      if (edges_per_sharp > 0) {
        const bool alike = random.below(3) == 0;
        sharpenAtRandom(
            cage, random, edges_per_sharp, 4 * edges_per_sharp,
            alike ? std::vector<double>{all_sharpness[random.below(10)]} : all_sharpness);
      }
      cage.options.triangles = random.below(2) == 0 ? Triangles::smooth : Triangles::catmark;
      const Channel channel = randomChannel(cage, random);
      for (Boundary boundary : {Boundary::smooth, Boundary::corners}) {
        cage.options.boundary = boundary;
        const ControlMesh mesh = controlMesh(cage);
        for (const auto& [rule, interpolation] : kInterpolations) {
          const auto [worst, has_seams] = difference(mesh, channel, interpolation, random.bits());
          EXPECT_LE(worst, kRounding) << name << ", round " << round << ", " << rule
                                      << (boundary == Boundary::smooth ? ", smooth" : ", corners");
          tally.worst = std::max(tally.worst, worst);
          ++tally.compared;
          tally.with_seams += has_seams;
        }
      }
    }
  }
  std::printf("  worst difference %.2e; %d channels, %d only in part\n", tally.worst,
              tally.compared, tally.with_seams);
  return tally;
}

TEST(FaceVarying, RefinesAsOpenSubdivOnSmoothMeshes) {
  EXPECT_EQ(compareAll(Creasing::uniform, 0, 1).with_seams, 0);
}

TEST(FaceVarying, RefinesAsOpenSubdivBesideUniformCreases) {
  const Tally tally = compareAll(Creasing::uniform, 3, 2);
  EXPECT_LE(tally.with_seams, tally.compared / 100);
}

TEST(FaceVarying, RefinesAsOpenSubdivBesideChaikinCreases) {
  const Tally tally = compareAll(Creasing::chaikin, 6, 2);
  EXPECT_LT(tally.with_seams, tally.compared / 2);
}

TEST(SlowFaceVarying, RefinesAsOpenSubdivOnManyChannels) {
  compareAll(Creasing::uniform, 0, 20);
  compareAll(Creasing::uniform, 2, 40);
  compareAll(Creasing::chaikin, 6, 40);
}

TEST(FaceVarying, FollowsTheBilinearScheme) {
  Random random(3);
  for (auto& [name, cage] : manyCages()) {
    cage.options.scheme = Scheme::bilinear;
    const Channel channel = randomChannel(cage, random);
    for (const auto& [rule, interpolation] : kInterpolations) {
      EXPECT_LE(difference(controlMesh(cage), channel, interpolation, 1).worst, kRounding)
          << name << ", " << rule;
    }
  }
}

/// The indices of a 2x2 grid with a seam between its lower and its upper half: the values of the
/// middle row are 3, 4, 5 below and 9, 10, 11 above.
Channel halvedGrid() { return {{0, 1, 4, 3, 1, 2, 5, 4, 9, 10, 7, 6, 10, 11, 8, 7}, 12}; }

FaceVaryingMesh halved(const Cage& cage, Interpolation interpolation) {
  const ControlMesh mesh = controlMesh(cage);
  return faceVaryingMesh(mesh, Topology(mesh), halvedGrid().indices, 12, interpolation);
}

/// The sharpness of the derived vertex that has the value.
double sharpnessAt(const FaceVaryingMesh& derived, int value) {
  const VertexSharpness& sharpness = derived.mesh.options().vertex_sharpness;
  double result = 0;
  for (std::size_t i = 0; i < sharpness.vertices.size(); ++i) {
    if (derived.values[sharpness.vertices[i]] == value) result = sharpness.values[i];
  }
  return result;
}

TEST(FaceVarying, SeamsFallApart) {
  const FaceVaryingMesh derived = halved(grid(2, 2), Interpolation::none);
  EXPECT_EQ(derived.mesh.vertexCount(), 12);
  std::vector<int> values = derived.values;
  std::sort(values.begin(), values.end());
  for (int i = 0; i < 12; ++i) EXPECT_EQ(values[i], i);
  EXPECT_TRUE(derived.mesh.options().vertex_sharpness.vertices.empty());
  const Topology topology(derived.mesh);
  for (int v = 0; v < 12; ++v) EXPECT_TRUE(topology.level().IsVertexBoundary(v));
}

TEST(FaceVarying, ASideWithoutSharpEdgesStaysSharpAsLongAsTheOther) {
  Cage cage = grid(2, 2);
  sharpenEdge(cage, 1, 2, 1.75);
  for (Interpolation rule : {Interpolation::corners_plus1, Interpolation::corners_plus2}) {
    EXPECT_EQ(sharpnessAt(halved(cage, rule), 10), 1.75);
    EXPECT_EQ(sharpnessAt(halved(cage, rule), 4), 0);
  }
  EXPECT_EQ(sharpnessAt(halved(cage, Interpolation::corners_only), 10), 0);
  sharpenEdge(cage, 2, 3,
              3);  // the seam itself, so that the other side stays pinned for one more step
  EXPECT_EQ(sharpnessAt(halved(cage, Interpolation::corners_plus1), 10), 2);
}

TEST(FaceVarying, NamesIndicesOutOfRange) {
  const ControlMesh mesh = controlMesh(grid(2, 2));
  const Topology topology(mesh);
  Channel channel = halvedGrid();
  channel.indices[9] = 12;
  const auto derive = [&] {
    faceVaryingMesh(mesh, topology, channel.indices, 12, Interpolation::none);
  };
  expectThrow<MeshError>(derive, {"corner 1 of face 2", "value index 12", "12 values"});
  channel.indices[9] = -1;
  expectThrow<MeshError>(derive, {"corner 1 of face 2", "value index -1"});
  channel.indices.pop_back();
  expectThrow<MeshError>(derive, {"indices has 15", "16 face corners"});
}

}  // namespace
}  // namespace limitsurf::test
