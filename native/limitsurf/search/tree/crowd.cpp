// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/crowd.h"

#include <algorithm>
#include <vector>

namespace limitsurf {
namespace {

/// A mesh counts as one with outliers if half of its vertices are nearer to the median than this
/// part of the diagonal: less than that leaves single precision too few digits for the faces there.
constexpr double kCrowded = 0x1p-12;

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<Vector3> crowdOf(const LimitSurface& surface, const SurfacePatches& patches) {
  constexpr Eigen::Index kSample = 1024;
  const Points& cage = surface.positions();
  const Eigen::Index stride = cage.rows() / kSample + 1;
  std::vector<Vector3> sample;
  for (Eigen::Index i = 0; i < cage.rows(); i += stride) {
    sample.push_back(patches.scale() * cage.row(i).transpose());
  }
  if (sample.empty()) {
    return std::nullopt;
  }
  std::vector<double> values(sample.size());
  Vector3 median;
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(sample.begin(), sample.end(), values.begin(),
                   [&](const Vector3& vertex) { return vertex[axis]; });
    median[axis] = medianOf(values);
  }
  std::transform(sample.begin(), sample.end(), values.begin(),
                 [&](const Vector3& vertex) { return (vertex - median).norm(); });
  return medianOf(values) < kCrowded * patches.diagonal() ? std::optional<Vector3>(median)
                                                          : std::nullopt;
}

}  // namespace limitsurf
