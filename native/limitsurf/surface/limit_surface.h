// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "limitsurf/large_pages.h"
#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/mesh/interpolation.h"
#include "limitsurf/progress.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/surface/tiles/surface_tiles.h"
#include "limitsurf/types.h"

namespace limitsurf {

// Bounds on the error of every evaluation. Tests compare each with independent subdivision in high
// precision, for valences to 100, for (u, v) down to 2^-40 from an extraordinary vertex, and at it.
// docs/accuracy.md says how the errors arise.

/// Positions: relative to the diagonal of the control mesh's bounding box.
constexpr double kPositionError = 1e-13;
/// First and second derivatives: relative to the larger of the value itself and the face's largest
/// derivative at least 1/16 away from its corners.
constexpr double kFirstDerivativeError = 1e-12;
constexpr double kSecondDerivativeError = 1e-11;
/// Normals: in radians, times the condition number or 1, whichever is larger. The condition number
/// is S sqrt(2 (|du|^2 + |dv|^2)) / |du x dv|, where S is the size of the patch's control polygon,
/// in the units of du: how much the rounding of du and dv turns their product. On faces of ordinary
/// shape it is between 2 and 100. It is large on slivers, and grows without bound towards places
/// where du x dv vanishes, as on a fold or at a smooth corner of one face.
constexpr double kNormalError = 1e-11;
/// Where the condition number is larger, the normal is NaN. It is also NaN on refined faces if this
/// is so with 1/4096 of the mesh's largest coordinate in place of S: their points are rounded at
/// their own coordinates.
constexpr double kMostNormalCondition = 0x1p30;

/// How many derivatives an evaluation gives.
enum class Derivatives { none = 0, first = 1, second = 2 };

/// Positions and derivatives, one row per location in the caller's order. Members that were not
/// asked for have no rows.
struct Evaluation {
  Points position, du, dv, duu, duv, dvv;
  Points normal;
};

/// The caller's own memory for an evaluation: contiguous rows of three numbers, one for each
/// location. Float results are the double ones, rounded.
template <typename Real>
struct EvaluationArrays {
  struct Rows {
    Real* numbers = nullptr;  ///< 3 count of them
    std::size_t count = 0;
  };
  Rows position = {}, du = {}, dv = {}, duu = {}, duv = {}, dvv = {};
  Rows normal = {};  ///< may have no rows for any derivatives
};

/// The caller's own memory for frames, contiguous rows of nine numbers, and for positions.
struct FrameArrays {
  EvaluationArrays<double>::Rows position = {};  ///< no memory: no positions are wanted
  EvaluationArrays<double>::Rows frame = {};     ///< 9 count numbers
};

/// Principal curvatures k1 >= k2 with their unit directions in space; mean = (k1 + k2) / 2,
/// gaussian = k1 k2. Signs follow the normal: a sphere seen from outside has negative curvatures.
struct Curvature {
  Eigen::VectorXd gaussian, mean, k1, k2;
  Points direction1, direction2;
  /// Whether the location is exactly at an irregular vertex. There the other members are no
  /// curvature of the surface, but what IrregularRule says.
  Eigen::Array<bool, Eigen::Dynamic, 1> irregular;
};

/// The caller's own memory for curvatures, contiguous and with a row for each location: directions
/// have three numbers a row, all else has one.
struct CurvatureArrays {
  using Rows = EvaluationArrays<double>::Rows;
  struct Flags {
    bool* flags = nullptr;  ///< count of them
    std::size_t count = 0;
  };
  Rows gaussian = {}, mean = {}, k1 = {}, k2 = {};
  Rows direction1 = {}, direction2 = {};
  Flags irregular = {};
};

/// What curvature() gives exactly at irregular vertices, where curvature has no limit.
enum class IrregularRule {
  none,     ///< NaN
  average,  ///< a mean over the faces around the vertex
};

/// The default radius, as a share of an edge, within which curvature is averaged around an
/// irregular vertex: small beside any detail of the surface, and far above the radii at which
/// curvature loses digits.
constexpr double kCurvatureRadius = 1. / 64;

/// Throws std::invalid_argument unless 0 < radius <= 1/2.
void checkCurvatureRadius(double radius);

/// Curvature, relative to the larger of |k1| and |k2| (gaussian: three times this, relative to its
/// square), and averaged curvature, relative to the largest of them among the averaged places.
/// Measured, on surfaces that bend: curvatures that the rounding of positions alone would make are
/// rounding. Holds to 2^-40 of a face beside irregular vertices of up to 64 faces; further in, more
/// and more digits are lost where the eigenvalues of the largest modes are equal or close.
constexpr double kCurvatureError = 1e-9;

/// Sparse linear weights on the control mesh's vertices, one row per location (CSR).
struct Stencils {
  LargePageVector<std::int64_t> offsets;
  LargePageVector<int> indices;
  LargePageVector<double> weights, du_weights, dv_weights;  ///< the latter two only if asked for
};

/// Data of any number of columns, one row per vertex or value.
using DataRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class SurfaceData;     // surface_data.h
class SurfacePatches;  // surface_patches.h

/// The Catmull-Clark limit surface of a control mesh, evaluated exactly at any location.
///
/// The topology is analysed once, in the constructor; from then on positions and derivatives
/// anywhere are linear combinations of the control points. Locations are Ptex face ids with (u, v);
/// see Location in types.h.
///
/// Every batch call takes `threads`: 0 means all cores, n means at most n of them. The result for a
/// location does not depend on it, nor on what else is in the batch, to the last bit. All const
/// members may be called from many threads at once.
///
/// A location that cannot be evaluated makes a batch call throw, before any work is done unless the
/// call says otherwise: LocationError names the first row whose face or (u, v) is out of range,
/// MeshError the first row whose face is refused.
///
/// Memory: the control mesh, 76 bytes for each regular face, O(neighbourhood) for an irregular one,
/// O(valence) for an extraordinary vertex, and about 4 KiB for each step in which a semi-sharp
/// vertex or edge decays. An edge that belongs to a run of equal sharpness through regular vertices
/// costs no more than a smooth one.
class LimitSurface {
 public:
  // Construction and posing.
  //
  // Construct a surface once for each topology. A deforming mesh keeps its surface: setPositions()
  // gives the surface the control points of another frame, at the cost of the irregular faces
  // alone.

