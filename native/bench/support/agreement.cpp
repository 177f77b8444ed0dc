// SPDX-License-Identifier: Apache-2.0
#include "bench/support/agreement.h"

#include <algorithm>
#include <cstdio>

namespace limitsurf::bench {
namespace {

bool g_all_agreed = true;

bool isNearCorner(const Location& location) {
  constexpr double kNear = 0x1p-8;
  const double s = std::min(location.u, 1 - location.u), t = std::min(location.v, 1 - location.v);
  return std::max(s, t) < kNear;
}

double difference(const Points& a, const Points& b, double scale) {
  const double d = (a - b).cwiseAbs().maxCoeff();
  return d == d ? d / scale : 1;
}

}  // namespace

double largestDifference(const MeshArrays& cage, const LimitSurface& ours, const BfrPeer& bfr,
                         Span<Location> at) {
  std::vector<Location> chosen;
  std::copy_if(at.begin(), at.end(), std::back_inserter(chosen),
               [](const Location& l) { return !isNearCorner(l); });
  if (chosen.empty()) return 0;
  const Evaluation a = ours.evaluate(chosen, Derivatives::second, false, 1);
  Evaluation b;
  for (Points* p : {&b.position, &b.du, &b.dv, &b.duu, &b.duv, &b.dvv})
    p->resize(static_cast<Eigen::Index>(chosen.size()), 3);
  bfr.evaluate<Derivatives::second>(bfr.coordinates(chosen), b);

  // Bfr's sub-faces of n-gons are half as wide, so their derivatives are larger.
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (cage.face_sizes[ours.baseFace()[chosen[i].face]] == 4) continue;
    for (Points* p : {&b.du, &b.dv}) p->row(static_cast<Eigen::Index>(i)) /= 2;
    for (Points* p : {&b.duu, &b.duv, &b.dvv}) p->row(static_cast<Eigen::Index>(i)) /= 4;
  }
  double largest = difference(a.position, b.position, cage.diagonal());
  const auto compare = [&](const Points& p, const Points& q) {
    largest = std::max(largest, difference(p, q, q.cwiseAbs().maxCoeff()));
  };
  compare(a.du, b.du);
  compare(a.dv, b.dv);
  compare(a.duu, b.duu);
  compare(a.duv, b.duv);
  compare(a.dvv, b.dvv);
  return largest;
}

void noteDifference(const std::string& what, double difference) {
  const bool agrees = difference < kAgreement;
  std::printf("%s: differs from Bfr level 10 by %.1e%s\n", what.c_str(), difference,
              agrees ? "" : "  NOT THE SAME SURFACE");
  g_all_agreed &= agrees;
}

bool allAgreed() { return g_all_agreed; }

}  // namespace limitsurf::bench
