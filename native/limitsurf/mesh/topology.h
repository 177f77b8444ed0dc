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

/// A control mesh's adjacency, from OpenSubdiv's Far, and the verdict on which faces have a limit
/// surface.
class Topology {
 public:
  /// Throws MeshError where OpenSubdiv cannot represent the mesh.
  explicit Topology(const ControlMesh& mesh);

  const OpenSubdiv::Far::TopologyLevel& level() const { return refiner_->GetLevel(0); }

  /// Faces without a limit surface, with the reason: holes; faces that use a vertex twice and all
  /// faces that touch one; faces at the ends of an edge with more than two faces or with two of
  /// opposite winding; faces at a vertex where a closed fan meets others.
  const std::map<int, std::string>& refused() const { return refused_; }

  /// One of several open fans of faces that meet in nothing but a vertex (a bow-tie). As OpenSubdiv
  /// has it, the vertex is infinitely sharp, so each fan is a sector of its own around a pinned
  /// vertex.
  struct SplitFan {
    int vertex;
    std::vector<std::pair<int, int>> faces;  ///< (face, corner), counter-clockwise
  };
  const std::vector<SplitFan>& splitFans() const { return split_fans_; }

 private:
  void refuseSpoiled(const ControlMesh& mesh);
  /// Splits the faces at a vertex with manifold edges into fans; false if one of them is closed.
  bool splitIntoFans(int vertex);

  std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner_;
  std::map<int, std::string> refused_;
  std::vector<SplitFan> split_fans_;
};

}  // namespace limitsurf
