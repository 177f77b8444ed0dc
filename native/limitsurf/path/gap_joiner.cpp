// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/gap_joiner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limitsurf/parallel.h"
#include "limitsurf/path/surface_distance.h"

namespace limitsurf {
namespace {

/// How often a part of a way may be halved: what is shorter is a jump of the surface itself, where
/// the coordinates are too coarse for the tolerance.
constexpr int kMostHalvings = 50;

/// A segment of the path: a part of the way, or of such a part.
struct Piece {
  WayPart part;
  Vector3 begin, end;
  int halvings = 0;
  bool is_done = false;
  double deviation = 0;
};

Location along(const WayPart& part, double t) {
  return {part.from.face, (1 - t) * part.from.u + t * part.to.u,
          (1 - t) * part.from.v + t * part.to.v};
}

constexpr std::array<double, 3> kQuarters{0.25, 0.5, 0.75};

/// Halves segments until they keep the options.
class Halving {
 public:
  Halving(const LimitSurface& surface, const SurfaceSearch& search, const LayOptions& options)
      : surface_(surface), search_(search), options_(options) {}

  /// Whether all parts could be halved until they did.
  bool run(const std::vector<WayPart>& parts) {
    std::vector<Location> ends{parts.front().from};
    for (const WayPart& part : parts) {
      ends.push_back(part.to);
    }
    const Points at = surface_.evaluate(ends, Derivatives::none, false, options_.threads).position;
    size_ = at.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      pieces_.push_back({parts[i], at.row(row), at.row(row + 1)});
    }
    while (step()) {
      InterruptionPoint::pass();
    }
    return std::all_of(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.is_done; });
  }

  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  /// Measures all pieces that are not done and halves those that are too coarse. Returns whether
  /// there are new ones.
  bool step() {
    std::vector<Location> probes;
    for (const Piece& piece : pieces_) {
      for (const double t : kQuarters) {
        probes.push_back(along(piece.part, t));
      }
    }
    const Points at =
        surface_.evaluate(probes, Derivatives::none, false, options_.threads).position;
    measure(at);
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Piece& piece = pieces_[i];
      if (piece.is_done || piece.halvings == kMostHalvings) {
        pieces.push_back(piece);
        continue;
      }
      const Location middle = along(piece.part, 0.5);
      const Vector3 position = at.row(static_cast<Eigen::Index>(3 * i + 1));
      pieces.push_back({{piece.part.from, middle}, piece.begin, position, piece.halvings + 1});
      pieces.push_back({{middle, piece.part.to}, position, piece.end, piece.halvings + 1});
    }
    const bool is_new = pieces.size() > pieces_.size();
    pieces_ = std::move(pieces);
    return is_new;
  }

  /// Marks the pieces that are near enough to the surface; `at` are their quarters.
  void measure(const Points& at) {
    const double accepted = std::max(options_.tolerance, kLeastDistance * size_);
    std::vector<Segment> segments;
    std::vector<std::size_t> measured;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Piece& piece = pieces_[i];
      bool is_near = !piece.is_done && (piece.end - piece.begin).norm() <= options_.max_step;
      for (Eigen::Index k = 0; is_near && k < 3; ++k) {
        const Vector3 quarter = at.row(static_cast<Eigen::Index>(3 * i) + k);
        is_near = distanceFromSegment(piece.begin, piece.end, quarter) <= kAccepted * accepted;
      }
      if (is_near) {
        measured.push_back(i);
        segments.push_back({piece.begin, piece.end});
      }
    }
    const std::vector<double> found = largestDistances(search_, segments, options_.threads);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      pieces_[measured[i]].is_done = found[i] <= accepted;
      pieces_[measured[i]].deviation = found[i];
    }
  }

  const LimitSurface& surface_;
  const SurfaceSearch& search_;
  const LayOptions& options_;
  double size_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace

std::optional<JoinedGap> GapJoiner::join(const Location& from, const Location& to) {
  if (!ways_) {
    ways_.emplace(surface_, options_.threads);
  }
  const Points ends = surface_.evaluate(std::vector<Location>{from, to}).position;
  const double longest = kLongestWay * (ends.row(1) - ends.row(0)).norm();
  const std::vector<WayPart> parts = ways_->find(from, to, longest);
  if (parts.empty()) {
    return std::nullopt;
  }
  Halving halving(surface_, search_, options_);
  if (!halving.run(parts)) {
    return std::nullopt;
  }
  JoinedGap joined;
  for (const Piece& piece : halving.pieces()) {
    if (!joined.deviation.empty()) {
      joined.at.push_back(piece.part.from);
      joined.position.push_back(piece.begin);
    }
    joined.deviation.push_back(piece.deviation);
  }
  return joined;
}

}  // namespace limitsurf
