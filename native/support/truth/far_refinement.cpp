// SPDX-License-Identifier: Apache-2.0
#include "support/truth/far_refinement.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>

namespace limitsurf::test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

std::vector<FarSquare> baseSquares(const Cage& cage) {
  // An n-gon's stands for the first of its sub-faces.
  std::vector<FarSquare> squares;
  int ptex = 0;
  for (const std::vector<int>& face : cage.faces) {
    squares.push_back({ptex, 0, 0, 1});
    ptex += face.size() == 4 ? 1 : static_cast<int>(face.size());
  }
  return squares;
}

std::vector<FarSquare> refinedSquares(const Far::TopologyLevel& parent,
                                      const Far::TopologyLevel& child,
                                      const std::vector<FarSquare>& squares) {
  std::vector<FarSquare> refined(child.GetNumFaces());
  for (int face = 0; face < parent.GetNumFaces(); ++face) {
    const Far::ConstIndexArray children = parent.GetFaceChildFaces(face);
    for (int i = 0; i < children.size(); ++i) {
      FarSquare square = squares[face];
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

Sdc::Options::FVarLinearInterpolation farRule(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::none:
      return Sdc::Options::FVAR_LINEAR_NONE;
    case Interpolation::corners_only:
      return Sdc::Options::FVAR_LINEAR_CORNERS_ONLY;
    case Interpolation::corners_plus1:
      return Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1;
    case Interpolation::corners_plus2:
      return Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2;
    case Interpolation::boundaries:
      return Sdc::Options::FVAR_LINEAR_BOUNDARIES;
    default:
      return Sdc::Options::FVAR_LINEAR_ALL;
  }
}

std::unique_ptr<Far::TopologyRefiner> makeRefiner(const Cage& cage, const Channel& channel,
                                                  Interpolation interpolation) {
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
  const std::vector<int> indices(channel.indices.begin(), channel.indices.end());
  Far::TopologyDescriptor::FVarChannel far_channel;
  far_channel.numValues = channel.value_count;
  far_channel.valueIndices = indices.data();
  descriptor.numFVarChannels = indices.empty() ? 0 : 1;
  descriptor.fvarChannels = &far_channel;
  Sdc::Options options;
  options.SetFVarLinearInterpolation(farRule(interpolation));
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

FarRefinement::FarRefinement(const Cage& cage, int level, const Channel& channel,
                             Interpolation interpolation)
    : refiner(makeRefiner(cage, channel, interpolation)),
      points(cage.vertexCount()),
      squares(baseSquares(cage)) {
  Far::TopologyRefiner::UniformOptions uniform(level);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> primvars(*refiner);
  for (int i = 0; i < cage.vertexCount(); ++i) points[i].value = cage.positions.row(i);
  for (int l = 1; l <= level; ++l) {
    std::vector<FarPrimvar> refined(refiner->GetLevel(l).GetNumVertices());
    primvars.Interpolate(l, points, refined);
    points = std::move(refined);
    squares = refinedSquares(refiner->GetLevel(l - 1), refiner->GetLevel(l), squares);
  }
}

RefinedChannel subdivided(const Cage& cage, int level, const Channel& channel,
                          const DataRows& values, Interpolation interpolation) {
  const FarRefinement far(cage, level, channel, interpolation);
  const Far::PrimvarRefinerReal<double> primvars(*far.refiner);
  std::vector<FarPrimvar> points(static_cast<std::size_t>(values.rows()));
  for (std::size_t i = 0; i < points.size(); ++i) points[i].value = values.row(i);
  for (int l = 1; l <= level; ++l) {
    std::vector<FarPrimvar> refined(far.refiner->GetLevel(l).GetNumFVarValues());
    primvars.InterpolateFaceVarying(l, points, refined);
    points = std::move(refined);
  }
  RefinedChannel result;
  result.values.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) result.values.row(i) = points[i].value;
  result.channel.value_count = static_cast<int>(points.size());
  const Far::TopologyLevel& last = far.refiner->GetLevel(level);
  for (int face = 0; face < last.GetNumFaces(); ++face) {
    const Far::ConstIndexArray corners = last.GetFaceFVarValues(face);
    result.channel.indices.insert(result.channel.indices.end(), corners.begin(), corners.end());
  }
  return result;
}

Cage subdivided(const Cage& cage, int level) {
  const FarRefinement far(cage, level);
  const Far::TopologyLevel& last = far.refiner->GetLevel(level);
  Cage result;
  result.options = cage.options;
  result.positions.resize(last.GetNumVertices(), 3);
  EdgeSharpness& edges = result.options.edge_sharpness = {};
  VertexSharpness& vertices = result.options.vertex_sharpness = {};
  for (int vertex = 0; vertex < last.GetNumVertices(); ++vertex) {
    result.positions.row(vertex) = far.points[vertex].value;
    if (last.GetVertexSharpness(vertex) > 0) {
      vertices.vertices.push_back(vertex);
      vertices.values.push_back(last.GetVertexSharpness(vertex));
    }
  }
  for (int edge = 0; edge < last.GetNumEdges(); ++edge) {
    if (last.GetEdgeSharpness(edge) > 0) {
      const Far::ConstIndexArray ends = last.GetEdgeVertices(edge);
      edges.edges.emplace_back(ends[0], ends[1]);
      edges.values.push_back(last.GetEdgeSharpness(edge));
    }
  }
  for (int face = 0; face < last.GetNumFaces(); ++face) {
    const Far::ConstIndexArray corners = last.GetFaceVertices(face);
    result.faces.emplace_back(corners.begin(), corners.end());
  }
  return result;
}

}  // namespace limitsurf::test
