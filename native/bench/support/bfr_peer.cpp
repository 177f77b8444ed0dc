// SPDX-License-Identifier: Apache-2.0
#include "bench/support/bfr_peer.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

namespace limitsurf::bench {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

TopologyPointer farTopology(const MeshArrays& cage) {
  const std::vector<int> sizes(cage.face_sizes.begin(), cage.face_sizes.end());
  const std::vector<int> vertices(cage.face_vertices.begin(), cage.face_vertices.end());
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(cage.positions.rows());
  descriptor.numFaces = cage.faceCount();
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = vertices.data();
  std::vector<int> sharp_edges;
  for (const auto& [a, b] : cage.options.edge_sharpness.edges) {
    sharp_edges.insert(sharp_edges.end(), {static_cast<int>(a), static_cast<int>(b)});
  }
  const std::vector<float> sharpness(cage.options.edge_sharpness.values.begin(),
                                     cage.options.edge_sharpness.values.end());
  descriptor.numCreases = static_cast<int>(sharpness.size());
  descriptor.creaseVertexIndexPairs = sharp_edges.data();
  descriptor.creaseWeights = sharpness.data();
  Sdc::Options rules;
  rules.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  using Maker = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return TopologyPointer(Maker::Create(descriptor, Maker::Options(Sdc::SCHEME_CATMARK, rules)));
}

BfrPeer::BfrPeer(const MeshArrays& cage, const Far::TopologyRefiner& topology, int level,
                 Cache* cache)
    : level_(level) {
  Factory::Options options;
  options.SetApproxLevelSmooth(level).SetApproxLevelSharp(level);
  if (cache) options.SetExternalCache(cache);
  const Factory factory(topology, options);

  surfaces_.resize(cage.faceCount());
  point_offsets_.resize(cage.faceCount() + 1, 0);
  std::vector<int> all_faces(cage.faceCount());
  for (int face = 0; face < cage.faceCount(); ++face) {
    all_faces[face] = face;
    const int size = static_cast<int>(cage.face_sizes[face]);
    for (int corner = 0; corner < (size == 4 ? 1 : size); ++corner) {
      base_face_.push_back(face);
      corner_.push_back(corner);
    }
    factory.InitVertexSurface(face, &surfaces_[face]);
    point_offsets_[face + 1] = point_offsets_[face] + 3 * surfaces_[face].GetNumPatchPoints();
  }
  points_.resize(point_offsets_.back());
  prepare(cage.positions, all_faces);
}

void BfrPeer::prepare(const Points& positions, const std::vector<int>& base_faces) {
  const Surface::PointDescriptor packed(3);
  for (const int face : base_faces) {
    surfaces_[face].PreparePatchPoints(positions.data(), packed,
                                       points_.data() + point_offsets_[face], packed);
  }
}

std::vector<BfrPeer::Coordinate> BfrPeer::coordinates(Span<Location> at) const {
  std::vector<Coordinate> converted;
  converted.reserve(at.size());
  for (const Location& location : at) {
    Coordinate c{base_face_[location.face], {location.u, location.v}};
    const auto parameters = surfaces_[c.base_face].GetParameterization();
    if (parameters.HasSubFaces()) {
      const double local[2] = {location.u, location.v};
      parameters.ConvertNormalizedSubFaceToCoord(corner_[location.face], local, c.uv);
    }
    converted.push_back(c);
  }
  return converted;
}

}  // namespace limitsurf::bench
