// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// Edges of a control mesh, each given by its two vertices in any order.
using EdgeList = std::vector<std::pair<std::int64_t, std::int64_t>>;

/// Tells for each corner of each face whether the edge from it to the face's next corner is among
/// `edges`. Throws MeshError naming the first row that is no edge of the mesh.
std::vector<std::uint8_t> cutCorners(const ControlMesh& mesh, const EdgeList& edges);

}  // namespace limitsurf
