// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "limitsurf/interruption_point.h"
#include "limitsurf/number_text.h"
#include "limitsurf/pi.h"
#include "limitsurf/sample/area_sampler_data.h"
#include "limitsurf/sample/blue_noise/crowding.h"
#include "limitsurf/sample/blue_noise/face_order.h"
#include "limitsurf/sample/blue_noise/face_sizes.h"
#include "limitsurf/sample/blue_noise/poisson_disc_sampling.h"

namespace limitsurf {
namespace {

/// The number of points that an area of radius squared holds when no more fit: discs of half the
/// radius then cover 0.547 of a plane (Feder: "Random sequential adsorption", 1980).
constexpr double kPacking = 0.547 * 4 / kPi<double>;
/// The number of points that fit into a signed integer of 32 bits.
constexpr double kMostPoints = 2147483647;
/// For a count, about kSurplus times as many points are sampled and the most crowded are removed. A
/// sampling that has more than kMostSurplus times as many is repeated with a larger radius.
constexpr double kSurplus = 1.03, kMostSurplus = 1.25;
/// A sampling that keeps missing the count is repeated at most this many times; after a quarter of
/// that, any surplus will do.
constexpr int kMostAttempts = 60, kPatientAttempts = kMostAttempts / 4;
/// The radius shrinks to this part at least when there were too few points, so that the repetition
/// makes progress.
constexpr double kLeastShrinking = 0.98;
/// The number of points is taken to be at least this part of the count when the next radius is
/// chosen: an estimate from few points is poor.
constexpr double kLeastExcess = 0.25;
/// The length of a row of points along which no more fit, as a part of their number times the
/// radius (Renyi's parking constant).
constexpr double kRow = 0.7476;
/// A density function is read on a regular grid of each face with at most 2^kMostLevels squares a
/// side and at most kMostValues values in all, unless one square a face is more already.
constexpr int kMostLevels = 10;
constexpr double kMostValues = 1 << 25;
/// Radii are enlarged by a part of this size for the rounding of distances, of a few units in the
/// last place.
constexpr double kRadiusRounding = 1e-12;
/// The part of the progress that sampling has; removing and sorting points have the rest.
constexpr double kSamplingPart = 0.95;

std::string roundedText(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// Makes blue noise, with lengths in the unit of the patches: once for a radius, repeatedly for a
/// count until there are enough points.
class BlueNoiseMaker {
 public:
  BlueNoiseMaker(const LimitSurface& surface, const SurfacePatches& patches,
                 const std::vector<AreaCell>& cells, const std::vector<bool>& has_surface,
                 const BlueNoiseOptions& options, int threads, const Progress& progress)
      : surface_(surface),
        patches_(patches),
        settling_(patches),
        cells_(cells),
        has_surface_(has_surface),
        options_(options),
        threads_(threads),
        progress_(progress),
        margin_(2 * kPositionError * patches.diagonal()) {
    const Points& cage = surface.positions();
    for (Eigen::Index i = 0; i < cage.rows(); ++i) {
      box_.include(patches.scale() * cage.row(i).transpose());
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
      throw std::invalid_argument(
          "radius is " + numberText(radius / patches_.scale()) + ": about " +
          roundedText(expected_) +
          " points would come out; the limit is 2147483647, so choose a larger radius");
    }
    std::vector<Location> at = sampled(radius).at;
    double finer = radius;
    for (int i = 0; at.empty() && options_.density.function() && i < kMostReadings; ++i) {
      finer /= 4;  // parts that are much smaller than the radius: the grid blurs them
      readFunction(finer);
      at = sampled(radius).at;
    }
    if (at.empty() && options_.density.function()) {
      throw std::invalid_argument(
          "no point was found where density is above 0: it is above 0 on parts of the surface that "
          "are far smaller than the radius");
    }
    return result(ordered(at, orderByFace(at, has_surface_.size()), threads_), radius);
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
    const double of_area = radius;
    if (density_.isConstant()) {
      // The points on a surface that is narrower than the radius lie one behind the other.
      radius =
          std::max(radius, kRow * (box_.high - box_.low).maxCoeff() / static_cast<double>(count));
    }
    expected_ = kSurplus * static_cast<double>(count);
    double last_radius = 0, last_excess = 0;
    bool is_strip = radius > of_area;
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
      if (!(radius >= DiscGrid::smallestRadius(box_))) {
        break;
      }
      NoisePoints points = sampled(radius);
      const std::size_t found = points.at.size();
      const double excess = static_cast<double>(found) / static_cast<double>(count);
      const bool is_enough = found >= count;
      if (is_enough &&
          (excess <= kMostSurplus || found <= count + 2 || attempt > kPatientAttempts)) {
        // Neighbours shall be close to each other in memory.
        const std::vector<std::size_t> order = orderByFace(points.at, has_surface_.size());
        Crowding crowding(
            box_, {ordered(points.discs, order, threads_), ordered(points.at, order, threads_)},
            threads_);
        const double slack = crowding.thin(count);
        const double held = radius * slack * (1 - kRadiusRounding) - margin_;
        return result(std::move(crowding.points().at), std::max(held, 0.));
      }
      if (excess < kLeastExcess && radius > of_area) {
        radius = of_area;
        is_strip = false;
        continue;
      }
      // The number of points is a power of the radius: -2 on a wide surface, -1 on a narrow strip.
      // Whether it is closer to -1 the last two attempts tell, without functions whose rounding
      // depends on the machine.
      const double fewer = excess / last_excess, wider = last_radius / radius;
      if (last_excess > 0 && wider != 1) {
        is_strip = wider > 1 ? fewer * fewer < wider * wider * wider
                             : fewer * fewer > wider * wider * wider;
      }
      last_radius = radius;
      last_excess = excess;
      const double ratio = std::max(excess, kLeastExcess) / kSurplus;
      const double step = is_strip ? ratio : std::sqrt(ratio);
      radius *= is_enough ? step : std::min(step, kLeastShrinking);
    }
    throw std::invalid_argument("count is " + std::to_string(count) +
                                ": there is no room for so many points");
  }

 private:
  /// A density function is read on finer grids while its values change the radius much, at most
  /// this many times.
  static constexpr int kMostReadings = 4;
  /// A grid has at least 2^kFewestLevels squares a side while all faces together then have no more
  /// than kFewestValues: coarser grids might miss everything that the function shows.
  static constexpr int kFewestLevels = 3;
  static constexpr std::size_t kFewestValues = std::size_t{1} << 20;
  /// A function that is 0 at so many points is taken to be 0 everywhere.
  static constexpr std::size_t kMostZeros = std::size_t{1} << 20;

  double pointsOf(double radius) const { return kPacking * weighed_area_ / (radius * radius); }
  double radiusOf(std::size_t count) const {
    return std::sqrt(kPacking * weighed_area_ / (kSurplus * static_cast<double>(count)));
  }

  /// Estimates the integral of the density over the surface.
  void setWeighedArea() {
    weighed_area_ = 0;
    InterruptionStride stride;
    for (const AreaCell& cell : cells_) {
      stride.step();
      weighed_area_ += cell.area * density_.meanOn(rectangleOf(patches_, cell));
    }
  }

  /// Reads the density function on grids whose squares are at most a radius wide, where the limits
  /// on the number of values allow it. Throws std::invalid_argument if it is 0 at all points, also
  /// of finer grids.
  void readFunction(double radius) {
    if (sizes_.empty()) {
      sizes_ = faceSizes(surface_, has_surface_, patches_.scale(), threads_);
    }
    int fewest = 0;
    while (fewest < kFewestLevels && (sizes_.size() << (2 * fewest)) < kFewestValues) {
      ++fewest;
    }
    density_ = DensityField(options_.density, levelsFor(radius, fewest));
    while (density_.isZero() && density_.pointCount() < kMostZeros && fewest < kMostLevels) {
      ++fewest;  // what is above 0 may lie between the points
      density_ = DensityField(options_.density, levelsFor(radius, fewest));
    }
    if (density_.isZero()) {
      throw std::invalid_argument(zeroEverywhereText(density_.pointCount()));
    }
    setWeighedArea();
  }

  /// The levels of grids whose squares are at most a radius wide, if they have no more than
  /// kMostValues, but `fewest` at least.
  std::vector<int> levelsFor(double radius, int fewest) const {
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
    return levels;
  }

  NoisePoints sampled(double radius) {
    PoissonDiscSampling sampling(patches_, settling_, box_, density_,
                                 radius * (1 + kRadiusRounding) + margin_, AreaSampler::kGap,
                                 expected_, options_.seed, threads_);
    NoisePoints points = sampling.run([&](std::size_t accepted) {
      done_ = std::max(done_, std::min(static_cast<double>(accepted) / expected_, 1.));
      if (progress_) {
        progress_(kSamplingPart * done_);
      }
    });
    if (options_.density.function()) {
      removeZeros(points);
    }
    return points;
  }

  /// Removes points at which the density function is 0: it may be 0 between the points of the grid.
  void removeZeros(NoisePoints& points) const {
    std::size_t kept = 0;
    constexpr std::size_t kBatch = std::size_t{1} << 16;
    const std::vector<Location> all = points.at;
    for (std::size_t first = 0; first < all.size(); first += kBatch) {
      const auto at = Span<Location>(all).subspan(first, std::min(kBatch, all.size() - first));
      const std::vector<double> weights = options_.density.weights(at);
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (weights[i] > 0) {
          points.discs[kept] = points.discs[first + i];
          points.at[kept++] = at[i];
        }
      }
    }
    points.discs.resize(kept);
    points.at.resize(kept);
  }

  /// The points in the order of their faces.
  BlueNoise result(std::vector<Location> at, double radius) const {
    if (progress_) {
      progress_(1);
    }
    return {std::move(at), radius / patches_.scale()};
  }

  const LimitSurface& surface_;
  const SurfacePatches& patches_;
  const SettlingCores settling_;
  const std::vector<AreaCell>& cells_;
  const std::vector<bool>& has_surface_;
  const BlueNoiseOptions& options_;
  int threads_;
  const Progress& progress_;
  double margin_;  // added to radii, for the rounding of positions

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
    throw std::invalid_argument("radius is " + numberText(*options.radius) +
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
  data_->checkLimits(options.density.limits(), has_surface);
  BlueNoiseMaker maker(data_->surface, data_->patches, data_->cells, has_surface, options, threads,
                       progress);
  return options.radius ? maker.ofRadius(*options.radius * data_->patches.scale())
                        : maker.ofCount(static_cast<std::size_t>(count));
}

}  // namespace limitsurf
