// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/path_smoothing.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/path/surface_distance.h"
#include "limitsurf/row_check.h"

namespace limitsurf {
namespace {

void checkPath(std::size_t points) {
  if (points < 2) {
    throw std::invalid_argument("a path has " + std::to_string(points) +
                                " points; at least 2 are needed");
  }
}

void checkWeights(const Eigen::VectorXd& weights, std::size_t points) {
  checkRows("weights", weights.size(), static_cast<Eigen::Index>(points), "face");
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (!(weights[i] >= 0 && weights[i] <= 1)) {
      throw std::invalid_argument("weights[" + std::to_string(i) + "] is " +
                                  numberText(weights[i]) + "; it must be between 0 and 1");
    }
  }
}

/// The lengths of the segments of a polyline.
std::vector<double> lengths(const Points& position) {
  std::vector<double> found;
  for (Eigen::Index row = 1; row < position.rows(); ++row) {
    found.push_back((position.row(row) - position.row(row - 1)).norm());
  }
  return found;
}

}  // namespace

PathPoints smoothPath(const LimitSurface& surface, const SurfaceSearch& search,
                      const std::vector<Location>& path, const Eigen::VectorXd& weights,
                      int iterations, bool closed, int threads) {
  checkThreads(threads);
  checkPath(path.size());
  checkWeights(weights, path.size());
  if (iterations < 0) {
    throw std::invalid_argument("iterations is " + std::to_string(iterations) +
                                "; it must be 0 or more");
  }
  PathPoints smooth{path, surface.evaluate(path, Derivatives::none, false, threads).position};
  const int end = static_cast<int>(path.size()) - 1;
  std::vector<int> rows;
  for (int row = closed ? 0 : 1; row < end; ++row) {
    if (weights[row] > 0) {
      rows.push_back(row);
    }
  }
  // The spacing is that of the beginning: that of the moment would let points run together.
  const std::vector<double> length = lengths(smooth.position);
  std::vector<Vector3> wanted(rows.size());
  for (int step = 0; step < iterations && !rows.empty(); ++step) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int row = rows[i];
      const Vector3 here = smooth.position.row(row);
      const int before = row > 0 ? row - 1 : end - 1;
      const double back = length[before], ahead = length[row];
      const double part = back + ahead > 0 ? back / (back + ahead) : 0.5;
      const Vector3 middle = (1 - part) * smooth.position.row(before).transpose() +
                             part * smooth.position.row(row + 1).transpose();
      // By half the way, because neighbours that move at once would pass each other.
      wanted[i] = here + weights[row] / 2 * (middle - here);
    }
    const Hits hits = feet(search, wanted, threads);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      smooth.at[rows[i]] = hits.at[i];
      smooth.position.row(rows[i]) = hits.position.row(static_cast<Eigen::Index>(i));
    }
    if (closed) {
      smooth.at[end] = smooth.at[0];
      smooth.position.row(end) = smooth.position.row(0);
    }
    InterruptionPoint::pass();
  }
  return smooth;
}

PathPoints evenPath(const LimitSurface& surface, const SurfaceSearch& search,
                    const std::vector<Location>& path, int count, int threads) {
  checkThreads(threads);
  checkPath(path.size());
  if (count < 2 || count > kMostPathPoints) {
    throw std::invalid_argument("count is " + std::to_string(count) + "; it must be 2 to " +
                                std::to_string(kMostPathPoints));
  }
  const Points position = surface.evaluate(path, Derivatives::none, false, threads).position;
  std::vector<double> length{0};
  for (const double step : lengths(position)) {
    length.push_back(length.back() + step);
  }
  Points wanted(count - 2, 3);
  InterruptionStride stride;
  for (int i = 1; i + 1 < count; ++i) {
    stride.step();
    const double at = length.back() * i / (count - 1);
    const auto next = std::upper_bound(length.begin() + 1, length.end() - 1, at);
    const auto row = static_cast<Eigen::Index>(next - length.begin());
    const double step = length[row] - length[row - 1];
    const double t = step > 0 ? std::clamp((at - length[row - 1]) / step, 0., 1.) : 0;
    wanted.row(i - 1) = (1 - t) * position.row(row - 1) + t * position.row(row);
  }
  Hits hits = feet(search, wanted, threads);
  PathPoints even;
  even.at.reserve(static_cast<std::size_t>(count));
  even.at.push_back(path.front());
  moveInParts(hits.at, even.at);
  even.at.push_back(path.back());
  even.position.resize(count, 3);
  even.position.row(0) = position.row(0);
  for (Eigen::Index row = 1; row + 1 < count; ++row) {
    stride.step();
    even.position.row(row) = hits.position.row(row - 1);
  }
  even.position.row(count - 1) = position.row(position.rows() - 1);
  return even;
}

}  // namespace limitsurf
