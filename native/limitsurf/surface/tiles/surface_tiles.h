// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limitsurf {

/// Where locations lie in their tiles, one row each (SurfaceTiles says what that means).
struct TilePlaces {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> tile_uv, scale;
  /// Whether the location lies exactly at an extraordinary vertex, or in tiles deeper than allowed:
  /// the tile and the place in it are then those where the way from the vertex to the location (at
  /// the vertex itself, the face's diagonal) first reaches a tile that is allowed.
  std::vector<char> moved;
};

/// The bicubic tiles that some locations lie in: everything that a program of its own (a shader, a
/// node tree) needs to evaluate the limit surface there, in any pose of the cage. It is
/// OpenSubdiv's PatchTable with local point stencils, but exact: at any depth near an extraordinary
/// vertex, beside creases and boundaries, and on faces of any size.
///
/// Points have numbers: those below `cage_points` are the cage's vertices, the others are refined
/// points, linear in the cage. With V = cage_points, refined point V + r is the sum of
/// points_weights[k] times cage vertex points_indices[k] for k in
/// [points_offsets[r], points_offsets[r + 1]). Equal rows are stored once.
///
/// With p the points and b(t) = ((1 - t)^3, 3 t^3 - 6 t^2 + 4, -3 t^3 + 3 t^2 + 3 t + 1, t^3) / 6
/// the weights of a uniform cubic B-spline, location i lies in tile k = tile[i] at
/// (s, t) = tile_uv.row(i), and
///
///   P  = p[tile_anchor[k]] + sum over x, y of b_x(s) b_y(t) (p[tile_points[k][4 y + x]] - p[base])
///   du = scale(i, 0) times the sum's derivative by s; dv = scale(i, 1) times that by t
///
/// where base = tile_base[k]. s and t run along the Ptex face's own u and v.
///
/// Tiles that are small, near an extraordinary vertex or where sharpness decays, have an anchor
/// near them, control points whose weights add up to 0, and for base the point without weights,
/// which is the origin in every pose: so they keep their digits in single precision, too. All other
/// tiles have one of their own control points for both anchor and base.
struct SurfaceTiles : TilePlaces {
  int cage_points = 0;
  std::vector<std::int64_t> points_offsets{0};
  std::vector<int> points_indices;
  std::vector<double> points_weights;

  std::vector<std::array<int, 16>> tile_points;
  std::vector<int> tile_anchor, tile_base;

  std::vector<int> tile;  ///< one per location

  /// Tiles beside an extraordinary vertex are at least 2^-depth of a face wide, for the depth that
  /// LimitSurface::tiles() is given. This one suits float, whose coordinates do not tell places
  /// apart that are 2^-24 of an edge from each other.
  static constexpr int kDefaultDepth = 24;
  static constexpr int kLargestDepth = 256;
  /// The refined points have at most so many weights, which take 3 GiB. All tiles around a vertex
  /// of N faces have 900 N^2 to 2100 N^2 at the default depth.
  static constexpr std::size_t kMostWeights = std::size_t{1} << 28;
};

/// Bounds on what a tile gives when it is evaluated in double precision as written above. Measured,
/// against LimitSurface::evaluate(), on all golden meshes. Position: relative to the diagonal of
/// the cage's bounding box. Derivatives by s and t: relative to the larger of the value itself and
/// the tile's own size, the largest distance between two of its control points.
constexpr double kTilePositionError = 1e-14;
constexpr double kTileDerivativeError = 1e-12;

}  // namespace limitsurf
