// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/path_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "limitsurf/number_text.h"
#include "limitsurf/own_unit.h"
#include "limitsurf/parallel.h"
#include "limitsurf/path/bezier_fit.h"
#include "limitsurf/path/space_curves.h"
#include "limitsurf/path/surface_distance.h"
#include "limitsurf/row_check.h"

namespace limitsurf {
namespace {

// Shares of the tolerance: for the path's points, and for the chords by which a segment is drawn.
constexpr double kForPoints = 0.6, kForChords = 0.2;
/// The share that a segment may take by its own chords; in the end all segments are drawn by the
/// same number, which are measured at other places.
constexpr double kForSegments = 0.9;
/// Directions are taken between points that are this many tolerances apart.
constexpr double kApart = 4;

/// A segment of the fit between two points of the path.
struct Piece {
  int first, last;
  BezierFit curve;
  int chords = 1;
};

/// Points of pieces at which distances are measured.
struct Probes {
  std::vector<Vector3> points;
  std::vector<std::pair<int, int>> rows;  ///< of the path, to which each point belongs

  void add(const Vector3& point, const Piece& piece) {
    points.push_back(point);
    rows.emplace_back(piece.first, piece.last);
  }
};

/// Fits a path whose lengths, as those of the options, are `scale` times those of the surface.
class Fitter {
 public:
  Fitter(const SurfaceSearch& search, const Points& path, const Points& normals,
         const FitOptions& options, double scale)
      : search_(search),
        scale_(scale),
        path_(path),
        options_(options),
        tangents_(path, normals, kApart * options.tolerance, options.closed) {}

  PathFit fit() {
    std::vector<int> corners = knots();
    std::vector<Piece> open;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      divide(corners[i - 1], corners[i], open);
    }
    while (!open.empty()) {
      open = checked(std::move(open));
      InterruptionPoint::pass();
    }
    std::sort(done_.begin(), done_.end(),
              [](const Piece& a, const Piece& b) { return a.first < b.first; });
    return result();
  }

 private:
  bool isBezier() const { return options_.kind == FitKind::bezier; }
  int last() const { return static_cast<int>(path_.rows()) - 1; }

  /// The ends, the corners, and for a closed path without corners the point opposite of its start.
  std::vector<int> knots() {
    is_corner_.assign(path_.rows(), false);
    std::vector<int> found{0};
    for (int row = 1; row < last(); ++row) {
      if (isBezier() && isSharpest(row)) {
        is_corner_[row] = true;
        found.push_back(row);
      }
    }
    if (isBezier() && options_.closed && isSharpest(0)) {
      is_corner_.front() = is_corner_.back() = true;
    }
    tangents_.setCorners(is_corner_);
    if (options_.closed && found.size() == 1 && last() > 1) {
      found.push_back(last() / 2);
    }
    found.push_back(last());
    return found;
  }

  /// Whether the path turns sharply at the point, and not more so at its neighbours.
  bool isSharpest(int row) const {
    const double turn = tangents_.turn(row);
    return turn > options_.corner_angle && turn >= tangents_.turn(std::max(row - 1, 0)) &&
           turn > tangents_.turn(std::min(row + 1, last()));
  }

  Vector3 leaving(int row) const {
    return isEnd(row) ? tangents_.leaving(row) : tangents_.passing(row);
  }
  Vector3 arriving(int row) const {
    return isEnd(row) ? tangents_.arriving(row) : tangents_.passing(row);
  }
  bool isEnd(int row) const {
    return is_corner_[row] || (!options_.closed && (row == 0 || row == last()));
  }

  /// Fits the path between two rows, by as many pieces as its points need.
  void divide(int first, int end, std::vector<Piece>& pieces) const {
    std::vector<std::pair<int, int>> ranges{{first, end}};
    while (!ranges.empty()) {
      const auto [a, b] = ranges.back();
      ranges.pop_back();
      Piece piece{a, b,
                  isBezier() ? fitBezier(path_, a, b, leaving(a), -arriving(b))
                             : straightBezier(path_, a, b)};
      if (!isBezier()) {
        measureStraight(piece);
      }
      int split = -1;
      if (b > a + 1) {
        if (piece.curve.error > kForPoints * options_.tolerance) {
          split = std::clamp(piece.curve.farthest, a + 1, b - 1);
        } else {
          split = worstValue(piece);
        }
      }
      if (split >= 0) {
        ranges.push_back({split, b});
        ranges.push_back({a, split});
      } else {
        pieces.push_back(std::move(piece));
      }
    }
  }

