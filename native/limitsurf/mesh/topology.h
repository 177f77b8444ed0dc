// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/mesh/adjacency.h"
#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/rules/seam_sharpness.h"

namespace limitsurf {

/// The adjacency and sharpness of a control mesh, and the decision which of its faces have a limit
/// surface. It refers to the mesh.
///
/// What is not manifold is decided by OpenSubdiv's Far, so that the surface is the one that
/// OpenSubdiv means. Most meshes are manifold, and need no Far, which takes more time and memory
/// than all the rest.
class Topology {
 public:
  /// Throws MeshError where OpenSubdiv cannot represent a mesh that is not manifold.
  explicit Topology(const ControlMesh& mesh, SeamSharpness seams = {});

  /// An edge that is not manifold has no twins. The fan of a vertex that is not manifold has no
  /// meaning: splitFans() takes its place.
  const Adjacency& adjacency() const { return adjacency_; }

  /// The sharpness of the edge from each corner to the next one of its face; empty if
  /// hasSharpness() is false. Where a side has no twin, the edge is infinitely sharp anyway.
  const std::vector<float>& sideSharpness() const { return side_sharpness_; }
  /// The sharpness of each vertex; null if none is sharp. Pinned corners and most vertices that are
  /// not manifold are infinitely sharp.
  const float* vertexSharpness() const {
    return vertex_sharpness_.empty() ? nullptr : vertex_sharpness_.data();
  }

  /// Of the mesh of a face-varying channel; empty for all others.
  const SeamSharpness& seams() const { return seams_; }

  /// Whether the mesh is manifold, so that splitFans() is empty.
  bool isManifold() const { return is_manifold_; }

  /// The mesh in Far's form, which is made when it is first asked for, by one thread at a time.
  /// Sharpness is the mesh's, except that boundary edges, non-manifold edges and vertices, and
  /// pinned corners are infinitely sharp. Throws MeshError where OpenSubdiv cannot represent the
  /// mesh.
  const OpenSubdiv::Far::TopologyLevel& level() const;

  /// Whether any edge between two faces is sharp, or any vertex other than the corners of
  /// boundaries.
  bool hasSharpness() const { return has_sharpness_; }

  /// Faces without a limit surface, with the reason: holes, and faces that use a vertex twice.
  const std::map<int, std::string>& refused() const { return refused_; }

  /// Faces around a non-manifold vertex that manifold edges link. As in OpenSubdiv, non-manifold
  /// edges are infinitely sharp, and so are non-manifold vertices, except those through which
  /// exactly two such edges run as a crease. So each fan is a sector or a cone of its own.
  struct SplitFan {
    int vertex;
    bool closed;                             ///< faces all around
    std::vector<std::pair<int, int>> faces;  ///< (face, corner), counter-clockwise
    /// The far ends of the crease that runs through the vertex, if it is not the fan's own boundary
    /// on both sides, else -1. Where the fan begins and ends at the same edge of the crease, that
    /// edge is the first.
    std::array<int, 2> crease_ends = {-1, -1};

    bool followsCrease() const { return crease_ends[0] >= 0; }
  };
  const std::vector<SplitFan>& splitFans() const { return split_fans_; }

 private:
  void readAdjacencyFromFar();
  void setLastingCorners();
  void setSharpness();
  void readSharpnessFromFar();
  void refuseRepeatedVertices();
  void splitNonManifoldVertices();
  void splitIntoFans(int vertex, const std::vector<std::pair<int, int>>& corners);
  void setCreaseEnds(SplitFan& fan) const;

  const ControlMesh& mesh_;
  const SeamSharpness seams_;
  Adjacency adjacency_;
  bool is_manifold_ = true, has_sharpness_ = false;
  std::vector<float> side_sharpness_, vertex_sharpness_;
  mutable std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner_;
  std::map<int, std::string> refused_;
  std::vector<SplitFan> split_fans_;
};

}  // namespace limitsurf
