// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/area_sampler_data.h"
#include "limitsurf/sample/crowding.h"
#include "limitsurf/sample/dart_throwing.h"

namespace limitsurf {
namespace {

/// How many discs find room on an area of radius squared: where no more fits, discs of half the
/// radius cover 0.547 of a plane (Feder 1980).
constexpr double kPacking = 0.547 * 4 / 3.141592653589793;
constexpr double kMostPoints = 2147483647;
/// With a count: so many times as many are thrown, and the most crowded removed again.
constexpr double kSurplus = 1.03, kMostSurplus = 1.25;
constexpr int kMostAttempts = 60;
/// Squares of a face's grid of a density's values, at most 2^kMostLevels a side.
constexpr int kMostLevels = 10;
/// And so many on the whole surface, if one a face is not more already.
constexpr double kMostValues = 1 << 25;

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// The longest way across each face with a surface, along u or v; -1 for others.
std::vector<double> faceSizes(const LimitSurface& surface, const std::vector<bool>& has_surface,
                              int threads) {
  constexpr int kSteps = 2, kSide = kSteps + 1;
  std::vector<Location> at;
  for (std::size_t face = 0; face < has_surface.size(); ++face) {
    for (int i = 0; has_surface[face] && i < kSide * kSide; ++i) {
      at.push_back({static_cast<int>(face), static_cast<double>(i % kSide) / kSteps,
                    static_cast<double>(i / kSide) / kSteps});
    }
  }
  const Points points = surface.evaluate(at, Derivatives::none, false, threads).position;
  std::vector<double> sizes(has_surface.size(), -1);
  for (Eigen::Index first = 0; first < points.rows(); first += kSide * kSide) {
    double& size = sizes[static_cast<std::size_t>(at[static_cast<std::size_t>(first)].face)];
    for (int line = 0; line < kSide; ++line) {
      double along_u = 0, along_v = 0;
      for (int i = 0; i < kSteps; ++i) {
        const auto point = [&](int x, int y) { return points.row(first + kSide * y + x); };
        along_u += (point(i + 1, line) - point(i, line)).norm();
        along_v += (point(line, i + 1) - point(line, i)).norm();
      }
      size = std::max({size, along_u, along_v});
    }
  }
  return sizes;
}

/// Makes blue noise, once or, for a count, until the count is met.
class BlueNoiseMaker {
 public:
  BlueNoiseMaker(const LimitSurface& surface, const SurfacePatches& patches,
                 const std::vector<AreaCell>& cells, const std::vector<bool>& has_surface,
                 const BlueNoiseOptions& options, int threads, const Progress& progress)
      : surface_(surface),
        patches_(patches),
        cells_(cells),
        has_surface_(has_surface),
        options_(options),
        threads_(threads),
        progress_(progress),
        margin_(2 * kPositionError * patches.diagonal()) {
    const Points& cage = surface.positions();
    for (Eigen::Index i = 0; i < cage.rows(); ++i) {
      box_.include(cage.row(i).transpose());
    }
    if (!options.density.function()) {
      density_ = DensityField(options.density);
    }
    setWeighedArea();
  }

  BlueNoise ofRadius(double radius) {
    if (options_.density.function()) {
      readFunction(radius);
    }
    expected_ = pointsOf(radius);
    if (expected_ > kMostPoints || radius < DiscGrid::smallestRadius(box_)) {
      throw std::invalid_argument("radius is " + text(radius) + ": about " + text(expected_) +
                                  " points would come out; at most 2147483647 can");
    }
    return result(thrown(radius), radius);
  }

  BlueNoise ofCount(std::size_t count) {
    double radius = radiusOf(count);
    for (int i = 0; options_.density.function() && i < kMostReadings; ++i) {
      readFunction(radius);
      const double finer = radiusOf(count);
      const bool is_fine = finer > radius / 2;
      radius = finer;
      if (is_fine) {
        break;
      }
    }
    expected_ = kSurplus * static_cast<double>(count);
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
      if (!(radius >= DiscGrid::smallestRadius(box_))) {
        break;
      }
      std::vector<Dart> darts = thrown(radius);
      const double excess = static_cast<double>(darts.size()) / static_cast<double>(count);
      const bool is_enough = darts.size() >= count;
      if (is_enough &&
          (excess <= kMostSurplus || darts.size() <= count + 2 || attempt > kMostAttempts / 4)) {
        Crowding crowding(box_, std::move(darts), threads_);
        crowding.thin(count);
        const double slack = crowding.slack();
        const double held = radius * slack * (1 - 1e-12) - margin_;
        return result(std::move(crowding.darts()), std::max(held, 0.));
      }
      const double step = std::sqrt(std::max(excess, 0.25) / kSurplus);
      radius *= is_enough ? step : std::min(step, 0.98);
    }
    throw std::invalid_argument("count is " + std::to_string(count) +
                                ": there is no room for so many points");
  }

 private:
  static constexpr int kMostReadings = 4;

