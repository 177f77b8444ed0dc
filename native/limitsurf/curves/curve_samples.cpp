// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/curve_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "limitsurf/mesh/messages.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr double kMostSamples = 1 << 25;
constexpr double kLeastParts = 3;
constexpr std::size_t kSamplesPerTask = 256;

}  // namespace

CurveSamples::CurveSamples(const EdgeCurves& curves, double spacing, int threads) {
  const auto parts = [&](std::int64_t edge) {
    return std::max(kLeastParts, std::ceil(curves.edgeLength(edge) / spacing));
  };
  double total = 0;
  for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
    total += parts(edge);
  }
  if (!(total <= kMostSamples)) {
    throw std::invalid_argument(
        text("row_distance is too small for these curves: they would be divided into more than ",
             static_cast<std::int64_t>(kMostSamples), " parts to compare the rows"));
  }
  std::vector<int> curve;
  std::vector<double> arc;
  const auto add = [&](int on, double at, int mesh_vertex) {
    const int i = static_cast<int>(vertex.size());
    curve.push_back(on);
    arc.push_back(std::min(at, curves.length(on)));
    vertex.push_back(mesh_vertex);
    next.push_back(i + 1);
    before.push_back(i - 1);
  };
  for (int i = 0; i < curves.count(); ++i) {
    const auto begin = curves.offsets()[static_cast<std::size_t>(i)];
    const auto end = curves.offsets()[static_cast<std::size_t>(i) + 1];
    const auto first = vertex.size();
    double passed = 0;
    for (std::int64_t edge = begin; edge < end; ++edge) {
      const double count = parts(edge), length = curves.edgeLength(edge);
      for (double k = 0; k < count; ++k) {
        add(i, passed + length * k / count, k == 0 ? curves.edgeVertices(edge).first : -1);
      }
      passed += length;
    }
    if (curves.closed(i)) {
      next.back() = static_cast<int>(first);
      before[first] = static_cast<int>(vertex.size()) - 1;
    } else {
      add(i, curves.length(i), curves.edgeVertices(end - 1).second);
      next.back() = -1;
      before[first] = -1;
    }
  }
  positions.resize(static_cast<Eigen::Index>(arc.size()), 3);
  parallelFor(arc.size(), kSamplesPerTask, threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      positions.row(static_cast<Eigen::Index>(i)) = curves.at(curve[i], arc[i]).position;
    }
  });
}

}  // namespace limitsurf
