// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/tessellate/tessellation_levels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/rules/subdivision_rules.h"
#include "limitsurf/tessellate/cage_edges.h"
#include "limitsurf/tessellate/tessellated_face.h"

namespace limitsurf {
namespace {

/// The number of segments of each side of a Ptex face in which lengths are measured.
constexpr int kLengthSamples = 8;
/// The number of faces between two reports of the progress.
constexpr std::size_t kFacesPerReport = 1024;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Throws std::invalid_argument for a size or options out of range.
void check(double size, const char* name, const LevelOptions& options) {
  checkThreads(options.threads);
  if (!(size > 0) || !std::isfinite(size)) {
    throw std::invalid_argument(std::string(name) + " is " + numberText(size) +
                                "; it must be above 0 and finite");
  }
  if (options.most < 1 || options.most > kMostTessellationLevels) {
    throw std::invalid_argument("most is " + std::to_string(options.most) + "; expected 1 to " +
                                std::to_string(kMostTessellationLevels));
  }
}

/// The squares (Ptex faces) of the mesh's faces, and which edges of the mesh are kinks: boundaries
/// and infinitely sharp edges.
class Squares {
 public:
  explicit Squares(const LimitSurface& surface)
      : mesh_(surface.mesh()), refused_(surface.refused()), edges_(mesh_) {
    const std::vector<int>& base = surface.baseFace();
    first_.assign(static_cast<std::size_t>(mesh_.faceCount()), 0);
    for (int i = static_cast<int>(base.size()); i-- > 0;) {
      first_[base[i]] = i;
    }
    std::vector<int> faces_at(edges_.count, 0);
    for (int face = 0; face < mesh_.faceCount(); ++face) {
      if (!refused_.count(face)) {
        faces_.push_back(face);
        for (int k = 0; k < mesh_.faceSize(face); ++k) {
          ++faces_at[edgeOf(face, k)];
        }
      }
    }
    const EdgeSharpness& sharpness = mesh_.options().edge_sharpness;
    std::set<std::pair<int, int>> sharp;
    for (std::size_t i = 0; i < sharpness.edges.size(); ++i) {
      if (isInfinitelySharp(static_cast<float>(sharpness.values[i]))) {
        const auto [a, b] = sharpness.edges[i];
        sharp.emplace(static_cast<int>(std::min(a, b)), static_cast<int>(std::max(a, b)));
      }
    }
    is_kink_.assign(edges_.count, false);
    for (const int face : faces_) {
      const Span<int> vertices = mesh_.faceVertices(face);
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const auto ends = std::minmax(vertices[k], vertices[(k + 1) % vertices.size()]);
        const int edge = edgeOf(face, static_cast<int>(k));
        is_kink_[edge] = faces_at[edge] != 2 || sharp.count(ends) != 0;
      }
    }
  }

  const std::vector<int>& faces() const { return faces_; }
  bool isQuad(int face) const { return mesh_.faceSize(face) == 4; }
  int count(int face) const { return isQuad(face) ? 1 : mesh_.faceSize(face); }
  int first(int face) const { return first_[face]; }
  int leastLevel(int face) const { return isQuad(face) ? 0 : 1; }
  /// The number of quads along a side of the face's squares.
  int quads(int face, int level) const { return 1 << (isQuad(face) ? level : level - 1); }

  /// For each side of a square, counter-clockwise from (0, 0), whether it is a kink.
  std::array<bool, 4> kinks(int face, int square) const {
    if (isQuad(face)) {
      return {isKink(face, 0), isKink(face, 1), isKink(face, 2), isKink(face, 3)};
    }
    const int size = mesh_.faceSize(face);
    return {isKink(face, square), false, false, isKink(face, (square + size - 1) % size)};
  }

  /// Raises levels until none is more than kLargestLevelStep below that of a neighbour.
  void grade(std::vector<int>& levels) const {
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<int> at_edge(edges_.count, 0);
      for (const int face : faces_) {
        for (int k = 0; k < mesh_.faceSize(face); ++k) {
          int& level = at_edge[edgeOf(face, k)];
          level = std::max(level, levels[face]);
        }
      }
      for (const int face : faces_) {
        for (int k = 0; k < mesh_.faceSize(face); ++k) {
          const int least = at_edge[edgeOf(face, k)] - kLargestLevelStep;
          changed = changed || levels[face] < least;
          levels[face] = std::max(levels[face], least);
        }
      }
    }
  }

