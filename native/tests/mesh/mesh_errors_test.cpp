// SPDX-License-Identifier: Apache-2.0
//
// Every check of ControlMesh, with input that must fail and input that just does not.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/cages/meshes.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

using Indices = std::vector<std::int64_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Points somePoints(int count) {
  Points points(count, 3);
  for (int i = 0; i < count; ++i) points.row(i) << std::cos(i), std::sin(i), 0.1 * i;
  return points;
}

/// Two quads over six vertices.
const Indices kSizes = {4, 4};
const Indices kVertices = {0, 1, 4, 3, 1, 2, 5, 4};

ControlMesh make(MeshOptions options = {}) {
  return ControlMesh(somePoints(6), kSizes, kVertices, std::move(options));
}

void expectRefused(const Points& positions, const Indices& sizes, const Indices& vertices,
                   const std::vector<std::string>& parts) {
  expectThrow<MeshError>([&] { ControlMesh(positions, sizes, vertices); }, parts);
}

TEST(MeshErrors, AreValueErrors) {
  EXPECT_TRUE((std::is_base_of_v<std::invalid_argument, MeshError>));
  EXPECT_TRUE((std::is_base_of_v<std::invalid_argument, LocationError>));
}

TEST(MeshErrors, AcceptsASoundMesh) {
  const ControlMesh mesh = make();
  EXPECT_EQ(mesh.vertexCount(), 6);
  EXPECT_EQ(mesh.faceCount(), 2);
  EXPECT_EQ(mesh.faceSize(1), 4);
  EXPECT_EQ(mesh.faceVertices(1)[0], 1);
  EXPECT_EQ(mesh.faceSizes(), (std::vector<int>{4, 4}));
}

TEST(MeshErrors, SizesAddUp) {
  expectRefused(somePoints(6), {4, 3}, kVertices, {"7", "8"});
  expectRefused(somePoints(6), {4, 4, 4}, kVertices, {"12", "8"});
  expectRefused(somePoints(6), {}, kVertices, {"0", "8"});
  expectRefused(somePoints(6), {4, 4}, {}, {"8", "0"});
}

TEST(MeshErrors, SizesAreAtLeastThree) {
  expectRefused(somePoints(6), {4, 2, 2}, kVertices, {"face 1", "2"});
  expectRefused(somePoints(6), {4, 4, 0}, kVertices, {"face 2", "0"});
  expectRefused(somePoints(6), {9, -1}, kVertices, {"face 1", "-1"});
  expectRefused(somePoints(6), {std::numeric_limits<std::int64_t>::min(), 4}, kVertices,
                {"face 0"});
}

TEST(MeshErrors, SizesDoNotOverflow) {
  // These sums overflow 32 or 64 bits and give the right number again.
  const std::int64_t huge = std::int64_t(1) << 62;
  expectRefused(somePoints(6), {huge, huge, huge, huge, 4, 4}, kVertices, {"face 0"});
  expectRefused(somePoints(6), {(std::int64_t(1) << 32) + 4, 4}, kVertices,
                {"face 0", "4294967300"});
}

TEST(MeshErrors, SizesAreAtMost65535) {
  const int limit = 65535;
  Indices vertices(limit);
  for (int i = 0; i < limit; ++i) vertices[i] = i;
  EXPECT_EQ(ControlMesh(somePoints(limit), {limit}, vertices).faceSize(0), limit);
  vertices.push_back(limit);
  expectRefused(somePoints(limit + 1), {limit + 1}, vertices, {"face 0", "65536", "65535"});
}

TEST(MeshErrors, IndicesAreInRange) {
  for (const std::int64_t bad :
       {std::int64_t(-1), std::int64_t(6), std::int64_t(1) << 32, std::int64_t(1) << 40,
        -(std::int64_t(1) << 32), std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::min()}) {
    Indices vertices = kVertices;
    vertices[6] = bad;
    expectRefused(somePoints(6), kSizes, vertices, {"face 1", std::to_string(bad), "6"});
  }
}

TEST(MeshErrors, PositionsAreFinite) {
  for (double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Points positions = somePoints(6);
      positions(4, axis) = bad;
      expectRefused(positions, kSizes, kVertices, {"vertex 4", std::isnan(bad) ? "nan" : "inf"});
    }
  }
}

