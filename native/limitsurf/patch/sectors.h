// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/eigen/ring.h"
#include "limitsurf/patch/face_mesh.h"
#include "limitsurf/sparse_array.h"

namespace limitsurf {

/// The faces around a vertex between two boundaries or infinitely sharp edges, or all its faces if
/// there are no such edges. Once no edge at the vertex is semi-sharp any more, and neither is the
/// vertex, a sector is subdivided independently of the others.
struct Sector {
  Ring ring;
  FaceCorner first;  ///< the others follow by FaceMesh::turned()

  /// Whether the surface in the sector is a B-spline, provided that all its faces are quads.
  bool regular() const {
    switch (ring.kind) {
      case RingKind::interior:
        return ring.faces == 4;
      case RingKind::boundary:
        return ring.faces == 2;
      case RingKind::pinned:
        return ring.faces == 1;
      default:
        return false;
    }
  }
};

/// The sectors around the vertices of a level. They are found when they are first asked for.
class Sectors {
 public:
  Sectors(const FaceMesh& mesh, bool has_sharpness);

  enum class State : std::uint8_t {
    unknown,
    regular,    ///< four faces all around, and nothing is sharp: one sector, which has no number
    settled,    ///< nothing at the vertex is semi-sharp, so that it consists of sectors
    crease,     ///< of four edges two opposite ones are equally semi-sharp; nothing else is sharp
    unsettled,  ///< anything else
  };
  State state(int vertex) {
    State& state = states_[vertex];
    if (state == State::unknown) {
      state = classify(vertex);
    }
    return state;
  }

  /// The sector to which a face's corner at a settled vertex belongs, and the position of the face
  /// within that sector.
  int sectorOf(FaceCorner at) const { return corners_[mesh_.cornerNumber(at)].sector; }
  int positionOf(FaceCorner at) const { return corners_[mesh_.cornerNumber(at)].position; }
  const Sector& sector(int i) const { return sectors_[i]; }
  int sectorCount() const { return static_cast<int>(sectors_.size()); }
  /// The first of a settled vertex's sectors; the others follow, counter-clockwise.
  int firstSector(int vertex) const { return first_sector_[vertex]; }

 private:
  State classify(int vertex);
  void settle(int vertex, const VertexFan& fan);
  RingKind wholeKind(int vertex, const VertexFan& fan, bool pinned) const;
  void gatherCorners(const VertexFan& fan);
  void addSector(RingKind kind, int first, int faces);

  struct Corner {
    int sector = -1, position = 0;
  };

  const FaceMesh& mesh_;
  const bool has_sharpness_;
  std::vector<State> states_;
  SparseArray<int> first_sector_;  // of settled vertices
  SparseArray<Corner> corners_;    // at settled vertices
  std::vector<Sector> sectors_;
  // Of the vertex being classified: its corners, its sharpness, its sharp edges.
  std::vector<FaceCorner> around_;
  SharpnessAround sharpness_;
  std::vector<int> cuts_;
};

}  // namespace limitsurf
