// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/control_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "limitsurf/interruption_point.h"
#include "limitsurf/mesh/limits.h"
#include "limitsurf/mesh/messages.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

void checkSizes(const std::vector<std::int64_t>& sizes, std::size_t index_count) {
  std::size_t sum = 0;
  for (std::size_t f = 0; f < sizes.size(); ++f) {
    if (sizes[f] < 3) {
      refuse("face_sizes: face ", f, " has ", sizes[f], " vertices; a face needs at least 3");
    }
    if (sizes[f] > kMaxValence) {
      refuse("face_sizes: face ", f, " has ", sizes[f], " vertices; the limit is ", kMaxValence);
    }
    sum += static_cast<std::size_t>(sizes[f]);
  }
  if (sum != index_count) {
    refuse("face_sizes add up to ", sum, " but face_vertices has ", index_count, " entries");
  }
  if (sum > static_cast<std::size_t>(kMaxCorners)) {
    refuse("the mesh has ", sum, " face corners; the limit is ", kMaxCorners);
  }
}

/// The edges of a mesh, found by their ends.
class EdgeTable {
 public:
  explicit EdgeTable(const ControlMesh& mesh)
      : first_(static_cast<std::size_t>(mesh.vertexCount()) + 1, 0) {
    InterruptionStride stride;
    forEachSide(mesh, [&](int low, int) {
      stride.step();
      ++first_[low + 1];
    });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    high_.resize(mesh.faceVertices().size());
    std::vector<std::ptrdiff_t> next(first_.begin(), first_.end() - 1);
    forEachSide(mesh, [&](int low, int high) {
      stride.step();
      high_[next[low]++] = high;
    });
    for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
      stride.step();
      std::sort(high_.begin() + first_[vertex], high_.begin() + first_[vertex + 1]);
    }
  }

  /// The number of an edge, or -1 if there is none. Numbers are less than size().
  std::ptrdiff_t number(int low, int high) const {
    const auto end = high_.begin() + first_[low + 1];
    const auto place = std::lower_bound(high_.begin() + first_[low], end, high);
    return place == end || *place != high ? -1 : place - high_.begin();
  }
  std::size_t size() const { return high_.size(); }

 private:
  template <typename Body>
  static void forEachSide(const ControlMesh& mesh, const Body& body) {
    for (int f = 0; f < mesh.faceCount(); ++f) {
      const Span<int> vertices = mesh.faceVertices(f);
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto [low, high] = std::minmax(vertices[i], vertices[(i + 1) % vertices.size()]);
        body(low, high);
      }
    }
  }

  std::vector<std::ptrdiff_t> first_;  // of each vertex
  std::vector<int> high_;              // the other ends of its edges that are larger
};

template <typename Where>
void checkSharpness(const Where& where, double value) {
  if (std::isnan(value) || value < 0) {
    refuse(where(), " has sharpness ", value, "; sharpness is 0 or more");
  }
}

/// An edge or a vertex may be named again only with the same sharpness. `first_row` is the row that
/// named it first, or -1.
template <typename Where>
void checkAgain(const Where& where, std::ptrdiff_t& first_row, std::size_t row,
                const std::vector<double>& values) {
  if (first_row < 0) {
    first_row = static_cast<std::ptrdiff_t>(row);
  } else if (values[static_cast<std::size_t>(first_row)] != values[row]) {
    refuse(where(), " has sharpness ", values[row], ", but row ", first_row, " gives it ",
           values[static_cast<std::size_t>(first_row)]);
  }
}

void checkEdgeSharpness(const ControlMesh& mesh, const EdgeSharpness& sharpness) {
  if (sharpness.edges.size() != sharpness.values.size()) {
    refuse("edge_sharpness has ", sharpness.edges.size(), " edges but ", sharpness.values.size(),
           " values");
  }
  if (sharpness.edges.empty()) {
    return;
  }
  const EdgeTable edges(mesh);
  std::vector<std::ptrdiff_t> first_row(edges.size(), -1);
  InterruptionStride stride;
  for (std::size_t i = 0; i < sharpness.edges.size(); ++i) {
    stride.step();
    const auto [a, b] = std::minmax(sharpness.edges[i].first, sharpness.edges[i].second);
    const auto where = [&, row = i] {
      const auto& [first, second] = sharpness.edges[row];
      return text("edge_sharpness row ", row, ", edge (", first, ", ", second, ")");
    };
    const bool in_range = a >= 0 && b < mesh.vertexCount();
    const std::ptrdiff_t edge =
        in_range ? edges.number(static_cast<int>(a), static_cast<int>(b)) : -1;
    if (edge < 0) {
      refuse(where(), ": the mesh has no such edge");
    }
    checkSharpness(where, sharpness.values[i]);
    checkAgain(where, first_row[static_cast<std::size_t>(edge)], i, sharpness.values);
  }
}