TEST(MeshErrors, ValencesAreAtMost65535) {
  const Cage cage = pole(65536);
  expectThrow<MeshError>([&] { limitSurface(cage); }, {"vertex 0", "65535"});
}

TEST(MeshErrors, SharpnessIsNotNegativeOrNaN) {
  for (double bad : {-1.0, -1e-300, kNan, -kInfinity}) {
    MeshOptions options;
    options.edge_sharpness = {{{0, 1}, {1, 4}}, {0, bad}};
    expectThrow<MeshError>([&] { make(options); }, {"edge", "1", "4"});
    options = {};
    options.vertex_sharpness = {{2, 3}, {0, bad}};
    expectThrow<MeshError>([&] { make(options); }, {"vertex 3"});
  }
}

TEST(MeshErrors, SharpnessIsAnyOtherNumber) {
  for (double value : {0.0, 1e-300, 0.5, 9.999, 10.0, 1e300, kInfinity}) {
    MeshOptions options;
    options.edge_sharpness = {{{1, 4}}, {value}};
    options.vertex_sharpness = {{3}, {value}};
    EXPECT_EQ(make(options).options().edge_sharpness.values[0], value);
    EXPECT_TRUE(LimitSurface(make(options)).refused().empty());
  }
}

TEST(MeshErrors, SharpnessOfZeroIsNothing) {
  MeshOptions options;
  options.edge_sharpness = {{{4, 1}}, {0}};
  options.vertex_sharpness = {{3}, {0}};
  EXPECT_EQ(make(options).faceCount(), 2);
}

TEST(MeshErrors, SharpEdgesAreTheMeshs) {
  for (const auto& edge : {std::pair<std::int64_t, std::int64_t>(0, 4),
                           {0, 0},
                           {0, 6},
                           {-1, 0},
                           {0, std::int64_t(1) << 40},
                           {(std::int64_t(1) << 32) + 1, 4}}) {
    MeshOptions options;
    options.edge_sharpness = {{edge}, {0}};
    expectThrow<MeshError>([&] { make(options); },
                           {"edge", std::to_string(edge.first), std::to_string(edge.second)});
  }
}

TEST(MeshErrors, SharpVerticesAreTheMeshs) {
  for (std::int64_t vertex : {std::int64_t(-1), std::int64_t(6), std::int64_t(1) << 40}) {
    MeshOptions options;
    options.vertex_sharpness = {{vertex}, {0}};
    expectThrow<MeshError>([&] { make(options); }, {"vertex " + std::to_string(vertex)});
  }
}

TEST(MeshErrors, SharpnessHasAsManyValuesAsPlaces) {
  MeshOptions options;
  options.edge_sharpness = {{{0, 1}, {1, 4}}, {0}};
  expectThrow<MeshError>([&] { make(options); }, {"2", "1"});
  options = {};
  options.vertex_sharpness = {{1}, {0, 0}};
  expectThrow<MeshError>([&] { make(options); }, {"1", "2"});
}

TEST(MeshErrors, HolesAreFaces) {
  for (std::int64_t hole : {std::int64_t(-1), std::int64_t(2), std::int64_t(1) << 40}) {
    MeshOptions options;
    options.holes = {1, hole};
    expectThrow<MeshError>([&] { make(options); }, {"hole", std::to_string(hole)});
  }
}

TEST(MeshErrors, AMeshWithoutFacesHasNoSurface) {
  expectThrow<MeshError>([] { LimitSurface(ControlMesh(Points(0, 3), {}, {})); }, {});
  expectThrow<MeshError>([] { LimitSurface(ControlMesh(somePoints(5), {}, {})); }, {});
}

TEST(MeshErrors, IsolatedVerticesChangeNothing) {
  Cage cage = perturbed(grid(2, 2), 0.1, 1);
  const std::vector<Location> at = {{0, 0.3, 0.4}, {3, 1, 1}};
  const Evaluation plain = limitSurface(cage).evaluate(at);
  cage.positions.conservativeResize(cage.vertexCount() + 2, 3);
  cage.positions.bottomRows(2).setConstant(100);
  const LimitSurface surface = limitSurface(cage);
  EXPECT_EQ(surface.evaluate(at).position, plain.position);
  EXPECT_TRUE(surface.refused().empty());
  EXPECT_EQ(surface.vertexLocations().back().face, -1);
}

}  // namespace
}  // namespace limitsurf::test
