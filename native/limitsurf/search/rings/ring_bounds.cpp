// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/rings/ring_bounds.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/float_rounding.h"
#include "limitsurf/search/search_kernels.h"

namespace limitsurf {
namespace {

/// More than the relative rounding of polynomials' coefficients.
constexpr double kMargin = 1e-12;

}  // namespace

void RingBounds::include(const BezierPatch& patch, const Vector3& vertex,
                         const Eigen::Matrix3d& frame) {
  // Polynomials of degree 6: rho^2, z^2, and z^2 + z.
  double along[16][4], heights[16][4];
  const Vector3 offset = patch.anchor.head<3>().matrix() - vertex;
  for (int i = 0; i < 16; ++i) {
    const Vector3 at = frame * (patch.points[i].head<3>().matrix() + offset);
    along[i][0] = at[0];
    along[i][1] = at[1];
    along[i][2] = along[i][3] = 0;
    heights[i][0] = heights[i][1] = heights[i][3] = 0;
    heights[i][2] = at[2];
  }
  constexpr double kZero[4] = {0, 0, 0, 0}, kHalfDown[4] = {0, 0, -0.5, 0};
  double rho2[kDistanceSize], z2[kDistanceSize], z2_and_z[kDistanceSize];
  const SearchKernels& kernels = SearchKernels::get();
  kernels.squaredDistance(along, kZero, rho2);
  kernels.squaredDistance(heights, kZero, z2);
  kernels.squaredDistance(heights, kHalfDown, z2_and_z);

  // Where a >= b holds for the coefficients of two polynomials, it holds for the polynomials.
  double least = rho2[0], largest = 0, most_z = z2_and_z[0] / rho2[0] - z2[0] / rho2[0],
         least_z = most_z, steepest = 0;
  for (int i = 0; i < kDistanceSize; ++i) {  // the padding repeats coefficients
    least = std::min(least, rho2[i]);
    largest = std::max(largest, rho2[i]);
    const double ratio = (z2_and_z[i] - z2[i]) / rho2[i];
    most_z = std::max(most_z, ratio);
    least_z = std::min(least_z, ratio);
    steepest = std::max(steepest, z2[i] / rho2[i]);
  }
  farthest = std::max(farthest, roundedUp(std::sqrt(largest) * (1 + kMargin)));
  if (!(least > kMargin * largest)) {
    nearest = 0;
    rise = fall = slope = kNone;
    return;
  }
  nearest = std::min(nearest, roundedDown(std::sqrt(least) * (1 - kMargin)));
  rise = std::max(rise, roundedUp(most_z + kMargin * std::abs(most_z)));
  fall = std::max(fall, roundedUp(-least_z + kMargin * std::abs(least_z)));
  slope = std::max(slope, roundedUp(std::sqrt(steepest) * (1 + kMargin)));
}

double RingBounds::squaredDistanceLess(double height, double aside) const {
  const double bend = height >= 0 ? double{rise} : double{fall};
  if (!(bend < kNone)) {
    return -std::numeric_limits<double>::infinity();
  }
  const double square = 1 - 2 * std::abs(height) * bend;
  const auto at = [&](double rho) { return rho * (square * rho - 2 * aside); };
  const double least = square > 0
                           ? at(std::clamp(aside / square, double{nearest}, double{farthest}))
                           : std::min(at(nearest), at(farthest));
  return least - differenceRounding(farthest, aside + std::abs(height));
}

double RingBounds::distanceFromLine(double angle) const {
  return slope < kNone ? nearest * std::sin(std::max(0., angle - std::atan(double{slope}))) : 0;
}

}  // namespace limitsurf
