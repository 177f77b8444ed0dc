// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/sample/density.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// The blue noise that is wanted. Exactly one of `count` and `radius` must be given.
struct BlueNoiseOptions {
  std::optional<std::int64_t> count;
  std::optional<double> radius;
  std::uint64_t seed = 0;
  Density density;
};

struct BlueNoise {
  std::vector<Location> at;  ///< in the order of the faces
  /// The distance that the points keep. A point has the radius
  /// radius / sqrt(density / largest density), and two points keep at least the mean of their
  /// radii.
  double radius = 0;
};

/// Random points on a limit surface, distributed by the area of the surface, not by (u, v).
///
/// A sampler is made for one pose of the surface. It refers to the surface, which must outlive it
/// and keep that pose. All const members may be called from many threads at once. A seed gives the
/// same points on every machine and with any number of threads; another version of the library may
/// give others.
///
/// Cost of making it: O(faces), 3 ms for 10,000 quads and 0.4 s for as many triangles, on one
/// thread. Memory: about 100 bytes a face, a few times as much around extraordinary vertices.
class AreaSampler {
 public:
  explicit AreaSampler(const LimitSurface& surface, int threads = 0);
  ~AreaSampler();
  AreaSampler(AreaSampler&&) noexcept;
  AreaSampler& operator=(AreaSampler&&) noexcept;

  /// `count` independent random locations, uniform by area, or in proportion to area times density.
  ///
  /// They come from rejection sampling under strict bounds, so the distribution is exact: neither
  /// quadrature nor polygons are involved. The order is random: the first n of a longer sequence
  /// are the locations for a count of n (for a density function only if no larger value appears
  /// later).
  ///
  /// A density function without limits is read at the corners and middles of faces first, to find a
  /// large value, then at each candidate. The more its largest value exceeds its mean, the longer
  /// that takes. With limits candidates come where these are high, and the first n of a longer
  /// sequence are always the locations for a count of n.
  ///
  /// Throws std::invalid_argument for a negative count, for a density that is 0 everywhere,
  /// negative, not finite or above its limit, for limits of another number of faces, and for a
  /// count above 0 on a surface without area. Cost: about 0.2 microseconds a location on all
  /// threads together.
  std::vector<Location> uniform(std::int64_t count, std::uint64_t seed, const Density& density = {},
                                int threads = 0, const Progress& progress = {}) const;

  /// Random points that keep a distance from each other (Poisson-disc sampling).
  ///
  /// Two points conflict if the chord between them is shorter than the radius and the angle between
  /// their normals is below 90 degrees, so that points on the two sides of a thin sheet do not
  /// conflict. Borders of faces, boundaries and creases have no other effect.
  ///
  /// For a radius the points are maximal: no room for another point remains that is wider than kGap
  /// times the radius. For a count there are exactly as many points, as far apart as such random
  /// points can be, and the result says which radius they keep.
  ///
  /// With a density the radius of a point is proportional to 1 / sqrt(density / largest density),
  /// and two points keep the mean of their radii. No point lies where the density is 0. A density
  /// function is read on a regular grid of each face whose squares are at most a radius wide (2^25
  /// values at most) and interpolated bilinearly; points at which the function is 0 are removed.
  ///
  /// Throws std::invalid_argument as uniform() does; for a radius that is not finite and above 0,
  /// or so small that there would be more than 2^31 points; and for faces sheared so strongly that
  /// there would be far more cells of (u, v) than points. Cost: O(points + faces), about 8
  /// microseconds a point on all threads together.
  BlueNoise blueNoise(const BlueNoiseOptions& options, int threads = 0,
                      const Progress& progress = {}) const;

  /// The width of the largest gap that may remain between discs of blue noise, as a part of the
  /// radius.
  static constexpr double kGap = 1. / 512;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace limitsurf
