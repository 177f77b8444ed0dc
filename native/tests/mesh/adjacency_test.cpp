// SPDX-License-Identifier: Apache-2.0
//
// The adjacency and the sharpness that the library finds itself, against OpenSubdiv's Far.
#include "limitsurf/mesh/adjacency.h"

#include <gtest/gtest.h>

#include "limitsurf/mesh/topology.h"
#include "support/cages/benchmark_cages.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

std::vector<Cage> manifoldCages() {
  std::vector<Cage> cages = {grid(3, 4),       cross(),          everyClassCage(), polygonsCage(),
                             interiorEvCage(), boundaryEvCage(), fan(2, true, 1),  fan(7, true, 2),
                             fan(1, false, 3), fan(6, false, 4), mixture(21)};
  Cage sharp = largeCage(12);
  Random random(5);
  for (const auto& face : std::vector<std::vector<int>>(sharp.faces)) {
    sharpenEdge(sharp, face[0], face[1], random.uniform(0, 12));
    sharp.options.vertex_sharpness.vertices.push_back(face[2]);
    sharp.options.vertex_sharpness.values.push_back(3);
  }
  cages.push_back(sharp);
  cages.push_back(grid(2, 2));
  cages.back().options.boundary = Boundary::corners;
  return cages;
}

TEST(Adjacency, IsThatOfFarOnManifoldMeshes) {
  int twins = 0;
  for (const Cage& cage : manifoldCages()) {
    const ControlMesh mesh = controlMesh(cage);
    const Topology topology(mesh);
    ASSERT_TRUE(topology.isManifold());
    const Adjacency& ours = topology.adjacency();
    const auto& far = topology.level();
    for (int face = 0; face < mesh.faceCount(); ++face) {
      for (int side = 0; side < mesh.faceSize(face); ++side) {
        const int corner = mesh.firstCorner(face) + side, edge = far.GetFaceEdges(face)[side];
        ASSERT_EQ(ours.face(corner), face);
        const auto faces = far.GetEdgeFaces(edge);
        const auto sides = far.GetEdgeFaceLocalIndices(edge);
        if (faces.size() < 2) {
          EXPECT_EQ(ours.twins[corner], -1);
          continue;
        }
        const int other = faces[0] == face && sides[0] == side ? 1 : 0;
        EXPECT_EQ(ours.twins[corner], mesh.firstCorner(faces[other]) + sides[other]);
        EXPECT_EQ(topology.hasSharpness() ? topology.sideSharpness()[corner] : 0,
                  far.GetEdgeSharpness(edge));
        ++twins;
      }
    }
    for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
      const auto faces = far.GetVertexFaces(vertex);
      const Adjacency::Fan& fan = ours.fans[vertex];
      EXPECT_EQ(fan.faces, faces.size());
      EXPECT_EQ(fan.closed, !far.IsVertexBoundary(vertex));
      EXPECT_EQ(topology.vertexSharpness() ? topology.vertexSharpness()[vertex] : 0,
                far.GetVertexSharpness(vertex));
      if (!faces.empty()) {
        EXPECT_EQ(fan.first, mesh.firstCorner(faces[0]) + far.GetVertexFaceLocalIndices(vertex)[0]);
      }
    }
  }
  EXPECT_GT(twins, 10000);
}

TEST(Adjacency, IsNotFoundWhereAMeshIsNotManifold) {
  const auto withFaces = [](int vertices, std::vector<std::vector<int>> faces) {
    Cage cage;
    cage.positions = Points::Random(vertices, 3);
    cage.faces = std::move(faces);
    return cage;
  };
  const Cage cages[] = {
      withFaces(8, {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}}),  // an edge with three faces
      withFaces(6, {{0, 1, 2, 3}, {0, 1, 4, 5}}),                // opposite winding
      withFaces(7, {{0, 1, 2, 3}, {0, 4, 5, 6}}),                // two fans at a vertex
      withFaces(9,
                {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}}),  // two closed
      withFaces(9, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5, 6}}),  // an open and a closed one
      withFaces(3, {{0, 1, 2, 1}}),                                   // a vertex named twice
      withFaces(4, {{0, 1, 1, 2}, {0, 2, 3}}),                        // an edge without length
      withFaces(4, {{0, 1, 2, 3}, {0, 1, 2, 3}}),                     // a face given twice
  };
  for (const Cage& cage : cages) {
    const ControlMesh mesh = controlMesh(cage);
    EXPECT_FALSE(Adjacency::ofManifold(mesh));
    EXPECT_FALSE(Topology(mesh).isManifold());
  }
}

}  // namespace
}  // namespace limitsurf::test
