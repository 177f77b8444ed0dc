// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/laid_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/path/gap_joiner.h"
#include "limitsurf/path/surface_distance.h"

namespace limitsurf {
namespace {

/// Closest points jump where places of the curve that are nearer than this share of the tolerance
/// have feet that are not.
constexpr double kJump = 1. / 8;
/// The foot of a gap's middle narrows the gap if the squares of what is left sum up to at most this
/// share of the gap's; then the sum of all squares shrinks, however often gaps are halved.
constexpr double kNarrower = 0.999;
/// The number of points of all paths, each of which takes some hundred bytes and microseconds.
constexpr double kMostPoints = 1e7;
/// The number of points that may join a gap.
constexpr int kMostBridges = 512;
/// Relative to the size of coordinates: points that are nearer than this are the same.
constexpr double kSame = 1e-14;

constexpr double kQuarters[3] = {0.25, 0.5, 0.75};

struct Node {
  Location at;
  Vector3 position;
  double place;
  int next = -1;           ///< the next node of the path, -1 at its end
  bool is_joined = false;  ///< whether a path leads to the next node
};

/// Two consecutive nodes between which the path is not finished.
struct Span {
  int from, to;
  std::size_t curve;
  int gap = -1;  ///< the number of the gap to which it belongs, or -1
};

/// A place where closest points jump from one node to another.
struct Gap {
  int from, to;
  int bridges = 0;       ///< the points that join it so far
  bool is_open = false;  ///< whether closest points cannot join it
};

class Layer {
 public:
  Layer(const LimitSurface& surface, const SurfaceSearch& search, const SpaceCurves& curves,
        const LayOptions& options)
      : search_(search), curves_(curves), options_(options), joiner_(surface, search, options) {
    size_ = curves.points.rows() > 0 ? curves.points.cwiseAbs().maxCoeff() : 0;
  }

  LaidPaths lay() {
    begin();
    while (!open_.empty()) {
      checkSize();
      refine();
      measure();
      InterruptionPoint::pass();
    }
    deviation_.resize(nodes_.size(), 0);
    for (const Gap& gap : gaps_) {
      if (gap.is_open) {
        join(gap.from, gap.to);
      }
    }
    for (std::size_t curve = 0; curve < curves_.size(); ++curve) {
      leaveOutDetours(curve);
    }
    return collected();
  }

 private:
  /// Throws if the paths will have too many points: the open spans need some for each step.
  void checkSize() const {
    auto points = static_cast<double>(nodes_.size());
    for (const Span& span : open_) {
      points += (nodes_[span.to].position - nodes_[span.from].position).norm() / options_.max_step;
    }
    if (!(points <= kMostPoints)) {
      throw std::invalid_argument("max_step is " + numberText(options_.max_step) +
                                  " and tolerance " + numberText(options_.tolerance) +
                                  "; the paths would have more than ten million points");
    }
  }

  /// Makes the nodes at control points and a span for each segment.
  void begin() {
    const Hits hits = feet(search_, curves_.points, options_.threads);
    for (std::size_t i = 0; i < hits.at.size(); ++i) {
      nodes_.push_back({hits.at[i], hits.position.row(static_cast<Eigen::Index>(i)), 0});
      size_ = std::max(size_, nodes_.back().position.cwiseAbs().maxCoeff());
    }
    for (std::size_t curve = 0; curve < curves_.size(); ++curve) {
      const auto first = static_cast<int>(curves_.offsets[curve]);
      const auto segments = static_cast<int>(curves_.segments(curve));
      for (int i = 0; i < static_cast<int>(curves_.offsets[curve + 1]) - first; ++i) {
        nodes_[first + i].place = i;
      }
      int from = first;
      for (int i = 0; i < segments; ++i) {
        int to = static_cast<int>(curves_.end(curve, i));
        if (to == first) {  // the end of a closed curve repeats its first point
          nodes_.push_back({nodes_[first].at, nodes_[first].position, double(segments)});
          to = static_cast<int>(nodes_.size()) - 1;
        }
        nodes_[from].next = to;
        open_.push_back({from, to, curve});
        from = to;
      }
    }
  }

