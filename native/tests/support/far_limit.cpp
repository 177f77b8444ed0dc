// SPDX-License-Identifier: Apache-2.0
#include "support/far_limit.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace limitsurf::test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

struct Primvar {
  Eigen::RowVector3d value = Eigen::RowVector3d::Zero();

  void Clear() { value.setZero(); }
  void AddWithWeight(const Primvar& other, double weight) { value += weight * other.value; }
};

/// The square that a refined face covers of its Ptex face.
struct Square {
  int face;
  double u, v, size;
};

std::vector<Square> baseSquares(const Cage& cage) {
  // An n-gon's stands for the first of its sub-faces.
  std::vector<Square> squares;
  int ptex = 0;
  for (const std::vector<int>& face : cage.faces) {
    squares.push_back({ptex, 0, 0, 1});
    ptex += face.size() == 4 ? 1 : static_cast<int>(face.size());
  }
  return squares;
}

std::vector<Square> refinedSquares(const Far::TopologyLevel& parent,
                                   const Far::TopologyLevel& child,
                                   const std::vector<Square>& squares) {
  std::vector<Square> refined(child.GetNumFaces());
  for (int face = 0; face < parent.GetNumFaces(); ++face) {
    const Far::ConstIndexArray children = parent.GetFaceChildFaces(face);
    for (int i = 0; i < children.size(); ++i) {
      Square square = squares[face];
      if (children.size() == 4) {
        square.size /= 2;
        if (i == 1 || i == 2) square.u += square.size;
        if (i == 2 || i == 3) square.v += square.size;
      } else {
        square.face += i;
      }
      refined[children[i]] = square;
    }
  }
  return refined;
}

std::vector<float> sharpness(const std::vector<double>& values) {
  std::vector<float> result;
  for (double value : values) result.push_back(static_cast<float>(std::min(value, 10.0)));
  return result;
}

std::unique_ptr<Far::TopologyRefiner> refiner(const Cage& cage) {
  std::vector<int> sizes, vertices, crease_ends, corners;
  for (const std::vector<int>& face : cage.faces) {
    sizes.push_back(static_cast<int>(face.size()));
    vertices.insert(vertices.end(), face.begin(), face.end());
  }
  for (const auto& [a, b] : cage.options.edge_sharpness.edges) {
    crease_ends.push_back(static_cast<int>(a));
    crease_ends.push_back(static_cast<int>(b));
  }
  for (std::int64_t v : cage.options.vertex_sharpness.vertices) {
    corners.push_back(static_cast<int>(v));
  }
  const std::vector<float> creases = sharpness(cage.options.edge_sharpness.values);
  const std::vector<float> corner_weights = sharpness(cage.options.vertex_sharpness.values);
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = cage.vertexCount();
  descriptor.numFaces = static_cast<int>(sizes.size());
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = vertices.data();
  descriptor.numCreases = static_cast<int>(creases.size());
  descriptor.creaseVertexIndexPairs = crease_ends.data();
  descriptor.creaseWeights = creases.data();
  descriptor.numCorners = static_cast<int>(corners.size());
  descriptor.cornerVertexIndices = corners.data();
  descriptor.cornerWeights = corner_weights.data();
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(cage.options.boundary == Boundary::smooth
                                          ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                          : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetTriangleSubdivision(cage.options.triangles == Triangles::smooth
                                     ? Sdc::Options::TRI_SUB_SMOOTH
                                     : Sdc::Options::TRI_SUB_CATMARK);
  options.SetCreasingMethod(cage.options.creasing == Creasing::chaikin
                                ? Sdc::Options::CREASE_CHAIKIN
                                : Sdc::Options::CREASE_UNIFORM);
  const Sdc::SchemeType scheme =
      cage.options.scheme == Scheme::bilinear ? Sdc::SCHEME_BILINEAR : Sdc::SCHEME_CATMARK;
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(descriptor, Factory::Options(scheme, options)));
}

}  // namespace

FarLimit farLimit(const Cage& cage, int level) {
  const std::unique_ptr<Far::TopologyRefiner> far = refiner(cage);
  Far::TopologyRefiner::UniformOptions uniform(level);
  uniform.fullTopologyInLastLevel = true;
  far->RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> primvars(*far);

  std::vector<Primvar> points(cage.vertexCount());
  for (int i = 0; i < cage.vertexCount(); ++i) points[i].value = cage.positions.row(i);
  std::vector<Square> squares = baseSquares(cage);
  for (int l = 1; l <= level; ++l) {
    std::vector<Primvar> refined(far->GetLevel(l).GetNumVertices());
    primvars.Interpolate(l, points, refined);
    points = std::move(refined);
    squares = refinedSquares(far->GetLevel(l - 1), far->GetLevel(l), squares);
  }
  std::vector<Primvar> limit(points.size()), tangent1(points.size()), tangent2(points.size());
  primvars.Limit(points, limit, tangent1, tangent2);

  const Far::TopologyLevel& last = far->GetLevel(level);
  FarLimit result;
  const int count = 4 * last.GetNumFaces();
  result.position.resize(count, 3);
  result.tangent1.resize(count, 3);
  result.tangent2.resize(count, 3);
  for (int face = 0; face < last.GetNumFaces(); ++face) {
    const Far::ConstIndexArray vertices = last.GetFaceVertices(face);
    for (int corner = 0; corner < 4; ++corner) {
      const Square& square = squares[face];
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
