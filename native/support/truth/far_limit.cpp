// SPDX-License-Identifier: Apache-2.0
#include "support/truth/far_limit.h"

#include "support/truth/far_refinement.h"

namespace limitsurf::test {

namespace Far = OpenSubdiv::Far;

FarLimit farLimit(const Cage& cage, int level) {
  const FarRefinement refinement(cage, level);
  const std::vector<FarPrimvar>& points = refinement.points;
  std::vector<FarPrimvar> limit(points.size()), tangent1(points.size()), tangent2(points.size());
  Far::PrimvarRefinerReal<double>(*refinement.refiner).Limit(points, limit, tangent1, tangent2);

  const Far::TopologyLevel& last = refinement.refiner->GetLevel(level);
  FarLimit result;
  const int count = 4 * last.GetNumFaces();
  result.position.resize(count, 3);
  result.tangent1.resize(count, 3);
  result.tangent2.resize(count, 3);
  for (int face = 0; face < last.GetNumFaces(); ++face) {
    const Far::ConstIndexArray vertices = last.GetFaceVertices(face);
    for (int corner = 0; corner < 4; ++corner) {
      const FarSquare& square = refinement.squares[face];
      const Location unit = cornerLocation(square.face, corner);
      const int row = 4 * face + corner, vertex = vertices[corner];
      result.at.push_back(
          {square.face, square.u + square.size * unit.u, square.v + square.size * unit.v});
      result.position.row(row) = limit[vertex].value;
      result.tangent1.row(row) = tangent1[vertex].value;
      result.tangent2.row(row) = tangent2[vertex].value;
    }
  }
  return result;
}

}  // namespace limitsurf::test
