// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/scatter_along.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "limitsurf/curves/along_places.h"
#include "limitsurf/mesh/messages.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The number of locations between two calls of Progress, and the number that one task takes.
constexpr std::size_t kPlacesPerReport = std::size_t{1} << 16;
constexpr std::size_t kPlacesPerTask = 256;

void report(const Progress& progress, std::size_t done, std::size_t all) {
  if (progress) {
    progress(all ? static_cast<double>(done) / static_cast<double>(all) : 1);
  }
}

/// The unit vector in the plane perpendicular to `normal`, or `vector` itself where there is none.
Vector3 inPlane(const Vector3& vector, const Vector3& normal) {
  const Vector3 flat = vector - normal.dot(vector) * normal;
  const double norm = flat.norm();
  return norm > 0 ? Vector3(flat / norm) : vector;
}

/// Evaluates places: `result` has them as `curve` and `arc`.
void evaluatePlaces(const LimitSurface& surface, const EdgeCurves& curves, CurveSide side,
                    int threads, const Progress& progress, AlongCurves& result) {
  const std::size_t count = result.arc.size();
  result.at.resize(count);
  result.tangent.resize(static_cast<Eigen::Index>(count), 3);
  result.outward.resize(static_cast<Eigen::Index>(count), 3);
  std::vector<char> on_left(count);
  for (std::size_t first = 0; first < count; first += kPlacesPerReport) {
    report(progress, first, count);
    const std::size_t size = std::min(kPlacesPerReport, count - first);
    parallelFor(size, kPlacesPerTask, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        const EdgeCurves::Point point = curves.at(result.curve[i], result.arc[i], side);
        result.at[i] = point.at;
        result.tangent.row(static_cast<Eigen::Index>(i)) = point.tangent;
        on_left[i] = point.side == CurveSide::left;
      }
    });
    const Span<Location> part = Span<Location>(result.at).subspan(first, size);
    const auto frames = surface.frames(part, threads);
    for (std::size_t i = 0; i < size; ++i) {
      const auto row = static_cast<Eigen::Index>(first + i);
      const auto frame = frames.row(static_cast<Eigen::Index>(i));
      const Vector3 normal(frame[2], frame[5], frame[8]);
      const Vector3 tangent = inPlane(result.tangent.row(row), normal);
      result.tangent.row(row) = tangent;
      // The face on the left lies towards normal x tangent.
      result.outward.row(row) = (on_left[first + i] ? 1 : -1) * tangent.cross(normal);
    }
  }
  report(progress, 1, 1);
}

}  // namespace

AlongCurves scatterAlong(const LimitSurface& surface, const EdgeCurves& curves,
                         const AlongOptions& options, int threads, const Progress& progress) {
  checkThreads(threads);
  checkAlongOptions(options);
  AlongPlaces places = alongPlaces(curves, alongCounts(curves, options), options, 0);
  AlongCurves result;
  result.curve = std::move(places.curve);
  result.arc = std::move(places.arc);
  evaluatePlaces(surface, curves, options.side, threads, progress, result);
  return result;
}

AlongCurves pointsAlong(const LimitSurface& surface, const EdgeCurves& curves,
                        const std::vector<std::int64_t>& curve, const std::vector<double>& arc,
                        CurveSide side, int threads) {
  checkThreads(threads);
  AlongCurves result;
  result.arc = arc;
  for (std::size_t row = 0; row < curve.size(); ++row) {
    if (curve[row] < 0 || curve[row] >= curves.count()) {
      throw std::invalid_argument(
          text("row ", row, ": there is no curve ", curve[row], "; there are ", curves.count()));
    }
    result.curve.push_back(static_cast<int>(curve[row]));
    const double length = curves.length(result.curve.back());
    if (!(arc[row] >= 0 && arc[row] <= length)) {
      throw std::invalid_argument(text("row ", row, ": arc length ", arc[row],
                                       " is not on the curve, which has the length ", length));
    }
  }
  evaluatePlaces(surface, curves, side, threads, {}, result);
  return result;
}

}  // namespace limitsurf
