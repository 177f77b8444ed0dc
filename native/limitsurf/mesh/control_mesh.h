// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "limitsurf/error.h"
#include "limitsurf/rules/subdivision_options.h"
#include "limitsurf/types.h"

namespace limitsurf {

enum class Scheme {
  catmark,
  bilinear,  ///< vertices and edges stay: each Ptex face is a bilinear patch, sharpness means
             ///< nothing
};

/// Sharpness of edges, each given by its two vertices: 0 is smooth, 10 and more (infinity included)
/// infinitely sharp. Rounded to float, as OpenSubdiv has it. Of an edge that is given twice the
/// last value counts.
struct EdgeSharpness {
  std::vector<std::pair<std::int64_t, std::int64_t>> edges;
  std::vector<double> values;
};

/// The same of vertices.
struct VertexSharpness {
  std::vector<std::int64_t> vertices;
  std::vector<double> values;
};

struct MeshOptions : SubdivisionOptions {
  Scheme scheme = Scheme::catmark;
  EdgeSharpness edge_sharpness;
  VertexSharpness vertex_sharpness;
  std::vector<std::int64_t>
      holes;  ///< faces that have no surface, though their neighbours see them
};

/// The control mesh (cage): positions, faces of any size, and the rules of their subdivision.
///
/// A ControlMesh is checked when it is made and immutable afterwards. What makes the mesh
/// meaningless throws MeshError, naming the face or vertex and the value:
///   - no faces at all;
///   - face_sizes that do not add up to the number of face_vertices, or a size below 3 or above
///     OpenSubdiv's limit of 65,535;
///   - a vertex index below 0 or past the last position;
///   - a position that is NaN or infinite;
///   - more than 65,535 edges at one vertex;
///   - sharpness that is negative or NaN, or on an edge or vertex that the mesh has not;
///   - a hole that is no face of the mesh.
///
/// What spoils some faces alone is accepted here and told by LimitSurface::refused(): a face that
/// uses a vertex twice, or that touches a crease between other faces. Edges of three and more
/// faces, or of two of opposite winding, are infinitely sharp, and so are vertices at which they
/// end or sheets meet, as OpenSubdiv has it. Isolated vertices belong to no face and change
/// nothing.
class ControlMesh {
 public:
  ControlMesh(Points positions, const std::vector<std::int64_t>& face_sizes,
              const std::vector<std::int64_t>& face_vertices, MeshOptions options = {});

  const Points& positions() const { return positions_; }
  const MeshOptions& options() const { return options_; }

  int vertexCount() const { return static_cast<int>(positions_.rows()); }
  int faceCount() const { return static_cast<int>(face_offsets_.size()) - 1; }
  int faceSize(int face) const { return face_offsets_[face + 1] - face_offsets_[face]; }
  /// Where the face's vertices begin among faceVertices().
  int firstCorner(int face) const { return face_offsets_[face]; }
  Span<int> faceVertices(int face) const {
    return Span<int>(face_vertices_).subspan(face_offsets_[face], faceSize(face));
  }
  /// All faces' vertices, one face after the other.
  const std::vector<int>& faceVertices() const { return face_vertices_; }
  std::vector<int> faceSizes() const;

 private:
  Points positions_;
  std::vector<int> face_offsets_;
  std::vector<int> face_vertices_;
  MeshOptions options_;
};

/// Throws MeshError naming the first row that is not finite, or a shape other than (vertices, 3).
void checkPositions(const Points& positions, int vertex_count);

}  // namespace limitsurf
