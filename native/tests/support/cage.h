// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::test {

/// A control mesh as tests like to build and change it.
struct Cage {
  Points positions;
  std::vector<std::vector<int>> faces;
  MeshOptions options;

  int vertexCount() const { return static_cast<int>(positions.rows()); }
};

ControlMesh controlMesh(const Cage& cage);
LimitSurface limitSurface(const Cage& cage);

/// Length of the diagonal of the bounding box.
double diagonal(const Points& positions);

/// The numbering of Ptex faces: a quad has one, an n-gon n.
struct PtexFace {
  int base_face;
  int corner;
  bool quad;
};
std::vector<PtexFace> ptexFaces(const Cage& cage);

/// Whether every edge has at most two faces, of equal winding, and every vertex one fan of faces.
bool isManifold(const std::vector<std::vector<int>>& faces);

/// The faces with every bow-tie vertex, where several fans of faces meet, replaced by one vertex
/// per fan. As in OpenSubdiv, such a vertex is infinitely sharp under both boundary rules, so that
/// the fans have nothing to do with each other.
struct FanSplit {
  std::vector<std::vector<int>> faces;
  std::vector<int> original;  ///< new vertex -> vertex of the cage
  std::vector<bool> bow_tie;  ///< by new vertex
};
FanSplit splitFans(const Cage& cage);

/// What lies at a corner of a Ptex face.
struct CornerPoint {
  bool boundary = false;
  int faces = 4;    ///< quads around it after one subdivision
  int vertex = -1;  ///< of the cage; -1 at face centres and edge midpoints
  bool pinned = false;

  int valence() const { return boundary ? faces + 1 : faces; }
  bool regular() const { return boundary ? faces == (pinned ? 1 : 2) : faces == 4; }
};

/// Corner points by Ptex face and corner (0 to 3, in the order (0,0), (1,0), (1,1), (0,1)).
class CornerPoints {
 public:
  explicit CornerPoints(const Cage& cage);
  const CornerPoint& at(int face, int corner) const { return corners_[4 * face + corner]; }
  /// The corner that the location is exactly at, or null.
  const CornerPoint* at(const Location& location) const;
  /// Within 2^-20 of a smooth corner of one face: du and dv become antiparallel there, so that
  /// kNormalError is not promised.
  bool insideSmoothCorner(const Location& location) const;

 private:
  std::vector<CornerPoint> corners_;
};

/// (u, v) of a Ptex face's corner.
Location cornerLocation(int face, int corner);

std::string describe(const Location& location);

}  // namespace limitsurf::test