void checkVertexSharpness(const ControlMesh& mesh, const VertexSharpness& sharpness) {
  if (sharpness.vertices.size() != sharpness.values.size()) {
    refuse("vertex_sharpness has ", sharpness.vertices.size(), " vertices but ",
           sharpness.values.size(), " values");
  }
  if (sharpness.vertices.empty()) {
    return;
  }
  std::vector<std::ptrdiff_t> first_row(static_cast<std::size_t>(mesh.vertexCount()), -1);
  for (std::size_t i = 0; i < sharpness.vertices.size(); ++i) {
    const std::int64_t vertex = sharpness.vertices[i];
    const auto where = [&, row = i] {
      return text("vertex_sharpness row ", row, ", vertex ", sharpness.vertices[row]);
    };
    if (vertex < 0 || vertex >= mesh.vertexCount()) {
      refuse(where(), ": the mesh has ", mesh.vertexCount(), " vertices");
    }
    checkSharpness(where, sharpness.values[i]);
    checkAgain(where, first_row[static_cast<std::size_t>(vertex)], i, sharpness.values);
  }
}

void checkHoles(const ControlMesh& mesh, const std::vector<std::int64_t>& holes) {
  for (const std::int64_t face : holes) {
    if (face < 0 || face >= mesh.faceCount()) {
      refuse("holes names face ", face, "; the mesh has ", mesh.faceCount(), " faces");
    }
  }
}

/// A vertex has at most twice as many edges as faces, so that edges are counted only at vertices
/// with more faces than half of kMaxValence.
void checkValences(const ControlMesh& mesh) {
  std::vector<int> faces_at(mesh.vertexCount(), 0);
  for (const int vertex : mesh.faceVertices()) {
    ++faces_at[vertex];
  }
  std::map<int, std::set<int>> neighbours;
  for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
    if (faces_at[vertex] > kMaxValence / 2) {
      neighbours[vertex];
    }
  }
  if (neighbours.empty()) {
    return;
  }
  for (int f = 0; f < mesh.faceCount(); ++f) {
    const Span<int> vertices = mesh.faceVertices(f);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const int a = vertices[i], b = vertices[(i + 1) % vertices.size()];
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        const auto known = neighbours.find(from);
        if (known != neighbours.end()) {
          known->second.insert(to);
        }
      }
    }
  }
  for (const auto& [vertex, others] : neighbours) {
    const std::size_t count = std::max(others.size(), static_cast<std::size_t>(faces_at[vertex]));
    if (count > static_cast<std::size_t>(kMaxValence)) {
      refuse("vertex ", vertex, " has ", count, " edges; the limit is ", kMaxValence);
    }
  }
}

/// The ranges of x, y and z in some rows, and whether all of them are finite.
struct Ranges {
  using Row = Eigen::Array<double, 1, 3>;

  /// At least one row.
  explicit Ranges(const RowsIn<Points>& rows) {
    // Four rows at a time, which the processor's vectors can hold without a gap.
    using Four = Eigen::Array<double, 1, 12>;
    const Eigen::Index fours = rows.rows() / 4;
    Four lows = rows.row(0).array().replicate<1, 4>(), highs = lows, zeros = Four::Zero();
    for (Eigen::Index i = 0; i < fours; ++i) {
      const Eigen::Map<const Four> four(rows.data() + 12 * i);
      lows = lows.min(four);
      highs = highs.max(four);
      zeros += 0 * four;  // becomes NaN by what is not finite
    }
    is_finite = zeros.isFinite().all();
    for (int i = 0; i < 4; ++i) {
      low = low.min(lows.segment<3>(3 * i));
      high = high.max(highs.segment<3>(3 * i));
    }
    for (Eigen::Index row = 4 * fours; row < rows.rows(); ++row) {
      low = low.min(rows.row(row).array());
      high = high.max(rows.row(row).array());
      is_finite &= rows.row(row).allFinite();
    }
  }
  Ranges() = default;