  /// Halves every open span that needs it, and offers the others for measuring.
  void refine() {
    std::vector<Vector3> probes;
    probes.reserve(6 * open_.size());
    for (const Span& span : open_) {
      const Node &a = nodes_[span.from], &b = nodes_[span.to];
      for (const double t : kQuarters) {
        probes.push_back(between(a, b, t));
      }
      for (const double t : kQuarters) {
        probes.push_back(span.gap >= 0 ? between(a, b, t)
                                       : curves_.at(span.curve, placeIn(span, t)));
      }
    }
    const Hits hits = feet(search_, probes, options_.threads);
    std::vector<Span> open;
    measured_.clear();
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(6 * i);
      const Span& span = open_[i];
      if (isFine(span, hits, row)) {
        measured_.push_back(span);
      } else {
        halve(span, hits.at[6 * i + 4], hits.position.row(row + 4), open);
      }
    }
    open_ = std::move(open);
  }

  bool isFine(const Span& span, const Hits& hits, Eigen::Index row) const {
    const Node &a = nodes_[span.from], &b = nodes_[span.to];
    const double length = (b.position - a.position).norm();
    if (length <= kSame * size_) {
      return true;
    }
    const double accepted = std::max(kAccepted * options_.tolerance, kLeastDistance * size_);
    if (length > options_.max_step || hits.distance.segment(row, 3).maxCoeff() > accepted) {
      return false;
    }
    for (Eigen::Index i = 3; i < 6; ++i) {
      if (distanceFromSegment(a.position, b.position, hits.position.row(row + i)) > accepted) {
        return false;
      }
    }
    return true;
  }

  /// Puts the foot of the span's middle between its ends, unless that does not narrow a gap.
  void halve(const Span& span, const Location& at, const Vector3& position,
             std::vector<Span>& open) {
    Span begun = span;
    const Node a = nodes_[span.from], b = nodes_[span.to];
    if (begun.gap < 0 && isJump(span)) {
      begun.gap = static_cast<int>(gaps_.size());
      gaps_.push_back({span.from, span.to});
      open.push_back(begun);  // it is looked at again, from its own middle
      return;
    }
    if (begun.gap >= 0) {
      const double rest =
          (position - a.position).squaredNorm() + (b.position - position).squaredNorm();
      if (!(rest <= kNarrower * (b.position - a.position).squaredNorm()) ||
          ++gaps_[begun.gap].bridges > kMostBridges) {
        gaps_[begun.gap].is_open = true;
        return;
      }
    }
    const int middle = static_cast<int>(nodes_.size());
    const double place = begun.gap >= 0 ? a.place : placeIn(span, 0.5);
    nodes_.push_back({at, position, place, span.to});
    nodes_[span.from].next = middle;
    Span first = begun, second = begun;
    first.to = middle;
    second.from = middle;
    open.push_back(first);
    open.push_back(second);
  }

  /// Whether closest points jump within a span of a curve.
  bool isJump(const Span& span) const {
    const double from = nodes_[span.from].place, to = nodes_[span.to].place;
    const Vector3 begin = curves_.at(span.curve, from), end = curves_.at(span.curve, to);
    const Vector3 middle = curves_.at(span.curve, (from + to) / 2);
    return (middle - begin).norm() + (end - middle).norm() <=
           std::max(kJump * options_.tolerance, kSame * size_);
  }

  /// Joins the spans that are as near to the surface as they seem, and opens the others again.
  void measure() {
    std::vector<Segment> segments;
    segments.reserve(measured_.size());
    for (const Span& span : measured_) {
      segments.push_back({nodes_[span.from].position, nodes_[span.to].position});
    }
    const std::vector<double> found = largestDistances(search_, segments, options_.threads);
    std::vector<Vector3> middles;
    std::vector<std::size_t> again;
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      const Span& span = measured_[i];
      if (found[i] <= std::max(options_.tolerance, kLeastDistance * size_)) {
        nodes_[span.from].is_joined = true;
        if (deviation_.size() < nodes_.size()) {
          deviation_.resize(nodes_.size(), 0);
        }
        deviation_[span.from] = found[i];
      } else {
        again.push_back(i);
        middles.push_back(span.gap >= 0 ? between(nodes_[span.from], nodes_[span.to], 0.5)
                                        : curves_.at(span.curve, placeIn(span, 0.5)));
      }
    }
    const Hits hits = feet(search_, middles, options_.threads);
    for (std::size_t i = 0; i < again.size(); ++i) {
      halve(measured_[again[i]], hits.at[i], hits.position.row(static_cast<Eigen::Index>(i)),
            open_);
    }
  }

