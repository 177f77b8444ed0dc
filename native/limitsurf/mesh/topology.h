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

/// A control mesh's adjacency and sharpness, from OpenSubdiv's Far, and the verdict on which faces
/// have a limit surface.
class Topology {
 public:
  /// Throws MeshError where OpenSubdiv cannot represent the mesh.
  explicit Topology(const ControlMesh& mesh);

  /// Sharpness is the mesh's, but that boundary edges, non-manifold edges and vertices, and corners
  /// that are to be pinned are infinitely sharp.
  const OpenSubdiv::Far::TopologyLevel& level() const { return refiner_->GetLevel(0); }

  /// Whether any edge between two faces, or any vertex but a boundary's corner, is sharp.
  bool hasSharpness() const { return has_sharpness_; }

  /// Faces without a limit surface, with the reason: holes; faces that use a vertex twice. And
  /// some that have one, but not yet here: closed fans of faces, and fans that begin and end at one
  /// edge, at a vertex that follows a crease between other faces.
  const std::map<int, std::string>& refused() const { return refused_; }

  /// Faces around a non-manifold vertex that are linked by manifold edges. As OpenSubdiv has it,
  /// non-manifold edges are infinitely sharp, and non-manifold vertices too unless exactly two such
  /// edges run through them as a crease; so each fan is a sector, or a cone, of its own.
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
  void refuseStrangersToCrease(const SplitFan& fan);

  std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner_;
  bool has_sharpness_ = false;
  std::map<int, std::string> refused_;
  std::vector<SplitFan> split_fans_;
};

}  // namespace limitsurf
