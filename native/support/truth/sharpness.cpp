// SPDX-License-Identifier: Apache-2.0
#include "support/truth/sharpness.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <set>

namespace limitsurf::test {
namespace {

bool isSemiSharp(float sharpness) { return sharpness > 0 && !isInfinitelySharp(sharpness); }

/// The sum of float32s, in the order of their values. (docs/accuracy.md promises that order: sums
/// of three and more depend on it, and the surface must not depend on the order of the mesh.)
float sumInOrder(std::multiset<float> values, float first = 0) {
  return std::accumulate(values.begin(), values.end(), first);
}

}  // namespace

float enteredSharpness(double value) {
  return static_cast<float>(std::min(value, static_cast<double>(kInfinitelySharp)));
}

float decayed(float sharpness) {
  if (isInfinitelySharp(sharpness)) return kInfinitelySharp;
  return sharpness > 1 ? sharpness - 1 : 0;
}

std::vector<float> childSharpness(const std::vector<float>& edges, Creasing creasing) {
  std::multiset<float> semi_sharp;
  std::copy_if(edges.begin(), edges.end(), std::inserter(semi_sharp, semi_sharp.end()),
               isSemiSharp);
  const float sum = sumInOrder(semi_sharp);
  const std::size_t count = semi_sharp.size();
  std::vector<float> child;
  for (const float sharpness : edges) {
    if (creasing == Creasing::uniform || !isSemiSharp(sharpness) || count == 1) {
      child.push_back(decayed(sharpness));
      continue;
    }
    const float mean_of_others = (sum - sharpness) / static_cast<float>(count - 1);
    const float mixed = 0.75f * sharpness + 0.25f * mean_of_others;
    child.push_back(std::max(mixed - 1.0f, 0.0f));
  }
  return child;
}

Rule vertexRule(float vertex, const std::vector<float>& edges) {
  if (vertex > 0) return Rule::corner;
  switch (std::count_if(edges.begin(), edges.end(), [](float s) { return s > 0; })) {
    case 0:
      return Rule::smooth;
    case 1:
      return Rule::dart;
    case 2:
      return Rule::crease;
    default:
      return Rule::corner;
  }
}

float parentsShare(float vertex, const std::vector<float>& edges,
                   const std::vector<float>& child_edges, Creasing creasing) {
  const bool vertex_decays = vertex > 0 && decayed(vertex) == 0;
  std::multiset<float> decaying;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool decays = creasing == Creasing::uniform ? edges[i] <= 1 : child_edges[i] == 0;
    if (edges[i] > 0 && decays) decaying.insert(edges[i]);
  }
  const std::size_t count = decaying.size() + (vertex_decays ? 1 : 0);
  if (count == 0) return 0;
  const float sum = sumInOrder(decaying, vertex_decays ? vertex : 0);
  return std::min(sum / static_cast<float>(count), 1.0f);
}

}  // namespace limitsurf::test
