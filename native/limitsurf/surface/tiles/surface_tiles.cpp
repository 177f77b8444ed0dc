// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/surface_tiles.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limitsurf/interruption_point.h"
#include "limitsurf/parallel.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/tiles/point_rows.h"
#include "limitsurf/surface/tiles/tile_control_points.h"
#include "limitsurf/surface/tiles/tile_place.h"

namespace limitsurf {
namespace {

/// Locations that make one task: finding their tile costs far less than an evaluation.
constexpr std::size_t kPlacesPerTask = 4096;
/// Tiles that make one task: a tile costs up to 17 rows of weights, each on all points around a
/// vertex. And how many are made before their points get numbers, where these rows are not long:
/// the rows of all tiles take several times the memory of the result.
constexpr std::size_t kTilesPerTask = 4, kTilesPerBlock = 4096;
/// So many weights may wait for numbers, if there are more than one task's (12 bytes each).
constexpr std::size_t kWeightsPerBlock = std::size_t{1} << 25;

std::size_t tilesPerBlock(const TileTable& table) {
  std::size_t longest = 16;
  for (const RingPoints& ring : table.rings) {
    longest = std::max(longest, ring.points.size());
  }
  return std::clamp(kWeightsPerBlock / (17 * longest), kTilesPerTask, kTilesPerBlock);
}

/// Gives refined points their numbers, equal rows the same.
class PointNumbers {
 public:
  PointNumbers(const RefinedPoints& points, SurfaceTiles& out) : points_(points), rows_(out) {
    out.cage_points = points.cagePoints();
  }

  int numberOf(const ControlPoint& point) {
    if (point.point < 0) {
      return numberOf(point.row);
    }
    if (point.point < points_.cagePoints()) {
      return point.point;
    }
    const auto [known, is_new] = of_table_.try_emplace(point.point, 0);
    if (is_new) {
      weights_.clear();
      weights_.add(point.point, 1);
      known->second = numberOf(onCage(points_, weights_));
    }
    return known->second;
  }

  int withoutWeights() { return numberOf(CageRow{}); }

 private:
  int numberOf(const CageRow& row) { return points_.cagePoints() + rows_.numberOf(row); }