  /// The distances of the path's points from the straight segment itself.
  void measureStraight(Piece& piece) const {
    const Vector3 from = path_.row(piece.first), to = path_.row(piece.last);
    piece.curve.error = 0;
    for (int row = piece.first + 1; row < piece.last; ++row) {
      const double distance = distanceFromSegment(from, to, path_.row(row));
      if (distance > piece.curve.error) {
        piece.curve.error = distance;
        piece.curve.farthest = row;
      }
    }
  }

  /// The row whose value is farthest from the linear interpolation, or -1 if all are near enough.
  int worstValue(const Piece& piece) const {
    if (options_.values.size() == 0) {
      return -1;
    }
    const double from = options_.values[piece.first], to = options_.values[piece.last];
    double worst = options_.value_tolerance;
    int found = -1;
    for (int row = piece.first + 1; row < piece.last; ++row) {
      const double t = piece.curve.parameters[row - piece.first];
      const double off = std::abs((1 - t) * from + t * to - options_.values[row]);
      if (off > worst) {
        worst = off;
        found = row;
      }
    }
    return found;
  }

  /// The points of a piece as it is drawn, and the middles between them, without its ends.
  void addProbes(const Piece& piece, int chords, Probes& probes) const {
    Vector3 before = piece.curve.points[0];
    for (int i = 1; i <= chords; ++i) {
      const Vector3 next = bezierPoint(piece.curve.points, double(i) / chords);
      probes.add((before + next) / 2, piece);
      if (i < chords) {
        probes.add(next, piece);
      }
      before = next;
    }
  }

  /// How far points are from where the curve is to run. Another part of the surface may be closer
  /// than the one from which the offset is counted: then the distance from the path itself counts,
  /// which is not smaller than that.
  Eigen::VectorXd distances(const Probes& probes) const {
    std::vector<Vector3> places = probes.points;
    for (Vector3& place : places) {
      place /= scale_;
    }
    const Eigen::VectorXd distance = scale_ * feet(search_, places, options_.threads).distance;
    const double offset = std::abs(options_.offset);
    Eigen::VectorXd off = (distance.array() - offset).abs();
    for (Eigen::Index i = 0; i < off.size(); ++i) {
      if (distance[i] < offset && off[i] > kForSegments * options_.tolerance) {
        const auto probe = static_cast<std::size_t>(i);
        off[i] = std::min(off[i], fromPath(probes.points[probe], probes.rows[probe]));
      }
    }
    return off;
  }

  /// The distance of a point from a range of the path.
  double fromPath(const Vector3& point, const std::pair<int, int>& rows) const {
    double least = std::numeric_limits<double>::infinity();
    for (int row = rows.first; row < rows.second; ++row) {
      least = std::min(least, distanceFromSegment(path_.row(row), path_.row(row + 1), point));
    }
    return least;
  }

  /// How many chords are measured: a straight segment at more places than its middle.
  int measuredChords(const Piece& piece) const { return std::max(piece.chords, 4); }

  /// Measures the pieces; returns those by which the ones too far from the surface are replaced.
  std::vector<Piece> checked(std::vector<Piece> open) {
    Probes probes;
    std::vector<std::size_t> begin;
    for (Piece& piece : open) {
      piece.chords =
          isBezier() ? chordsWithin(piece.curve.points, kForChords * options_.tolerance) : 1;
      begin.push_back(probes.points.size());
      if (piece.chords <= kMostChords) {
        addProbes(piece, measuredChords(piece), probes);
      }
    }
    begin.push_back(probes.points.size());
    const Eigen::VectorXd off = distances(probes);
    std::vector<Piece> again;
    for (std::size_t i = 0; i < open.size(); ++i) {
      Piece& piece = open[i];
      const auto from = static_cast<Eigen::Index>(begin[i]);
      const auto count = static_cast<Eigen::Index>(begin[i + 1]) - from;
      const bool is_near =
          count > 0 && off.segment(from, count).maxCoeff() <= kForSegments * options_.tolerance;
      if (is_near) {
        done_.push_back(std::move(piece));
      } else if (piece.last > piece.first + 1) {
        const int middle = (piece.first + piece.last) / 2;
        divide(piece.first, middle, again);
        divide(middle, piece.last, again);
      } else {
        piece.curve = straightBezier(path_, piece.first, piece.last);
        piece.chords = 1;
        done_.push_back(std::move(piece));
      }
    }
    return again;
  }

