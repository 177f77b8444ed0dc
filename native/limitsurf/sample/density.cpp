// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/density.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limitsurf/number_text.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {
namespace {

/// Weights of vertices that go beyond this are divided by a power of two.
constexpr double kLargestWeight = 1e100;

/// A function that interpolates weights of 0 and above may round to a value below 0, by less than
/// this part of its values nearby.
constexpr double kRounding = 1e-12;

bool isWeight(double value) { return value >= 0 && std::isfinite(value); }

}  // namespace

Density::Density(const LimitSurface& surface, const Eigen::VectorXd& weights, int threads) {
  const Eigen::Index vertices = surface.positions().rows();
  if (weights.size() != vertices) {
    throw std::invalid_argument("density has " + std::to_string(weights.size()) +
                                " weights; the mesh has " + std::to_string(vertices) + " vertices");
  }
  for (Eigen::Index vertex = 0; vertex < vertices; ++vertex) {
    if (!isWeight(weights[vertex])) {
      std::ostringstream message;
      message << "density is " << numberText(weights[vertex]) << " at vertex " << vertex
              << "; it must be finite and at least 0";
      throw std::invalid_argument(message.str());
    }
  }
  const std::vector<int>& base_face = surface.baseFace();
  std::vector<Location> at;
  at.reserve(4 * base_face.size());
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(base_face[face]) == 0) {
      for (int corner = 0; corner < 4; ++corner) {
        at.push_back({face, static_cast<double>(corner & 1), static_cast<double>(corner >> 1)});
      }
    }
  }
  corners_.resize(4 * base_face.size(), 0);
  // Only ratios matter, and values of data must not be that large.
  const double largest = vertices > 0 ? weights.maxCoeff() : 0;
  const double unit = std::ldexp(1., largest > kLargestWeight ? std::ilogb(largest) : 0);
  const DataRows values = surface.varying(weights / unit, threads).evaluate(at, {}, threads).value;
  for (std::size_t i = 0; i < at.size(); ++i) {
    // A sum of weights that are all 0 may round to less than 0.
    corners_[4 * static_cast<std::size_t>(at[i].face) + i % 4] =
        std::max(values(static_cast<Eigen::Index>(i), 0), 0.);
  }
}

std::vector<double> Density::weights(Span<Location> at) const {
  std::vector<double> result(at.size(), 0);
  function_(at, result.data());
  const double largest = result.empty() ? 0 : *std::max_element(result.begin(), result.end());
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (result[i] < 0 && result[i] >= -kRounding * largest) {
      result[i] = 0;
    }
    if (!isWeight(result[i])) {
      std::ostringstream message;
      message << "density is " << numberText(result[i]) << " at face " << at[i].face
              << ", (u, v) = (" << at[i].u << ", " << at[i].v
              << "); it must be finite and at least 0";
      throw std::invalid_argument(message.str());
    }
    if (limits_.areKnown() && result[i] > limits_.at(at[i])) {
      std::ostringstream message;
      message << "density is " << numberText(result[i]) << " at face " << at[i].face
              << ", (u, v) = (" << at[i].u << ", " << at[i].v << "); its limit there is "
              << numberText(limits_.at(at[i]));
      throw std::invalid_argument(message.str());
    }
  }
  return result;
}

std::string zeroEverywhereText(std::size_t count) {
  if (count == 0) {
    return "density is 0 everywhere on the surface, as its limits say";
  }
  return "density is 0 at all of " + std::to_string(count) +
         " locations: it is above 0 nowhere, or on too small a part of the surface";
}

std::string tooFewAcceptedText(std::size_t count, double largest, double limit) {
  const std::string candidates = std::to_string(count) +
                                 " candidates in succession, with densities "
                                 "of up to " +
                                 numberText(largest) + ", was accepted";
  return limit > 0 ? "density_limits go up to " + numberText(limit) +
                         ", too far above density: none of " + candidates
                   : "density is too small on nearly all of the surface, compared with its largest "
                     "value: none of " +
                         candidates;
}

}  // namespace limitsurf