 private:
  int edgeOf(int face, int k) const { return edges_.of_corner[mesh_.firstCorner(face) + k]; }
  bool isKink(int face, int k) const { return is_kink_[edgeOf(face, k)]; }

  const ControlMesh& mesh_;
  const std::map<int, std::string>& refused_;
  const CageEdges edges_;
  std::vector<int> faces_, first_;
  std::vector<bool> is_kink_;
};

/// The surface at the places (i, j) / side of one Ptex face.
class Samples {
 public:
  Samples(const LimitSurface& surface, int face, int side, bool normals) : side_(side) {
    std::vector<Location> at;
    at.reserve(static_cast<std::size_t>(side + 1) * (side + 1));
    for (int j = 0; j <= side; ++j) {
      for (int i = 0; i <= side; ++i) {
        at.push_back({face, static_cast<double>(i) / side, static_cast<double>(j) / side});
      }
    }
    at_ = surface.evaluate(at, normals ? Derivatives::first : Derivatives::none, normals, 1);
  }

  int side() const { return side_; }
  Vector3 position(int i, int j) const { return at_.position.row(j * (side_ + 1) + i); }
  Vector3 normal(int i, int j) const { return at_.normal.row(j * (side_ + 1) + i); }

 private:
  const int side_;
  Evaluation at_;
};

/// The deviation between the surface and a quad of the tessellation, cut along either diagonal. The
/// quad begins at the sample (i0, j0).
double quadDeviation(const Samples& at, int i0, int j0, int size) {
  const Vector3 p00 = at.position(i0, j0), p10 = at.position(i0 + size, j0),
                p01 = at.position(i0, j0 + size), p11 = at.position(i0 + size, j0 + size);
  double largest = 0;
  for (int j = 0; j <= size; ++j) {
    for (int i = 0; i <= size; ++i) {
      const Vector3 normal = at.normal(i0 + i, j0 + j);
      if (!normal.allFinite()) {
        continue;  // an irregular vertex, at which the polygon touches the surface
      }
      const double x = static_cast<double>(i) / size, y = static_cast<double>(j) / size;
      const Vector3 here = at.position(i0 + i, j0 + j);
      const Vector3 rising = x > y ? Vector3(p00 + x * (p10 - p00) + y * (p11 - p10))
                                   : Vector3(p00 + y * (p01 - p00) + x * (p11 - p01));
      const Vector3 falling = x + y < 1
                                  ? Vector3(p00 + x * (p10 - p00) + y * (p01 - p00))
                                  : Vector3(p11 + (1 - x) * (p01 - p11) + (1 - y) * (p10 - p11));
      largest = std::max(
          {largest, std::abs(normal.dot(rising - here)), std::abs(normal.dot(falling - here))});
    }
  }
  return largest;
}

/// The deviation between segments of `size` samples along a side and the curve of the side.
double sideDeviation(const Samples& at, int number, int size) {
  const int n = at.side();
  const auto place = [&](int k) {
    return number == 0   ? at.position(k, 0)
           : number == 1 ? at.position(n, k)
           : number == 2 ? at.position(k, n)
                         : at.position(0, k);
  };
  double largest = 0;
  for (int begin = 0; begin < n; begin += size) {
    const Vector3 from = place(begin), along = place(begin + size) - from;
    const double squared = along.squaredNorm();
    for (int k = 1; k < size; ++k) {
      const Vector3 there = place(begin + k) - from;
      const double part = squared > 0 ? std::clamp(there.dot(along) / squared, 0., 1.) : 0;
      largest = std::max(largest, (there - part * along).norm());
    }
  }
  return largest;
}

