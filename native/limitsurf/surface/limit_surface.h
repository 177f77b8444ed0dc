// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/mesh/interpolation.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Bounds on the error of every evaluation, each held by a test against values of independent
/// high-precision subdivision, for valences to 100 and (u, v) down to 2^-40 from an extraordinary
/// vertex and at it.
///
/// Position: relative to the diagonal of the control mesh's bounding box.
constexpr double kPositionError = 1e-13;
/// First and second derivatives: relative to the larger of the value itself and the face's largest
/// derivative at least 1/16 away from its corners.
constexpr double kFirstDerivativeError = 1e-12;
constexpr double kSecondDerivativeError = 1e-11;
/// Normals: radians; at a smooth corner of one face only outside 2^-20 of the vertex, where du and
/// dv are antiparallel.
constexpr double kNormalError = 1e-11;

enum class Derivatives { none = 0, first = 1, second = 2 };

/// Positions and derivatives, one row per location in the caller's order. Members that were not
/// asked for have no rows.
struct Evaluation {
  Points position, du, dv, duu, duv, dvv;
  Points normal;
};

/// Principal curvatures k1 >= k2 with their unit directions in space; mean = (k1 + k2) / 2,
/// gaussian = k1 k2. Signs follow the normal: a sphere seen from outside has negative curvatures.
struct Curvature {
  Eigen::VectorXd gaussian, mean, k1, k2;
  Points direction1, direction2;
  /// Exactly at an irregular vertex: the other members are no curvature of the surface there.
  Eigen::Array<bool, Eigen::Dynamic, 1> irregular;
};

/// What stands for curvature exactly at irregular vertices, where it has no limit.
enum class IrregularRule {
  none,     ///< NaN
  average,  ///< a mean over the faces around the vertex
};

/// How far around an irregular vertex curvature is averaged, as a share of an edge.
constexpr double kCurvatureRadius = 1. / 64;

/// Throws std::invalid_argument unless 0 < radius <= 1/2.
void checkCurvatureRadius(double radius);

/// Averages: relative to what curvature would be if second derivatives all pointed along the
/// normal, (|duu| + |duv| + |dvv|) / min(|du|, |dv|)^2, where that is largest among the places. At
/// tiny radii this leaves little: below 2^-40 or so no digit of the curvature itself is left.
constexpr double kAverageCurvatureError = 1e-9;

/// Sparse linear weights of the control mesh's vertices, one row per location (CSR).
struct Stencils {
  std::vector<std::int64_t> offsets;
  std::vector<int> indices;
  std::vector<double> weights, du_weights, dv_weights;  ///< the latter two only if asked for
};

/// Data of any number of columns, one row per vertex or value.
using DataRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class SurfaceData;     // surface_data.h
class SurfacePatches;  // surface_patches.h

/// The Catmull-Clark limit surface of a control mesh, evaluated exactly at any location.
///
/// Topology is analysed once, in the constructor; setPositions() re-poses the surface at the cost
/// of the irregular faces alone. All const members may be called from many threads at once.
///
/// Every batch call takes `threads`: 0 means all cores, n at most n. The result for a location does
/// not depend on it, nor on what else is in the batch, to the last bit.
///
/// Memory: the cage, 76 bytes a regular face, O(neighbourhood) an irregular one, O(valence) an
/// extraordinary vertex, and some 4 KiB for each step in which a semi-sharp vertex or edge decays;
/// an edge that is one of a run of equal sharpness through regular vertices costs no more than a
/// smooth one.
class LimitSurface {
 public:
  /// Throws MeshError where OpenSubdiv cannot represent the topology.
  explicit LimitSurface(ControlMesh mesh);
  ~LimitSurface();
  LimitSurface(LimitSurface&&) noexcept;
  LimitSurface& operator=(LimitSurface&&) noexcept;

  const ControlMesh& mesh() const;
  /// The cage's current positions: the mesh's, until setPositions() gave others.
  const Points& positions() const;

  /// The same topology under a new pose. Throws MeshError as ControlMesh does for positions, and
  /// then leaves the surface as it was. Not to be called while another thread evaluates.
  void setPositions(const Points& positions, int threads = 0);

  /// Number of Ptex faces.
  int faceCount() const;
  /// Ptex face -> face of the control mesh, and the n-gon's corner it belongs to (0 for quads).
  const std::vector<int>& baseFace() const;
  const std::vector<int>& corner() const;
  /// Faces of the control mesh that have no limit surface (holes included), with the reason.
  const std::map<int, std::string>& refused() const;

  /// Throws what evaluate() throws for the first row that cannot be evaluated, and does nothing
  /// else.
  void checkLocations(Span<Location> at) const;