  /// Where a curve passes by another part of the surface, goes past it: there and back are gaps
  /// that nothing joins, but a short way leads from before the first to beyond the second. Control
  /// points are not left out.
  void leaveOutDetours(std::size_t curve) {
    for (int node = static_cast<int>(curves_.offsets[curve]); node >= 0; node = nodes_[node].next) {
      if (nodes_[node].next < 0 || nodes_[node].is_joined) {
        continue;
      }
      for (int last = nodes_[node].next; nodes_[last].next >= 0 && !isControlPoint(last);
           last = nodes_[last].next) {
        if (!nodes_[last].is_joined && join(node, nodes_[last].next)) {
          break;
        }
      }
    }
  }

  bool isControlPoint(int node) const { return node < curves_.points.rows(); }

  /// Replaces what lies between two nodes of a path by a short way, if there is one.
  bool join(int from, int to) {
    const std::optional<JoinedGap> joined = joiner_.join(nodes_[from].at, nodes_[to].at);
    if (!joined) {
      return false;
    }
    int node = from;
    for (std::size_t i = 0; i < joined->deviation.size(); ++i) {
      const bool is_last = i == joined->at.size();
      if (!is_last) {
        nodes_.push_back({joined->at[i], joined->position[i], nodes_[from].place});
        deviation_.push_back(0);
      }
      const int next = is_last ? to : static_cast<int>(nodes_.size()) - 1;
      nodes_[node].next = next;
      nodes_[node].is_joined = true;
      deviation_[node] = joined->deviation[i];
      node = next;
    }
    return true;
  }

  /// The paths in the order of their curves.
  LaidPaths collected() const {
    LaidPaths paths;
    std::vector<int> rows;
    paths.offsets.push_back(0);
    for (std::size_t curve = 0; curve < curves_.size(); ++curve) {
      bool is_whole = true;
      double deviation = 0;
      for (int node = static_cast<int>(curves_.offsets[curve]); node >= 0;
           node = nodes_[node].next) {
        const bool is_begun = static_cast<std::int64_t>(rows.size()) > paths.offsets.back();
        if (!is_begun || !isRepeated(nodes_[rows.back()], nodes_[node])) {
          rows.push_back(node);
        }
        deviation = std::max(deviation, deviation_[node]);
        const bool is_last = nodes_[node].next < 0;
        if (is_last || !nodes_[node].is_joined) {
          is_whole = is_whole && is_last;
          paths.offsets.push_back(static_cast<std::int64_t>(rows.size()));
          paths.curve.push_back(static_cast<int>(curve));
          paths.closed.push_back(is_whole && curves_.closed[curve] && curves_.segments(curve) > 1);
          paths.deviation.push_back(deviation);
          deviation = 0;
        }
      }
    }
    paths.position.resize(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Node& node = nodes_[rows[i]];
      paths.at.push_back(node.at);
      paths.place.push_back(node.place);
      paths.position.row(static_cast<Eigen::Index>(i)) = node.position.transpose();
    }
    return paths;
  }

  /// Whether a node that is no control point lies where the node before it does.
  bool isRepeated(const Node& before, const Node& node) const {
    return node.place != std::floor(node.place) &&
           (node.position - before.position).norm() <= kSame * size_;
  }

  double placeIn(const Span& span, double t) const {
    return (1 - t) * nodes_[span.from].place + t * nodes_[span.to].place;
  }

  static Vector3 between(const Node& a, const Node& b, double t) {
    return (1 - t) * a.position + t * b.position;
  }

  const SurfaceSearch& search_;
  const SpaceCurves& curves_;
  const LayOptions& options_;
  double size_ = 0;
  std::vector<Node> nodes_;
  std::vector<double> deviation_;  ///< for each node that of the segment to the next
  std::vector<Span> open_, measured_;
  std::vector<Gap> gaps_;
  GapJoiner joiner_;
};

}  // namespace

LaidPaths layCurves(const LimitSurface& surface, const SurfaceSearch& search,
                    const SpaceCurves& curves, const LayOptions& options) {
  checkThreads(options.threads);
  checkTolerance(options.tolerance);
  if (!(options.max_step > 0)) {
    throw std::invalid_argument("max_step is " + numberText(options.max_step) +
                                "; it must be more than 0");
  }
  curves.check();
  return Layer(surface, search, curves, options).lay();
}

}  // namespace limitsurf