/// The largest deviation of a face at a level.
double deviation(const LimitSurface& surface, const Squares& squares, int face, int level) {
  const int quads = squares.quads(face, level);
  const int size = std::max(2, kDeviationSamples / quads);
  double largest = 0;
  for (int square = 0; square < squares.count(face); ++square) {
    const Samples at(surface, squares.first(face) + square, quads * size, true);
    for (int j = 0; j < at.side(); j += size) {
      for (int i = 0; i < at.side(); i += size) {
        largest = std::max(largest, quadDeviation(at, i, j, size));
      }
    }
    const std::array<bool, 4> kinks = squares.kinks(face, square);
    for (int side = 0; side < 4; ++side) {
      if (kinks[side]) {
        largest = std::max(largest, sideDeviation(at, side, size));
      }
    }
  }
  return largest;
}

/// The length in the picture of the segment between two points of space.
double seenLength(const PictureView& view, const Vector3& from, const Vector3& to) {
  Eigen::Vector4d a = view.matrix * from.homogeneous(), b = view.matrix * to.homogeneous();
  const auto clip = [&](Eigen::Vector4d& hidden, const Eigen::Vector4d& seen) {
    if (hidden.w() < view.nearest) {
      hidden += (view.nearest - hidden.w()) / (seen.w() - hidden.w()) * (seen - hidden);
    }
  };
  if (!(std::max(a.w(), b.w()) > view.nearest)) {
    return 0;
  }
  clip(a, b);
  clip(b, a);
  return (a.head<2>() / a.w() - b.head<2>() / b.w()).norm();
}

/// The length of a segment in space, or in the picture of `view`.
double lengthOf(const PictureView* view, const Vector3& from, const Vector3& to) {
  return view ? seenLength(*view, from, to) : (to - from).norm();
}

/// The lengths of the sides of polygons on a face, for all numbers of quads along a side of its
/// squares.
class SideLengths {
 public:
  SideLengths(const LimitSurface& surface, const Squares& squares, int face,
              const PictureView* view) {
    for (int square = 0; square < squares.count(face); ++square) {
      const Samples at(surface, squares.first(face) + square, kLengthSamples, false);
      for (int j = 0; j <= at.side(); ++j) {
        std::array<double, kLengthSamples> along_u, along_v;
        for (int i = 0; i < at.side(); ++i) {
          along_u[i] = lengthOf(view, at.position(i, j), at.position(i + 1, j));
          along_v[i] = lengthOf(view, at.position(j, i), at.position(j, i + 1));
        }
        addLine(j, along_u);
        addLine(j, along_v);
      }
    }
  }

  /// The longest side of this many quads. Sides longer than the distance between samples are
  /// measured along the surface, from sample to sample; those that are shorter are taken for equal
  /// parts of it.
  double longest(int quads) const {
    const int step = std::max(1, kLengthSamples / quads);
    return longest_[step] * std::min(1., static_cast<double>(kLengthSamples) / quads);
  }

 private:
  /// Measures the sides on line number `j`, which lies on a line of 1, 2, 4, ... quads if it is a
  /// multiple of 8, 4, 2, ...
  void addLine(int j, const std::array<double, kLengthSamples>& lengths) {
    for (int step = 1; step <= kLengthSamples && j % step == 0; step *= 2) {
      for (int i = 0; i < kLengthSamples; i += step) {
        const double side = std::accumulate(&lengths[i], &lengths[i] + step, 0.);
        longest_[step] = std::max(longest_[step], side);
      }
    }
  }

  std::array<double, kLengthSamples + 1> longest_{};  // by the samples on a side: 1, 2, 4 or 8
};

/// The longest side of the four quads at each corner of a face's squares, of which each side has so
/// many quads. Beside an irregular vertex sides become smaller from level to level, but not by half
/// as elsewhere.
double longestAtCorners(const LimitSurface& surface, const Squares& squares, int face, int quads,
                        const PictureView* view) {
  constexpr int kSide = 3;  // points
  std::vector<Location> at;
  for (int square = 0; square < squares.count(face); ++square) {
    for (const auto& [right, top] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
      for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
          const auto place = [&](int k, int far) {
            return static_cast<double>(far ? quads - k : k) / quads;
          };
          at.push_back({squares.first(face) + square, place(i, right), place(j, top)});
        }
      }
    }
  }
  const Points points = surface.evaluate(at, Derivatives::none, false, 1).position;
  double longest = 0;
  const auto look = [&](Eigen::Index from, Eigen::Index to) {
    longest = std::max(longest, lengthOf(view, points.row(from), points.row(to)));
  };
  for (Eigen::Index first = 0; first < points.rows(); first += kSide * kSide) {
    for (Eigen::Index j = 0; j < kSide; ++j) {
      for (Eigen::Index i = 0; i + 1 < kSide; ++i) {
        look(first + kSide * j + i, first + kSide * j + i + 1);
        look(first + kSide * i + j, first + kSide * (i + 1) + j);
      }
    }
  }
  return longest;
}

