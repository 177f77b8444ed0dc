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

/// Why the faces at a vertex form no single fan.
std::string nonManifoldReason(const Far::TopologyLevel& level, int vertex) {
  for (const int edge : level.GetVertexEdges(vertex)) {
    if (!level.IsEdgeNonManifold(edge)) {
      continue;
    }
    const auto ends = level.GetEdgeVertices(edge);
    const auto faces = level.GetEdgeFaces(edge);
    if (faces.size() > 2) {
      return text("edge (", ends[0], ", ", ends[1], ") has ", faces.size(), " faces");
    }
    if (faces.size() == 2) {
      return text("faces ", faces[0], " and ", faces[1], " have opposite windings along edge (",
                  ends[0], ", ", ends[1], ")");
    }
  }
  return text("the faces at vertex ", vertex, " form more than one fan");
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
  refiner_.reset(Factory::Create(descriptor,
                                 Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, options)));
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
        spoiled.emplace(vertex, text("at vertex ", vertex, ", face ", face, " uses vertex ", twice,
                                     " twice"));
      }
    }
  }
  for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
    if (level().IsVertexNonManifold(vertex) && level().GetVertexFaces(vertex).size() > 0) {
      spoiled.emplace(vertex,
                      text("at vertex ", vertex, ", ", nonManifoldReason(level(), vertex)));
    }
  }
  for (const auto& [vertex, reason] : spoiled) {
    for (const int face : level().GetVertexFaces(vertex)) {
      refused_.emplace(face, reason);
    }
  }
}

}  // namespace limitsurf