  const RefinedPoints& points_;
  PointRows rows_;
  std::unordered_map<int, int> of_table_;
  PointWeights<double> weights_{0};
};

/// The different parts in the order of their keys.
std::vector<TilePart> differentParts(const std::vector<Place>& places) {
  std::vector<std::pair<std::uint64_t, std::size_t>> by_key(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    by_key[i] = {places[i].part.key(), i};
  }
  std::sort(by_key.begin(), by_key.end());
  std::vector<TilePart> parts;
  InterruptionStride stride;
  for (std::size_t i = 0; i < by_key.size(); ++i) {
    stride.step();
    if (i == 0 || by_key[i].first != by_key[i - 1].first) {
      parts.push_back(places[by_key[i].second].part);
    }
  }
  return parts;
}

[[noreturn]] void refuseWeights() {
  throw std::invalid_argument("the points of the tiles would have more than " +
                              std::to_string(SurfaceTiles::kMostWeights) +
                              " weights: each point near a vertex of many faces, or near the "
                              "middle of a face of many sides, "
                              "depends on all vertices around it. Take a smaller max_depth");
}

/// Refuses tiles that will surely have too many weights, before they are made.
void checkWeights(const std::vector<TilePart>& parts, const TileTable& table) {
  // Neighbouring tiles share most of their points: of the 17 rows of a tile 6.2 to 7.1 are its own
  // where all tiles around a vertex are taken, and more where some of them are.
  constexpr std::size_t kLeastRowsOfTile = 6;
  std::size_t weights = 0;
  InterruptionStride stride;
  for (const TilePart& part : parts) {
    stride.step();
    if (part.tile.kind == TileRef::kRing) {
      weights +=
          kLeastRowsOfTile * table.rings[table.ring_tiles[part.tile.index].ring].points.size();
    }
  }
  if (weights > SurfaceTiles::kMostWeights) {
    refuseWeights();
  }
}

/// The number of the part with this key, which is one of them.
int tileOf(const std::vector<TilePart>& parts, std::uint64_t key) {
  const auto found =
      std::lower_bound(parts.begin(), parts.end(), key,
                       [](const TilePart& part, std::uint64_t k) { return part.key() < k; });
  return static_cast<int>(found - parts.begin());
}

void addTiles(const ControlPoints* controls, std::size_t count, PointNumbers& numbers,
              SurfaceTiles& out) {
  for (std::size_t i = 0; i < count; ++i) {
    InterruptionPoint::pass();  // rows may be as long as a vertex has neighbors
    std::array<int, 16> points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = numbers.numberOf(controls[i].points[k]);
    }
    out.tile_points.push_back(points);
    out.tile_anchor.push_back(numbers.numberOf(controls[i].anchor));
    out.tile_base.push_back(controls[i].relative ? numbers.withoutWeights()
                                                 : out.tile_anchor.back());
    if (out.points_weights.size() > SurfaceTiles::kMostWeights) {
      refuseWeights();
    }
  }
}

std::vector<Place> foundPlaces(const LocationBatch& at, const TileTable& table, const Pose& pose,
                               int max_depth, int threads) {
  if (max_depth < 1 || max_depth > SurfaceTiles::kLargestDepth) {
    throw std::invalid_argument("max_depth is " + std::to_string(max_depth) + "; expected 1 to " +
                                std::to_string(SurfaceTiles::kLargestDepth));
  }
  std::vector<Place> places(at.size());
  parallelFor(at.size(), kPlacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    const PlaceFinder find(table, pose, max_depth);
    for (std::size_t i = begin; i < end; ++i) {
      places[i] = find(at[i]);
    }
  });
  return places;
}

void putPlaces(const std::vector<Place>& places, TilePlaces& out, int threads) {
  const auto rows = static_cast<Eigen::Index>(places.size());
  out.moved.resize(places.size());
  out.tile_uv.resize(rows, 2);
  out.scale.resize(rows, 2);
  parallelFor(places.size(), kPlacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Place& place = places[i];
      out.moved[i] = place.moved;
      out.tile_uv.row(static_cast<Eigen::Index>(i)) << place.u, place.v;
      out.scale.row(static_cast<Eigen::Index>(i)) << place.u_scale, place.v_scale;
    }
  });
}

}  // namespace

TilePlaces LimitSurface::tilePlaces(const LocationBatch& at, int max_depth, int threads) const {
  data_->check(at, threads);
  TilePlaces out;
  putPlaces(foundPlaces(at, data_->table, data_->pose, max_depth, threads), out, threads);
  return out;
}

SurfaceTiles LimitSurface::tiles(const LocationBatch& at, int max_depth, int threads,
                                 const Progress& progress) const {
  data_->check(at, threads);
  const TileTable& table = data_->table;
  const std::vector<Place> places = foundPlaces(at, table, data_->pose, max_depth, threads);
  const std::vector<TilePart> parts = differentParts(places);
  checkWeights(parts, table);
  SurfaceTiles out;
  PointNumbers numbers(table.points, out);
  const TileBuilder build(table);
  const std::size_t block = tilesPerBlock(table);
  std::vector<ControlPoints> controls(std::min(parts.size(), block));
  for (std::size_t first = 0; first < parts.size(); first += block) {
    const std::size_t count = std::min(block, parts.size() - first);
    parallelFor(count, kTilesPerTask, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        controls[i] = build(parts[first + i]);
      }
    });
    addTiles(controls.data(), count, numbers, out);
    report(progress, first + count, parts.size());
  }

  putPlaces(places, out, threads);
  out.tile.resize(at.size());
  parallelFor(at.size(), kPlacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      out.tile[i] = tileOf(parts, places[i].part.key());
    }
  });
  return out;
}

}  // namespace limitsurf