  double pointsOf(double radius) const { return kPacking * weighed_area_ / (radius * radius); }
  double radiusOf(std::size_t count) const {
    return std::sqrt(kPacking * weighed_area_ / (kSurplus * static_cast<double>(count)));
  }

  /// Area times density, roughly.
  void setWeighedArea() {
    weighed_area_ = 0;
    for (const AreaCell& cell : cells_) {
      weighed_area_ += cell.area * density_.meanOn(rectangleOf(patches_, cell));
    }
  }

  void readFunction(double radius) {
    if (sizes_.empty()) {
      sizes_ = faceSizes(surface_, has_surface_, threads_);
    }
    // Coarse grids might miss all there is.
    int fewest = 0;
    while (fewest < 3 && (sizes_.size() << (2 * fewest)) < (std::size_t{1} << 20)) {
      ++fewest;
    }
    std::vector<int> levels(sizes_.size(), -1);
    int most = kMostLevels;
    double values;
    do {
      values = 0;
      for (std::size_t face = 0; face < levels.size(); ++face) {
        if (sizes_[face] >= 0) {
          int& level = levels[face] = std::min(fewest, most);
          while (level < most && sizes_[face] > radius * (1 << level)) {
            ++level;
          }
          values += static_cast<double>(std::size_t{1} << (2 * level));
        }
      }
    } while (values > kMostValues && most-- > 0);
    density_ = DensityField(options_.density, levels);
    setWeighedArea();
  }

  std::vector<Dart> thrown(double radius) {
    DartThrowing throwing(patches_, box_, density_, radius * (1 + 1e-12) + margin_,
                          AreaSampler::kGap, expected_, options_.seed, threads_);
    throwing.run([&](std::size_t darts) {
      done_ = std::max(done_, std::min(static_cast<double>(darts) / expected_, 1.));
      if (progress_) {
        progress_(0.95 * done_);
      }
    });
    std::vector<Dart> darts = std::move(throwing.darts());
    if (options_.density.function()) {
      removeZeros(darts);
    }
    return darts;
  }

  /// Between the points at which it was read the function may be 0.
  void removeZeros(std::vector<Dart>& darts) const {
    std::size_t kept = 0;
    constexpr std::size_t kBatch = std::size_t{1} << 16;
    std::vector<Location> at;
    for (std::size_t first = 0; first < darts.size(); first += at.size()) {
      at.clear();
      for (std::size_t i = first; i < std::min(darts.size(), first + kBatch); ++i) {
        at.push_back(darts[i].at);
      }
      const std::vector<double> weights = options_.density.weights(at);
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (weights[i] > 0) {
          darts[kept++] = darts[first + i];
        }
      }
    }
    darts.resize(kept);
  }

  /// In the order of their faces, each face's in the order in which they were thrown.
  BlueNoise result(std::vector<Dart> darts, double radius) const {
    std::stable_sort(darts.begin(), darts.end(),
                     [](const Dart& a, const Dart& b) { return a.at.face < b.at.face; });
    BlueNoise noise;
    noise.at.resize(darts.size());
    std::transform(darts.begin(), darts.end(), noise.at.begin(),
                   [](const Dart& dart) { return dart.at; });
    noise.radius = radius;
    if (progress_) {
      progress_(1);
    }
    return noise;
  }

  const LimitSurface& surface_;
  const SurfacePatches& patches_;
  const std::vector<AreaCell>& cells_;
  const std::vector<bool>& has_surface_;
  const BlueNoiseOptions& options_;
  int threads_;
  const Progress& progress_;
  double margin_;  // of radii, for the rounding of positions

  Box box_;
  DensityField density_;
  std::vector<double> sizes_;
  double weighed_area_ = 0, expected_ = 1, done_ = 0;
};

}  // namespace

BlueNoise AreaSampler::blueNoise(const BlueNoiseOptions& options, int threads,
                                 const Progress& progress) const {
  if (options.count.has_value() == options.radius.has_value()) {
    throw std::invalid_argument("exactly one of count and radius must be given");
  }
  if (options.radius && !(*options.radius > 0 && std::isfinite(*options.radius))) {
    throw std::invalid_argument("radius is " + text(*options.radius) +
                                "; it must be finite and above 0");
  }
  const std::int64_t count = options.count.value_or(1);
  if (count < 0 || static_cast<double>(count) > kMostPoints) {
    throw std::invalid_argument("count is " + std::to_string(count) +
                                "; it must be 0 to 2147483647");
  }
  if (count == 0) {
    return {{}, std::numeric_limits<double>::infinity()};
  }
  if (!data_->hasArea()) {
    throw std::invalid_argument("the surface has no area");
  }
  const std::vector<bool> has_surface = data_->hasSurface();
  BlueNoiseMaker maker(data_->surface, data_->patches, data_->cells, has_surface, options, threads,
                       progress);
  return options.radius ? maker.ofRadius(*options.radius)
                        : maker.ofCount(static_cast<std::size_t>(count));
}

}  // namespace limitsurf
