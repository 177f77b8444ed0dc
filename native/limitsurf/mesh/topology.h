// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// The adjacency and sharpness of a control mesh, from OpenSubdiv's Far, and the decision which of
/// its faces have a limit surface.
class Topology {
 public:
  /// Throws MeshError where OpenSubdiv cannot represent the mesh.
  explicit Topology(const ControlMesh& mesh);

  /// The mesh in Far's form. Sharpness is the mesh's, except that boundary edges, non-manifold
  /// edges and vertices, and pinned corners are infinitely sharp.
  const OpenSubdiv::Far::TopologyLevel& level() const { return refiner_->GetLevel(0); }

  /// Whether any edge between two faces is sharp, or any vertex other than the corners of
  /// boundaries.
  bool hasSharpness() const { return has_sharpness_; }

  /// Faces without a limit surface, with the reason: holes, and faces that use a vertex twice. Some
  /// others have a limit surface, but this library does not support them: closed fans of faces, and
  /// fans that begin and end at the same edge, at a vertex on a crease between other faces.
  const std::map<int, std::string>& refused() const { return refused_; }

  /// Faces around a non-manifold vertex that manifold edges link. As in OpenSubdiv, non-manifold
  /// edges are infinitely sharp, and so are non-manifold vertices, except those through which
  /// exactly two such edges run as a crease. So each fan is a sector or a cone of its own.
  struct SplitFan {
    int vertex;
    bool closed;                             ///< faces all around
    std::vector<std::pair<int, int>> faces;  ///< (face, corner), counter-clockwise
  };
  const std::vector<SplitFan>& splitFans() const { return split_fans_; }

 private:
  void refuseFaces(const ControlMesh& mesh);
  void splitNonManifoldVertices(const ControlMesh& mesh);
  void splitIntoFans(const ControlMesh& mesh, int vertex,
                     const std::vector<std::pair<int, int>>& corners);
  void refuseBesideCrease(const SplitFan& fan);

  std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner_;
  bool has_sharpness_ = false;
  std::map<int, std::string> refused_;
  std::vector<SplitFan> split_fans_;
};

}  // namespace limitsurf