  void include(const Ranges& other) {
    low = low.min(other.low);
    high = high.max(other.high);
    is_finite &= other.is_finite;
  }

  Row low = Row::Constant(std::numeric_limits<double>::infinity()), high = -low;
  bool is_finite = true;
};

/// Throws MeshError for the first position that is not finite or too far away, if there is one.
void checkEach(const RowsIn<Points>& positions) {
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    if (!positions.row(v).allFinite()) {
      refuse("positions: vertex ", v, " has position (", positions(v, 0), ", ", positions(v, 1),
             ", ", positions(v, 2), "); positions must be finite");
    }
    if (positions.row(v).cwiseAbs().maxCoeff() > kLargestCoordinate) {
      refuse("positions: vertex ", v, " has position (", positions(v, 0), ", ", positions(v, 1),
             ", ", positions(v, 2), "); coordinates may be at most ", kLargestCoordinate);
    }
  }
}

}  // namespace

void checkPositions(const RowsIn<Points>& positions, int vertex_count, int threads) {
  if (positions.rows() != vertex_count) {
    refuse("positions has ", positions.rows(), " rows; the mesh has ", vertex_count, " vertices");
  }
  constexpr std::size_t kRowsPerPart = 65536;
  const auto count = static_cast<std::size_t>(positions.rows());
  std::vector<Ranges> parts((count + kRowsPerPart - 1) / kRowsPerPart);
  parallelFor(count, kRowsPerPart, threads, [&](std::size_t begin, std::size_t end) {
    parts[begin / kRowsPerPart] = Ranges(positions.middleRows(
        static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin)));
  });
  Ranges all;
  for (const Ranges& part : parts) {
    all.include(part);
  }
  if (!all.is_finite || (all.high > kLargestCoordinate).any() ||
      (all.low < -kLargestCoordinate).any()) {
    checkEach(positions);
  }
  const double extent = (all.high - all.low).maxCoeff();  // negative if there are no positions
  if (extent > 0 && extent < kLeastExtent) {
    refuse("positions: the mesh measures ", extent,
           " along its longest axis; it must measure at least ", kLeastExtent, ", or 0");
  }
}

ControlMesh::ControlMesh(Points positions, const std::vector<std::int64_t>& face_sizes,
                         const std::vector<std::int64_t>& face_vertices, MeshOptions options)
    : positions_(std::move(positions)), options_(std::move(options)) {
  if (positions_.rows() > kMaxCorners) {
    refuse("the mesh has ", positions_.rows(), " vertices; the limit is ", kMaxCorners);
  }
  checkPositions(positions_, static_cast<int>(positions_.rows()), 0);
  checkSizes(face_sizes, face_vertices.size());
  if (face_sizes.empty()) {
    refuse("the mesh has no faces");
  }

  face_offsets_.reserve(face_sizes.size() + 1);
  face_offsets_.push_back(0);
  for (const std::int64_t size : face_sizes) {
    face_offsets_.push_back(face_offsets_.back() + static_cast<int>(size));
  }
  face_vertices_.reserve(face_vertices.size());
  InterruptionStride stride;
  for (int f = 0; f < faceCount(); ++f) {
    stride.step();
    for (int i = face_offsets_[f]; i < face_offsets_[f + 1]; ++i) {
      if (face_vertices[i] < 0 || face_vertices[i] >= positions_.rows()) {
        refuse("face_vertices: face ", f, " names vertex ", face_vertices[i],
               ", but positions has ", positions_.rows(), " rows");
      }
      face_vertices_.push_back(static_cast<int>(face_vertices[i]));
    }
  }
  checkValences(*this);
  checkEdgeSharpness(*this, options_.edge_sharpness);
  checkVertexSharpness(*this, options_.vertex_sharpness);
  checkHoles(*this, options_.holes);
}

std::vector<int> ControlMesh::faceSizes() const {
  std::vector<int> sizes(faceCount());
  for (int f = 0; f < faceCount(); ++f) {
    sizes[f] = faceSize(f);
  }
  return sizes;
}

}  // namespace limitsurf
