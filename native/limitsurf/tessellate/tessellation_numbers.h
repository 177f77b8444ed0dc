// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/mesh/ptex_faces.h"
#include "limitsurf/tessellate/cage_edges.h"
#include "limitsurf/tessellate/tessellated_face.h"
#include "limitsurf/tessellate/tessellation.h"

namespace limitsurf {

/// Numbers the points of a tessellation and lists its polygons. It knows no positions.
///
/// A point on an edge or at a vertex is numbered by the first face that has it. Faces are worked on
/// at the same time, so others that meet such a point first write down its slot, as ~slot, and the
/// number takes its place when all are known.
class TessellationNumbers {
 public:
  /// All arguments are kept by reference; a level for each face of the mesh.
  TessellationNumbers(const ControlMesh& mesh, const PtexFaces& ptex,
                      const std::map<int, std::string>& refused, const std::vector<int>& levels,
                      int threads);

  std::size_t pointCount() const { return first_point_.back(); }
  std::size_t slotCount() const { return slot_count_; }

  /// Everything of the result but positions and normals. There must not be more points and slots
  /// than an int counts.
  void fill(Tessellation& result, int threads) const;

 private:
  /// A face's division, with its edges' levels.
  struct Divided {
    std::vector<int> edge_levels;
    FaceDivision division;
  };

  void levelEdges();
  void findOwners();
  void count(int threads);
  void countInside(const FaceDivision& division, std::size_t i);
  void divide(int face, Divided& divided) const;
  void fillFace(std::size_t i, std::vector<int>& number_of_slot, Tessellation& result) const;
  /// Of a place on an edge or at a vertex of the face, and whether the face numbers it.
  std::pair<std::size_t, bool> slotOf(int face, const FacePlace& place) const;
  std::size_t pointsInside(int edge) const { return (std::size_t{1} << edge_level_[edge]) - 1; }

  const ControlMesh& mesh_;
  const PtexFaces& ptex_;
  const std::vector<int>& levels_;
  const CageEdges edges_;
  std::vector<int> faces_;  ///< that have a surface
  std::vector<int> edge_level_, edge_owner_, vertex_owner_;
  std::vector<std::size_t> first_slot_;  ///< of each edge; vertices' slots come before
  std::size_t slot_count_ = 0;
  /// Where each face's own begin among all; one more at the end.
  std::vector<std::size_t> first_point_, first_polygon_, first_corner_;
};

}  // namespace limitsurf