  /// Throws MeshError where OpenSubdiv cannot represent the topology.
  explicit LimitSurface(ControlMesh mesh);
  ~LimitSurface();
  LimitSurface(LimitSurface&&) noexcept;
  LimitSurface& operator=(LimitSurface&&) noexcept;

  const ControlMesh& mesh() const;
  /// The current positions of the control points: the mesh's, until setPositions() gives others.
  const Points& positions() const;

  /// Gives the same topology another pose. Throws MeshError as ControlMesh does for positions, and
  /// then leaves the surface as it was. Must not be called while another thread evaluates.
  ///
  /// If an InterruptionPoint ends it, positions() are as before and isPosed() may be false: then
  /// setPositions(positions()) restores the pose, and nothing may be evaluated before.
  void setPositions(Points positions, int threads = 0);
  bool isPosed() const;

  // Faces and locations.
  //
  // These translate between the control mesh and Ptex faces, and say which faces have no limit
  // surface. Look at refused() where a mesh comes from outside.

  /// The number of Ptex faces.
  int faceCount() const;
  /// For each Ptex face, the face of the control mesh to which it belongs, and the corner of that
  /// n-gon at which it lies (0 for quads).
  const std::vector<int>& baseFace() const;
  const std::vector<int>& corner() const;
  /// The faces of the control mesh that have no limit surface (including holes), with the reason.
  const std::map<int, std::string>& refused() const;
  /// One location for each vertex of the control mesh; its face is -1 for vertices that no face
  /// with a limit surface uses.
  std::vector<Location> vertexLocations() const;

  /// Checks a batch, and throws as evaluate() does. Pass the result instead of the locations to
  /// members that are called for several parts of one batch, or one after the other: they do not
  /// check it again.
  LocationBatch checkLocations(const LocationBatch& at, int threads = 0) const;

  // Evaluation.

