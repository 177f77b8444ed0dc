// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/scatter_along.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "limitsurf/curves/along_places.h"
#include "limitsurf/curves/along_rows.h"
#include "limitsurf/mesh/messages.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The number of locations between two calls of Progress, and the number that one task takes.
constexpr std::size_t kPlacesPerReport = std::size_t{1} << 16;
constexpr std::size_t kPlacesPerTask = 256;
constexpr std::size_t kGeodesicsPerReport = std::size_t{1} << 12;
constexpr std::size_t kGeodesicsPerTask = 16;

/// The unit vector in the plane perpendicular to `normal`, or `vector` itself where there is none.
Vector3 inPlane(const Vector3& vector, const Vector3& normal) {
  const Vector3 flat = vector - normal.dot(vector) * normal;
  const double norm = flat.norm();
  return norm > 0 ? Vector3(flat / norm) : vector;
}

/// The locations of places on the curves, and their directions.
struct Feet {
  std::vector<Location> at;
  Points tangent, outward;
  std::vector<char> on_left;

  Feet(const LimitSurface& surface, const EdgeCurves& curves, const AlongPlaces& places,
       std::size_t first, std::size_t count, CurveSide side, int threads)
      : at(count),
        tangent(static_cast<Eigen::Index>(count), 3),
        outward(static_cast<Eigen::Index>(count), 3),
        on_left(count) {
    parallelFor(count, kPlacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const EdgeCurves::Point point =
            curves.at(places.curve[first + i], places.arc[first + i], side);
        at[i] = point.at;
        tangent.row(static_cast<Eigen::Index>(i)) = point.tangent;
        on_left[i] = point.side == CurveSide::left;
      }
    });
    const auto frames = surface.frames(at, threads);
    for (Eigen::Index row = 0; row < frames.rows(); ++row) {
      const Vector3 normal(frames(row, 2), frames(row, 5), frames(row, 8));
      const Vector3 along = inPlane(tangent.row(row), normal);
      tangent.row(row) = along;
      // The face on the left lies towards normal x tangent.
      outward.row(row) = (on_left[static_cast<std::size_t>(row)] ? 1 : -1) * along.cross(normal);
    }
  }
};

/// Appends locations to a result, whose vectors grow as needed.
class Appender {
 public:
  explicit Appender(std::size_t most) {
    tangent_.resize(static_cast<Eigen::Index>(most), 3);
    outward_.resize(static_cast<Eigen::Index>(most), 3);
    result_.at.reserve(most);
    result_.curve.reserve(most);
    result_.arc.reserve(most);
    result_.row.reserve(most);
  }

  void add(const Location& at, int curve, double arc, int row, const Vector3& tangent,
           const Vector3& outward) {
    const auto i = static_cast<Eigen::Index>(result_.at.size());
    result_.at.push_back(at);
    result_.curve.push_back(curve);
    result_.arc.push_back(arc);
    result_.row.push_back(row);
    tangent_.row(i) = tangent;
    outward_.row(i) = outward;
  }

  AlongCurves finish(std::vector<std::int64_t> ended) {
    const auto count = static_cast<Eigen::Index>(result_.at.size());
    result_.tangent = tangent_.topRows(count);
    result_.outward = outward_.topRows(count);
    result_.ended = std::move(ended);
    return std::move(result_);
  }

 private:
  AlongCurves result_;
  Points tangent_, outward_;
};

/// Adds places on the curves themselves.
void addOnCurves(const Feet& feet, const AlongPlaces& places, std::size_t first, Appender& out) {
  for (std::size_t i = 0; i < feet.at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    out.add(feet.at[i], places.curve[first + i], places.arc[first + i], 0, feet.tangent.row(row),
            feet.outward.row(row));
  }
}

/// Adds the places of a row, and returns how many it lacks.
std::int64_t addRow(const AlongRows& rows, const Feet& feet, const AlongPlaces& places,
                    std::size_t first, int row, double distance, int threads, Appender& out) {
  std::vector<GeodesicTracer::Stop> stops(feet.at.size());
  std::vector<char> reached(feet.at.size());
  parallelFor(feet.at.size(), kGeodesicsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3 inward = -feet.outward.row(static_cast<Eigen::Index>(i));
      reached[i] = rows.place(feet.at[i], inward, distance, stops[i]);
    }
  });
  std::int64_t lacking = 0;
  for (std::size_t i = 0; i < feet.at.size(); ++i) {
    if (!reached[i]) {
      ++lacking;
      continue;
    }
    const Vector3& inward = stops[i].direction;
    const Vector3 tangent = (feet.on_left[i] ? 1 : -1) * inward.cross(stops[i].normal);
    out.add(stops[i].at, places.curve[first + i], places.arc[first + i], row, tangent, -inward);
  }
  return lacking;
}

}  // namespace

AlongCurves scatterAlong(const LimitSurface& surface, const EdgeCurves& curves,
                         const AlongOptions& options, int threads, const Progress& progress) {
  checkThreads(threads);
  checkAlongOptions(options);
  const std::vector<std::int64_t> counts = alongCounts(curves, options);
  const auto count =
      static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  const std::size_t all = count * static_cast<std::size_t>(options.rows);
  std::unique_ptr<const AlongRows> rows;
  if (options.rows > 1 && count > 0) {
    rows = std::make_unique<const AlongRows>(surface, curves, options.row_distance,
                                             options.row_distance * (options.rows - 1), threads);
  }
  Appender result(all);
  std::vector<std::int64_t> ended(static_cast<std::size_t>(options.rows), 0);
  for (int row = 0; row < options.rows; ++row) {
    const AlongPlaces places = alongPlaces(curves, counts, options, row);
    const std::size_t part = row == 0 ? kPlacesPerReport : kGeodesicsPerReport;
    for (std::size_t first = 0; first < count; first += part) {
      report(progress, count * static_cast<std::size_t>(row) + first, all);
      const std::size_t size = std::min(part, count - first);
      const Feet feet(surface, curves, places, first, size, options.side, threads);
      if (row == 0) {
        addOnCurves(feet, places, first, result);
      } else {
        ended[static_cast<std::size_t>(row)] +=
            addRow(*rows, feet, places, first, row, row * options.row_distance, threads, result);
      }
    }
  }
  report(progress, 1, 1);
  return result.finish(std::move(ended));
}

AlongCurves pointsAlong(const LimitSurface& surface, const EdgeCurves& curves,
                        const std::vector<std::int64_t>& curve, const std::vector<double>& arc,
                        CurveSide side, int threads) {
  checkThreads(threads);
  AlongPlaces places;
  places.arc = arc;
  for (std::size_t row = 0; row < curve.size(); ++row) {
    if (curve[row] < 0 || curve[row] >= curves.count()) {
      throw std::invalid_argument(
          text("row ", row, ": there is no curve ", curve[row], "; there are ", curves.count()));
    }
    places.curve.push_back(static_cast<int>(curve[row]));
    const double length = curves.length(places.curve.back());
    if (!(arc[row] >= 0 && arc[row] <= length)) {
      throw std::invalid_argument(text("row ", row, ": arc length ", arc[row],
                                       " is not on the curve, which has the length ", length));
    }
  }
  Appender result(arc.size());
  for (std::size_t first = 0; first < arc.size(); first += kPlacesPerReport) {
    const std::size_t size = std::min(kPlacesPerReport, arc.size() - first);
    addOnCurves(Feet(surface, curves, places, first, size, side, threads), places, first, result);
  }
  return result.finish({0});
}

}  // namespace limitsurf
