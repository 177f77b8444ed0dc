// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/vertex_limit.h"

#include <cmath>
#include <limits>

namespace limitsurf {

void vertexJet(const TileTable& table, const Pose& pose, int ring_tile, Jet& jet) {
  const RingTile& tile = table.ring_tiles[ring_tile];
  const Pose::RingPose& ring_pose = pose.ring(tile.ring);
  const Eigenbasis& basis = *table.rings[tile.ring].basis;
  const Ring& ring = basis.ring();
  const Points& coefficients = ring_pose.coefficients;
  const auto coefficient = [&](int mode, double factor) -> Padded {
    const Vector3 c = factor * coefficients.row(mode);
    return {c[0], c[1], c[2], 0};
  };
  jet.anchor = ring_pose.limit;
  PatchValues<Padded>& patch = jet.patch;
  patch.value = coefficient(0, 1);
  jet.exponent = 0;
  const Padded none = Padded::Constant(std::numeric_limits<double>::quiet_NaN());
  patch.du = patch.dv = patch.duu = patch.duv = patch.dvv = none;
  if (ring.closed()) {
    if (vertexIsStationary(ring)) {
      patch.du = patch.dv = Padded::Zero();
    }
    return;
  }
  // The boundary is a cubic B-spline curve e_k, v, e_0, with first and second derivatives
  // (e_0 - e_k) / 2 and e_0 - 2 v + e_k at v. At a pinned vertex they are e_0 - v and 0. Both ends
  // of a loop run along e_0.
  const double first = std::ldexp(1., -tile.ring_steps), second = first * first;
  const bool pinned = ring.kind == RingKind::pinned;
  if (onLeft(tile.sides)) {
    patch.du = coefficient(1, first) + (pinned ? coefficient(2, first) : Padded::Zero());
    patch.duu = pinned ? Padded::Zero() : coefficient(2, 6 * second);
  }
  if (onRight(tile.sides)) {
    const bool same_way = ring.kind == RingKind::loop;
    patch.dv = coefficient(1, same_way ? first : -first) +
               (pinned ? coefficient(2, first) : Padded::Zero());
    patch.dvv = pinned ? Padded::Zero() : coefficient(2, 6 * second);
  }
}

bool vertexIsStationary(const Ring& ring) {
  return ring.kind == RingKind::interior && ring.faces <= 3;
}

bool vertexHasNormal(const Ring& ring) {
  switch (ring.kind) {
    case RingKind::interior:
    case RingKind::dart:
      return ring.faces >= 3;
    case RingKind::boundary:
      return ring.faces <= 3;
    case RingKind::pinned:
      return ring.faces == 1;
    default:
      return false;
  }
}

}  // namespace limitsurf
