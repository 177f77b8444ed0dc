// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "limitsurf/error.h"
#include "limitsurf/rules/subdivision_options.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The subdivision scheme.
enum class Scheme {
  catmark,   ///< Catmull-Clark
  bilinear,  ///< vertices and edges stay where they are, so that each Ptex face is a bilinear
             ///< patch; sharpness has no effect
};

/// Sharpness of edges, each given by its two vertices. 0 is smooth; 10 and more (infinity included)
/// is infinitely sharp. Values are rounded to float, as in OpenSubdiv. An edge that is
/// given again must have the same value.
struct EdgeSharpness {
  std::vector<std::pair<std::int64_t, std::int64_t>> edges;
  std::vector<double> values;
};

/// Sharpness of vertices, with the same meaning.
struct VertexSharpness {
  std::vector<std::int64_t> vertices;
  std::vector<double> values;
};

struct MeshOptions : SubdivisionOptions {
  Scheme scheme = Scheme::catmark;
  EdgeSharpness edge_sharpness;
  VertexSharpness vertex_sharpness;
  std::vector<std::int64_t>
      holes;  ///< faces that have no surface, but shape that of their neighbours
};

/// The control mesh (cage): positions, faces of any size, and the rules of their subdivision.
///
/// A ControlMesh is checked when it is made and immutable afterwards. The constructor throws
/// MeshError, which names the face or vertex and the value, for:
///   - no faces at all;
///   - face_sizes that do not add up to the number of face_vertices, or a size below 3 or above
///     OpenSubdiv's limit of 65,535;
///   - a vertex index below 0 or past the last position;
///   - a position that is NaN or infinite, or beyond kLargestCoordinate;
///   - positions that differ, but by less than kLeastExtent;
///   - more than 65,535 edges at one vertex;
///   - sharpness that is negative or NaN, or on an edge or vertex that the mesh does not have;
///   - a hole that is no face of the mesh.
///
/// Errors that concern some faces only are accepted here and reported by LimitSurface::refused(): a
/// face that uses a vertex twice. As in OpenSubdiv, edges of three and more faces, or of two faces
/// of opposite winding, are infinitely sharp, and so are vertices at which such edges end or at
/// which sheets of faces meet. Where two such edges run through a vertex as a crease, all its faces
/// follow the crease, those that touch it there alone as well. Isolated vertices belong to no face
/// and have no effect.
class ControlMesh {
 public:
  ControlMesh(Points positions, const std::vector<std::int64_t>& face_sizes,
              const std::vector<std::int64_t>& face_vertices, MeshOptions options = {});

  const Points& positions() const { return positions_; }
  const MeshOptions& options() const { return options_; }

  int vertexCount() const { return static_cast<int>(positions_.rows()); }
  int faceCount() const { return static_cast<int>(face_offsets_.size()) - 1; }
  int faceSize(int face) const { return face_offsets_[face + 1] - face_offsets_[face]; }
  /// The index of the face's first vertex in faceVertices().
  int firstCorner(int face) const { return face_offsets_[face]; }
  Span<int> faceVertices(int face) const {
    return Span<int>(face_vertices_).subspan(face_offsets_[face], faceSize(face));
  }
  /// The vertices of all faces, one face after the other.
  const std::vector<int>& faceVertices() const { return face_vertices_; }
  std::vector<int> faceSizes() const;

 private:
  Points positions_;
  std::vector<int> face_offsets_;
  std::vector<int> face_vertices_;
  MeshOptions options_;
};

/// Coordinates reach so far at most: 2^400, about 2.6e120. Squares of lengths, and what is computed
/// from them, then neither overflow nor underflow.
constexpr double kLargestCoordinate = 0x1p400;
/// The longest side of the positions' bounding box is 0, or at least so long.
constexpr double kLeastExtent = 0x1p-400;

/// Throws MeshError for another number of rows than vertices, for the first row that is not finite
/// or beyond kLargestCoordinate, which it names, and for positions closer together than
/// kLeastExtent.
void checkPositions(const RowsIn<Points>& positions, int vertex_count, int threads);

}  // namespace limitsurf
