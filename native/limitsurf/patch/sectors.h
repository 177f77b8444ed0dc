// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/eigen/ring.h"
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// Faces around a vertex between two infinitely sharp edges or boundaries, or all of them: what
/// subdivides on its own once all that was semi-sharp at the vertex has decayed.
struct Sector {
  Ring ring;
  FaceCorner first;  ///< the others follow by FaceMesh::turned()

  /// Whether the surface in the sector, if all its faces are quads, is a B-spline's.
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

/// What a level's vertices are to the faces around them. Found when first asked for.
class Sectors {
 public:
  Sectors(const FaceMesh& mesh, bool has_sharpness);

  enum class State : std::uint8_t {
    unknown,
    settled,    ///< nothing at the vertex is semi-sharp: it consists of sectors
    crease,     ///< two opposite edges of four are semi-sharp, equally, and nothing else is sharp
    unsettled,  ///< anything else
  };
  State state(int vertex);

  /// The sector a face's corner belongs to, and which of its faces it is; at settled vertices.
  int sectorOf(FaceCorner at) const { return corners_[mesh_.cornerNumber(at)].sector; }
  int positionOf(FaceCorner at) const { return corners_[mesh_.cornerNumber(at)].position; }
  const Sector& sector(int i) const { return sectors_[i]; }
  int sectorCount() const { return static_cast<int>(sectors_.size()); }
  /// The first of a settled vertex's sectors; the others follow, counter-clockwise.
  int firstSector(int vertex) const { return first_sector_[vertex]; }

 private:
  State classify(int vertex);
  void settle(int vertex, const VertexFan& fan, const SharpnessAround& around);
  void addSector(RingKind kind, int first, int faces);

  struct Corner {
    int sector = -1, position = 0;
  };

  const FaceMesh& mesh_;
  const bool has_sharpness_;
  std::vector<State> states_;
  std::vector<int> first_sector_;
  std::vector<Corner> corners_;
  std::vector<Sector> sectors_;
  std::vector<FaceCorner> around_;  // the corners of the vertex being settled
};

}  // namespace limitsurf