  /// Limit positions and derivatives with respect to the face's own (u, v).
  ///
  /// Properties:
  ///   (1) rotating a quad's vertex order rotates (u, v) and moves no position by more than
  ///       kPositionError;
  ///   (2) on a shared edge both faces give the same position to kPositionError;
  ///   (3) any number of threads gives the same bits.
  ///
  /// Exactly at an irregular vertex there is always a position. Along a boundary or an infinitely
  /// sharp edge that bounds the face, du, dv and second derivatives are those of the limit curve.
  /// At interior valence 2 and 3, du = dv = 0. All other derivatives have no limit and are NaN. The
  /// normal is NaN where approaches to the vertex within the face's sector do not agree on one
  /// (interior valence 2, boundaries with four and more faces), and anywhere its condition number
  /// exceeds kMostNormalCondition. Use frames() where a direction is needed.
  ///
  /// `normals` asks for unit normals (and needs derivatives >= first).
  ///
  /// Cost: O(1) for each location, but O(valence) within 2^-4 of an extraordinary vertex.
  Evaluation evaluate(const LocationBatch& at, Derivatives derivatives = Derivatives::none,
                      bool normals = false, int threads = 0) const;

  /// The same, written to arrays of double or float: what `derivatives` asks for, and normals if
  /// there are rows for them. Throws std::invalid_argument, and writes nothing, unless each has as
  /// many rows as there are locations. A wrong location may be found after some rows are written.
  template <typename Real>
  void evaluate(const LocationBatch& at, Derivatives derivatives,
                const EvaluationArrays<Real>& results, int threads = 0) const;

  // Frames and curvature.
  //
  // frames() is for whatever has to stand on the surface (hair, instances): unlike du, dv and the
  // normal it is defined at every location. curvature() is for analysis and for maps.

  /// Row-major 3 x 3 rotations, nine numbers in a row, with the columns tangent (along du), normal
  /// x tangent, normal. They are always finite: at an irregular vertex they are the limit over u =
  /// v = 2^-n as seen from the vertex (where even and odd n approach different directions, as at
  /// interior vertices of two faces, their mean or one of them); where du or the normal vanishes,
  /// they are completed from dv, then from the least aligned world axis.
  Rotations frames(const LocationBatch& at, int threads = 0) const;

  /// The same, written to arrays, with the positions of evaluate() where there is an array for
  /// them: they cost nothing more. Throws std::invalid_argument for an array that has another
  /// number of rows than there are locations, and then writes nothing.
  void frames(const LocationBatch& at, const FrameArrays& results, int threads = 0) const;

  /// Curvature. Exactly at irregular vertices, where it has no limit, `rule` says what is given.
  ///
  /// The average at a vertex is taken over the faces of the location's own sector: those that no
  /// boundary and no infinitely sharp edge separates from its face. On each of them there are four
  /// places on the square with the vertex at one corner and sides of `radius` edges: at (1, 1/4),
  /// (1, 3/4), (3/4, 1) and (1/4, 1) times the side as seen from the vertex. The side is `radius`
  /// in u and v on a quad, and twice that on a sub-face of an n-gon, whose sides are half edges.
  /// The shape operators at the places, each turned by the shortest rotation into the vertex's
  /// tangent plane, are averaged, weighted by area (|du x dv|, counted in edges): this is the
  /// midpoint rule for the mean over a thin band around the vertex. Principal curvatures and
  /// directions are those of the mean; `gaussian` is the product of its k1 and k2, not a mean of
  /// products.
  ///
  /// Where the vertex has no normal, the plane is perpendicular to the mean of the places' normals
  /// weighted by area, or to one of them if these cancel out. Places where the surface is singular
  /// or turned the opposite way are left out. If none remains, everything is NaN.
  ///
  /// Properties:
  ///   (1) all locations that name the same vertex in the same sector get the same bits;
  ///   (2) a mesh that is subdivided once gives the same at twice the radius.
  ///
  /// Error: kCurvatureError. Throws std::invalid_argument for a radius outside (0, 1/2].
  /// Cost: O(Ptex faces) if any row needs an average, and O(valence^2) for each vertex.
  Curvature curvature(const LocationBatch& at, IrregularRule rule = IrregularRule::none,
                      double radius = kCurvatureRadius, int threads = 0) const;
  /// The same, written into the caller's own memory. Throws std::invalid_argument for an array of
  /// another size than the batch; where it throws, rows may be half written.
  void curvature(const LocationBatch& at, const CurvatureArrays& results,
                 IrregularRule rule = IrregularRule::none, double radius = kCurvatureRadius,
                 int threads = 0) const;

