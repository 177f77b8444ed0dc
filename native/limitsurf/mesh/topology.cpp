// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/topology.h"

#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <sstream>

namespace limitsurf {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

/// A vertex that the face names twice, or -1.
int repeatedVertex(Span<int> vertices) {
  if (vertices.size() <= 8) {
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      if (std::find(vertices.begin(), vertices.begin() + i, vertices[i]) != vertices.begin() + i) {
        return vertices[i];
      }
    }
    return -1;
  }
  std::vector<int> sorted(vertices.begin(), vertices.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? -1 : *twice;
}

/// What is wrong with one of the vertex's edges; empty if nothing is.
std::string nonManifoldEdge(const Far::TopologyLevel& level, int vertex) {
  for (const int edge : level.GetVertexEdges(vertex)) {
    if (!level.IsEdgeNonManifold(edge)) {
      continue;
    }
    const auto ends = level.GetEdgeVertices(edge);
    const auto faces = level.GetEdgeFaces(edge);
    if (faces.size() == 2) {
      return text("faces ", faces[0], " and ", faces[1], " have opposite windings along edge (",
                  ends[0], ", ", ends[1], ")");
    }
    return text("edge (", ends[0], ", ", ends[1], ") has ", faces.size(), " faces");
  }
  return {};
}

}  // namespace

Topology::Topology(const ControlMesh& mesh) {
  std::vector<int> sizes = mesh.faceSizes();
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = mesh.vertexCount();
  descriptor.numFaces = mesh.faceCount();
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = mesh.faceVertices().data();

  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(mesh.options().boundary == Boundary::smooth
                                          ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                          : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  refiner_.reset(
      Factory::Create(descriptor, Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, options)));
  if (!refiner_) {
    throw MeshError("OpenSubdiv cannot represent the mesh's topology");
  }
  refuseSpoiled(mesh);
}

void Topology::refuseSpoiled(const ControlMesh& mesh) {
  for (const std::int64_t hole : mesh.options().holes) {
    refused_.emplace(static_cast<int>(hole), "it is a hole");
  }
  std::map<int, std::string> spoiled;
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const int twice = repeatedVertex(mesh.faceVertices(face));
    if (twice >= 0) {
      refused_.emplace(face, text("it uses vertex ", twice, " twice"));
      for (const int vertex : mesh.faceVertices(face)) {
        spoiled.emplace(
            vertex, text("at vertex ", vertex, ", face ", face, " uses vertex ", twice, " twice"));
      }
    }
  }
  for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
    if (!level().IsVertexNonManifold(vertex) || level().GetVertexFaces(vertex).size() == 0 ||
        spoiled.count(vertex)) {
      continue;
    }
    std::string reason = nonManifoldEdge(level(), vertex);
    if (reason.empty() && !splitIntoFans(vertex)) {
      reason = "a closed fan of faces meets others";
    }
    if (!reason.empty()) {
      spoiled.emplace(vertex, text("at vertex ", vertex, ", ", reason));
    }
  }
  for (const auto& [vertex, reason] : spoiled) {
    for (const int face : level().GetVertexFaces(vertex)) {
      refused_.emplace(face, reason);
    }
  }
}

bool Topology::splitIntoFans(int vertex) {
  const auto faces = level().GetVertexFaces(vertex);
  const auto corners = level().GetVertexFaceLocalIndices(vertex);
  std::map<int, int> face_after;  // edge -> which of `faces` it is the first edge of
  std::map<int, int> face_before;
  for (int i = 0; i < faces.size(); ++i) {
    const auto edges = level().GetFaceEdges(faces[i]);
    face_after[edges[corners[i]]] = i;
    face_before[edges[(corners[i] + edges.size() - 1) % edges.size()]] = i;
  }
  std::vector<SplitFan> fans;
  int used = 0;
  for (const auto& [first_edge, first] : face_after) {
    if (face_before.count(first_edge)) {
      continue;  // not where a fan begins
    }
    SplitFan fan{vertex, {}};
    for (int i = first;;) {
      fan.faces.emplace_back(faces[i], corners[i]);
      ++used;
      const auto edges = level().GetFaceEdges(faces[i]);
      const auto next = face_after.find(edges[(corners[i] + edges.size() - 1) % edges.size()]);
      if (next == face_after.end()) {
        break;
      }
      i = next->second;
    }
    fans.push_back(std::move(fan));
  }
  if (used != faces.size()) {
    return false;
  }
  split_fans_.insert(split_fans_.end(), fans.begin(), fans.end());
  return true;
}

}  // namespace limitsurf
