// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/mesh/topology.h"

namespace limitsurf {

/// The vertices of a face-varying channel's own mesh: one for each value that a vertex of the
/// surface's mesh takes.
struct ValueVertices {
  /// `indices`: the value of each corner of the faces of `mesh`.
  ValueVertices(const ControlMesh& mesh, const Topology& topology,
                const std::vector<std::int64_t>& indices);

  std::vector<int> first;  ///< vertex of `mesh` -> the first of its new vertices; one more entry
  std::vector<int> at_corner;  ///< corner of `mesh` -> new vertex
  std::vector<int> values;     ///< new vertex -> value
  std::vector<int> faces;      ///< new vertex -> the number of its faces

 private:
  void number(const std::vector<std::int64_t>& indices, const std::vector<int>& corners,
              bool in_order);
};

}  // namespace limitsurf