  // Weights.
  //
  // The surface is linear in the control points. Take stencils() where the same locations are
  // evaluated for many poses outside of this library, or where a solver needs the linear map; take
  // tiles() where another program (a shader, a node tree) evaluates many locations itself.

  /// The exact linear weights of the position (and of du and dv) on the control mesh's vertices.
  /// Cost: O(1) for each location, but O(valence log valence) on faces of an extraordinary vertex,
  /// and O(valence^2) at a dart.
  Stencils stencils(const LocationBatch& at, bool first_derivatives = false, int threads = 0) const;

  /// The bicubic tiles that the locations lie in, for evaluating them elsewhere and in other poses.
  /// Tiles near extraordinary vertices are at most `max_depth` halvings of a face deep: a location
  /// nearer to the vertex is moved (SurfaceTiles::moved). Faces are split until sharpness
  /// has decayed and each part has at most one irregular vertex; these parts are split once more.
  /// This does not depend on `max_depth`.
  ///
  /// Depends on the topology alone, not on the pose. Error: kTilePositionError and
  /// kTileDerivativeError. Throws std::invalid_argument for a max_depth outside
  /// [1, SurfaceTiles::kLargestDepth], and for more than SurfaceTiles::kMostWeights. Cost: O(1) for
  /// each location, and O(valence log valence) for each tile beside an extraordinary vertex,
  /// O(valence^2) at a dart; the rows of its points are as long as its neighbourhood is large.
  SurfaceTiles tiles(const LocationBatch& at, int max_depth = SurfaceTiles::kDefaultDepth,
                     int threads = 0, const Progress& progress = {}) const;

  /// Where the locations lie in these tiles, without the tiles, whose weights are what takes time.
  /// Cost: O(1) for each location.
  TilePlaces tilePlaces(const LocationBatch& at, int max_depth = SurfaceTiles::kDefaultDepth,
                        int threads = 0) const;

  // Data on the surface.
  //
  // UV maps, colours, rest positions, weights: values at vertices or face corners that are
  // interpolated by the surface's own rules. They do not depend on the surface's pose.

  /// Face-varying data: `indices` holds a row of `values` for every corner of the mesh's faces, one
  /// face after the other. Where all corners around a vertex have the same row, the data are as
  /// smooth as the surface; edges between different rows are seams.
  ///
  /// The rules are OpenSubdiv's, for seams, their ends and junctions, boundaries and corners,
  /// smooth and sharp. Faces that have no limit surface have no data either.
  ///
  /// Throws MeshError, which names the first index that is no row of `values` or the first row that
  /// is not finite or beyond kLargestCoordinate. Cost: as for the construction of a surface.
  SurfaceData faceVarying(const DataRows& values, const std::vector<std::int64_t>& indices,
                          Interpolation interpolation, int threads = 0) const;

  /// Data at the vertices, one row for each, interpolated as positions are. Throws MeshError for
  /// another number of rows and for the first row that is not finite or beyond kLargestCoordinate.
  /// Cost: that of setPositions() for every three columns.
  SurfaceData vertexData(const DataRows& values, int threads = 0) const;

  /// Data at the vertices that are linear along edges and bilinear on each Ptex face: a sub-face of
  /// an n-gon has the values of its corner, of the midpoints of its edges, and the mean of all
  /// corners.
  SurfaceData varying(const DataRows& values, int threads = 0) const;

  // Bounds.
  //
  // The control points bound the surface as well, but not tightly. (Searches and integrals over the
  // surface are other classes: search/surface_search.h, sample/.)

  /// The tightest axis-aligned box around the limit surface (rows: minimum, maximum), to
  /// kPositionError.
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> bounds(int threads = 0) const;

 private:
  friend class FixedSamples;
  friend class StrandPoser;
  friend class SurfacePatches;
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