  PathFit result() const {
    PathFit fit;
    const auto pieces = static_cast<Eigen::Index>(done_.size());
    for (const Piece& piece : done_) {
      fit.rows.push_back(piece.first);
      fit.error = std::max(fit.error, piece.curve.error);
      fit.resolution = std::max(fit.resolution, piece.chords);
    }
    fit.rows.push_back(last());
    Probes probes;
    for (const Piece& piece : done_) {
      addProbes(piece, isBezier() ? fit.resolution : measuredChords(piece), probes);
    }
    fit.deviation = distances(probes).maxCoeff();
    if (isBezier()) {
      fit.before.resize(pieces + 1, 3);
      fit.after.resize(pieces + 1, 3);
      for (Eigen::Index i = 0; i < pieces; ++i) {
        fit.after.row(i) = done_[i].curve.points[1].transpose();
        fit.before.row(i + 1) = done_[i].curve.points[2].transpose();
      }
      setOuterHandles(fit, pieces);
    }
    return fit;
  }

  /// The handles beyond the ends of an open curve mirror those within it.
  void setOuterHandles(PathFit& fit, Eigen::Index end) const {
    if (options_.closed) {
      fit.before.row(0) = fit.before.row(end);
      fit.after.row(end) = fit.after.row(0);
    } else {
      fit.before.row(0) = 2 * path_.row(0) - fit.after.row(0);
      fit.after.row(end) = 2 * path_.row(last()) - fit.before.row(end);
    }
  }

  const SurfaceSearch& search_;
  double scale_;
  const Points& path_;
  const FitOptions& options_;
  PathTangents tangents_;
  std::vector<char> is_corner_;
  std::vector<Piece> done_;
};

void checkAtLeastZero(const char* name, double value) {
  if (!(value >= 0)) {
    throw std::invalid_argument(std::string(name) + " is " + numberText(value) +
                                "; it must be 0 or more");
  }
}

}  // namespace

PathFit fitPath(const LimitSurface& surface, const SurfaceSearch& search,
                const std::vector<Location>& path, const FitOptions& options) {
  checkThreads(options.threads);
  checkTolerance(options.tolerance);
  if (!std::isfinite(options.offset)) {
    throw std::invalid_argument("offset is " + numberText(options.offset) + "; it must be finite");
  }
  checkAtLeastZero("corner_angle", options.corner_angle);
  checkAtLeastZero("value_tolerance", options.value_tolerance);
  if (path.size() < 2) {
    throw std::invalid_argument("a path has " + std::to_string(path.size()) +
                                " points; at least 2 are needed");
  }
  const auto rows = static_cast<Eigen::Index>(path.size());
  if (options.values.size() != 0) {
    checkRows("values", options.values.size(), rows, "face");
  }
  for (Eigen::Index row = 0; row < options.values.size(); ++row) {
    if (!std::isfinite(options.values[row])) {
      throw std::invalid_argument("values[" + std::to_string(row) + "] is " +
                                  numberText(options.values[row]) + "; it must be finite");
    }
  }
  const Evaluation on = surface.evaluate(path, Derivatives::first, true, options.threads);
  Points points = on.position;
  if (options.offset != 0) {
    // Frames have a normal where the surface has none.
    const auto normals = surface.frames(path, options.threads);
    for (int axis = 0; axis < 3; ++axis) {
      points.col(axis) += options.offset * normals.col(3 * axis + 2);
    }
  }
  const double scale =
      scaleToOwnUnit((points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff());
  points *= scale;
  FitOptions scaled = options;
  scaled.tolerance *= scale;
  scaled.offset *= scale;
  PathFit fit = Fitter(search, points, on.normal, scaled, scale).fit();
  fit.before /= scale;
  fit.after /= scale;
  fit.deviation /= scale;
  fit.error /= scale;
  return fit;
}

}  // namespace limitsurf
