// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "support/cages/cage.h"
#include "support/truth/sharp_topology.h"

namespace limitsurf::test {

/// A cage's topology, found without the library: every vertex replaced by one for each fan of faces
/// around it that hang together by manifold edges, and all that is sharp by nature or by the
/// options said in numbers.
///
/// By nature (as OpenSubdiv 3.5 has it) infinitely sharp: edges that do not have exactly two faces
/// of equal winding; vertices of one face with Boundary::corners; and vertices with such edges of
/// two and more faces, or with several fans, unless an interior crease of such edges runs through
/// them. No smooth rule ever acts across fans, so each has a surface of its own; but finite
/// sharpness in one counts in the others.
///
/// Knows not: faces that use a vertex twice.
struct SplitMesh : SharpTopology {
  struct Vertex {
    int original;     ///< vertex of the cage
    int faces;        ///< of its fan
    float sharpness;  ///< as far as it is sharp itself, not only its edges
    bool loop;        ///< whether its fan begins and ends at the same edge
  };
  std::vector<Vertex> vertices;

  /// `sharp` includes the edges of a vertex' other fans.
  explicit SplitMesh(const Cage& cage);
};

}  // namespace limitsurf::test
