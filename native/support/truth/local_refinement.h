// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/truth/local_mesh.h"

namespace limitsurf::test {

/// One step of Catmull-Clark subdivision, written out from its definition, of the part of a local
/// mesh that matters to the child of its first face at a corner.
///
/// The child's vertices begin with the parent's corner and turn with the face; with `keep_uv`
/// (quads) they are in the parent's parametric order instead.
LocalMesh refined(const LocalMesh& parent, const MeshOptions& options, int corner, bool keep_uv);

}  // namespace limitsurf::test
