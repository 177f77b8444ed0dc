// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <map>
#include <memory>
#include <string>
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

  /// Faces without a limit surface, with the reason: holes; faces that use a vertex twice; and all
  /// faces at a vertex whose faces form no single fan (non-manifold, of mixed winding, or one of
  /// those faces).
  const std::map<int, std::string>& refused() const { return refused_; }

 private:
  void refuseSpoiled(const ControlMesh& mesh);

  std::unique_ptr<const OpenSubdiv::Far::TopologyRefiner> refiner_;
  std::map<int, std::string> refused_;
};

}  // namespace limitsurf