/// The lowest level that each face may have.
FaceLevels lowest(const LimitSurface& surface, const Squares& squares) {
  const auto count = static_cast<Eigen::Index>(surface.mesh().faceCount());
  FaceLevels result{std::vector<int>(static_cast<std::size_t>(count), 0),
                    Eigen::VectorXd::Constant(count, kNaN)};
  for (const int face : squares.faces()) {
    result.levels[face] = squares.leastLevel(face);
  }
  return result;
}

/// Calls body(i) for i in [0, count), in parallel, and reports the progress from `begin` to `end`.
template <typename Body>
void forEachFace(std::size_t count, const LevelOptions& options, double begin, double end,
                 const Body& body) {
  for (std::size_t first = 0; first < count; first += kFacesPerReport) {
    const std::size_t some = std::min(kFacesPerReport, count - first);
    parallelFor(some, 1, options.threads, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        body(first + i);
      }
    });
    if (options.progress) {
      options.progress(begin + (end - begin) * static_cast<double>(first + some) /
                                   static_cast<double>(count));
    }
  }
}

void checkView(const PictureView& view) {
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      if (!std::isfinite(view.matrix(row, column))) {
        throw std::invalid_argument("matrix has " + numberText(view.matrix(row, column)) +
                                    " in row " + std::to_string(row) + ", column " +
                                    std::to_string(column) + "; it must be finite");
      }
    }
  }
  if (!std::isfinite(view.nearest)) {
    throw std::invalid_argument("nearest is " + numberText(view.nearest) + "; it must be finite");
  }
}

}  // namespace

FaceLevels levelsWithin(const LimitSurface& surface, double tolerance,
                        const LevelOptions& options) {
  check(tolerance, "tolerance", options);
  const Squares squares(surface);
  FaceLevels result = lowest(surface, squares);
  std::vector<int> coarse = squares.faces();
  for (int round = 0; !coarse.empty(); ++round) {
    const double begin = 1 - std::pow(0.5, round), end = 1 - std::pow(0.5, round + 1);
    forEachFace(coarse.size(), options, begin, end, [&](std::size_t i) {
      const int face = coarse[i];
      result.measure[face] = deviation(surface, squares, face, result.levels[face]);
    });
    const auto is_done = [&](int face) {
      return result.measure[face] <= tolerance || result.levels[face] == options.most;
    };
    coarse.erase(std::remove_if(coarse.begin(), coarse.end(), is_done), coarse.end());
    for (const int face : coarse) {
      ++result.levels[face];
    }
  }
  squares.grade(result.levels);
  return result;
}

FaceLevels levelsOfLength(const LimitSurface& surface, double length, const PictureView* view,
                          const LevelOptions& options) {
  check(length, "length", options);
  if (view) {
    checkView(*view);
  }
  const Squares squares(surface);
  FaceLevels result = lowest(surface, squares);
  const std::vector<int>& faces = squares.faces();
  forEachFace(faces.size(), options, 0, 1, [&](std::size_t i) {
    const int face = faces[i];
    const SideLengths lengths(surface, squares, face, view);
    int& level = result.levels[face];
    double& measure = result.measure[face];
    const auto is_done = [&] { return measure <= length || level == options.most; };
    for (;; ++level) {
      const int quads = squares.quads(face, level);
      measure = lengths.longest(quads);
      if (is_done() && quads > kLengthSamples) {
        measure = std::max(measure, longestAtCorners(surface, squares, face, quads, view));
      }
      if (is_done()) {
        break;
      }
    }
  });
  squares.grade(result.levels);
  return result;
}

}  // namespace limitsurf