  /// Limit positions and derivatives with respect to the face's own (u, v).
  ///
  /// Properties:
  ///   (1) rotating a quad's vertex order rotates (u, v) and moves no position by more than
  ///       kPositionError;
  ///   (2) on a shared edge both faces give the same position to kPositionError;
  ///   (3) any number of threads gives the same bits.
  ///
  /// Exactly at an irregular vertex: position always; du, dv and second derivatives along a
  /// boundary that bounds the face are the limit curve's; du = dv = 0 at interior valence 2 and 3;
  /// all others have no limit and are NaN. The normal is NaN where approaches to the vertex within
  /// the face's sector do not agree on one (interior valence 2, boundaries with four and more
  /// faces). Use frames() where a direction is needed.
  ///
  /// `normals` asks for unit normals (needs derivatives >= first).
  ///
  /// Throws LocationError naming the first row whose face or (u, v) is out of range, MeshError
  /// naming the first whose face is refused. Cost: O(1) a location, but O(valence) within 2^-4 of
  /// an extraordinary vertex.
  Evaluation evaluate(Span<Location> at, Derivatives derivatives = Derivatives::none,
                      bool normals = false, int threads = 0) const;

  /// Row-major 3x3 rotations, nine numbers a row: columns tangent (along du), normal x tangent,
  /// normal. Always finite: at an irregular vertex the limit over u = v = 2^-n as seen from the
  /// vertex; where du or the normal vanishes, completed from dv, then from the least aligned world
  /// axis.
  Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> frames(Span<Location> at,
                                                                   int threads = 0) const;

  /// Curvature. Exactly at irregular vertices, where it has no limit, what `rule` says.
  ///
  /// The average there is over the faces of the location's own sector: all that boundaries and
  /// infinitely sharp edges do not part from its face. On each of them four places stand on the
  /// square with the vertex at one corner and sides of `radius` edges, at (1, 1/4), (1, 3/4),
  /// (3/4, 1) and (1/4, 1) times the side as seen from the vertex; the side is `radius` in u and v
  /// on a quad and twice that on a sub-face of an n-gon, whose sides are half edges. Their shape
  /// operators, each turned by the shortest rotation into the vertex' tangent plane, are averaged,
  /// weighted by area (|du x dv|, counted in edges): the midpoint rule for the mean over a thin
  /// band around the vertex. Principal curvatures and directions are those of the mean; `gaussian`
  /// is the product of its k1 and k2, not a mean of products.
  ///
  /// Where the vertex has no normal the plane is perpendicular to the mean of the places' normals
  /// weighted by area, or to one of them should these cancel out. Places where the surface is
  /// singular, or turned the opposite way, are left out; where none remains all is NaN.
  ///
  /// Properties:
  ///   (1) all locations that name the same vertex in the same sector get the same bits;
  ///   (2) a mesh subdivided once gives the same at twice the radius.
  ///
  /// Error: kAverageCurvatureError. Throws std::invalid_argument for a radius outside (0, 1/2].
  /// Cost: O(Ptex faces), where any row needs an average, and O(valence^2) for each vertex.
  Curvature curvature(Span<Location> at, IrregularRule rule = IrregularRule::none,
                      double radius = kCurvatureRadius, int threads = 0) const;

  /// The exact linear weights of position (and du, dv) on the cage's vertices.
  Stencils stencils(Span<Location> at, bool first_derivatives = false, int threads = 0) const;

  /// Data that each corner of the mesh's faces picks for itself: `indices` holds a row of `values`
  /// for every corner, one face after the other. Where the corners around a vertex pick the same
  /// row the data are as smooth as the surface; edges between different ones are seams.
  ///
  /// The rules are OpenSubdiv's, for seams, their ends and junctions, boundaries and corners,
  /// smooth and sharp. Faces that have no limit surface have no data either.
  ///
  /// Throws MeshError naming the first index that is no row of `values`, the first row that is not
  /// finite, and vertices where a seam meets semi-sharp edges whose decay cannot be had
  /// (face_varying_mesh.h tells which). Cost: as making a surface.
  SurfaceData faceVarying(const DataRows& values, const std::vector<std::int64_t>& indices,
                          Interpolation interpolation, int threads = 0) const;

  /// Data at the vertices, one row each, interpolated as positions are. Throws MeshError for
  /// another number of rows and for the first that is not finite. Cost: as setPositions(), for
  /// every three columns.
  SurfaceData vertexData(const DataRows& values, int threads = 0) const;

  /// The same, but linear along edges and bilinear on each Ptex face: a sub-face of an n-gon has
  /// the values of its corner, of its edges' midpoints and the mean of all corners.
  SurfaceData varying(const DataRows& values, int threads = 0) const;

  /// One location per vertex of the control mesh; face = -1 for vertices that no face with a limit
  /// surface uses.
  std::vector<Location> vertexLocations() const;

  /// The tightest axis-aligned box around the limit surface (rows: minimum, maximum), to
  /// kPositionError.
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> bounds(int threads = 0) const;

 private:
  friend class SurfacePatches;
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
