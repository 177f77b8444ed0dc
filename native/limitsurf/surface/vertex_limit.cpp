// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/vertex_limit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {
namespace {

/// Vectors below this fraction of the largest coefficient count as vanishing: several orders above
/// rounding, far below what a mesh is modelled with.
constexpr double kVanishing = 1e-10;

/// A vector-valued term n^power growth^n.
struct Term {
  double growth;
  int power;
  Vector3 du, dv;
};

bool dominates(double growth_a, int power_a, double growth_b, int power_b) {
  // Equal eigenvalues may differ by rounding when they come from different closed forms.
  const double size_a = std::abs(growth_a), size_b = std::abs(growth_b);
  if (std::abs(size_a - size_b) > 1e-13) {
    return size_a > size_b;
  }
  if ((growth_a < 0) != (growth_b < 0)) {
    return growth_b < 0;
  }
  return power_a > power_b;
}

/// The size of the larger eigenvalue of a pair.
double largerSize(const ModePair& pair) {
  const double square = pair.forth * pair.back;
  return square < 0 ? std::sqrt(pair.mean * pair.mean - square)
                    : std::abs(pair.mean) + std::sqrt(square);
}

/// The size of the eigenvalue that makes a mode matter.
double sizeOf(const Eigenbasis& basis, int mode) {
  for (const ModePair& pair : basis.pairs()) {
    if (mode == pair.a || mode == pair.b) {
      return largerSize(pair);
    }
  }
  return std::abs(basis.eigenvalue(mode));
}

/// Terms of the derivatives at u = v = 2^-n, dominant ones first, like ones added up.
std::vector<Term> approachTerms(const Eigenbasis& basis, int face, const Points& coefficients) {
  Quarter corner(1, 1);  // the outermost point of the way, where it enters quarter (1, 1)
  corner.u = corner.v = 0;
  const GridWindow window = gridWindow(corner, basis.sides(face), 1);

  std::vector<Term> terms;
  const auto add = [&](int shape, double growth, int power, const Vector3& coefficient) {
    const Eigenbasis::Table table = basis.table(shape, face);
    PatchValues<double> patch;
    evaluateWindow<1>(table.grid + window.b * tile_grid::kSize + window.a, tile_grid::kSize,
                      window.u, window.v, patch);
    terms.push_back({growth, power, patch.du * coefficient, patch.dv * coefficient});
  };
  // Powers of lambda order the terms; the 2^n that both derivatives share does not. Of a large ring
  // only the slowest modes can matter.
  std::vector<int> modes(basis.modeCount() - 1);
  for (int mode = 1; mode < basis.modeCount(); ++mode) {
    modes[mode - 1] = mode;
  }
  constexpr std::size_t kSlowest = 24;
  const std::size_t kept = std::min(kSlowest, modes.size());
  std::partial_sort(modes.begin(), modes.begin() + static_cast<std::ptrdiff_t>(kept), modes.end(),
                    [&](int a, int b) { return sizeOf(basis, a) > sizeOf(basis, b); });
  for (const ModePair& pair : basis.pairs()) {
    const Vector3 a = coefficients.row(pair.a), b = coefficients.row(pair.b);
    const double square = pair.forth * pair.back;
    if (square < 0) {  // turned by whole circles: as they are
      add(pair.a, largerSize(pair), 0, a);
      add(pair.b, largerSize(pair), 0, b);
      continue;
    }
    for (const double root : {std::sqrt(square), -std::sqrt(square)}) {
      // The eigenvector to mean + root is a + (root / back) b.
      const Vector3 share = (a + (pair.back / root) * b) / 2;
      add(pair.a, pair.mean + root, 0, share);
      add(pair.b, pair.mean + root, 0, (root / pair.back) * share);
    }
  }
  const auto inPair = [&](int mode) {
    return std::any_of(basis.pairs().begin(), basis.pairs().end(),
                       [&](const ModePair& pair) { return mode == pair.a || mode == pair.b; });
  };
  for (std::size_t i = 0; i < kept; ++i) {
    const int mode = modes[i];
    if (inPair(mode)) {
      continue;
    }
    const Vector3 coefficient = coefficients.row(mode);
    add(mode, basis.eigenvalue(mode), 0, coefficient);
    for (const Eigenbasis::Chain& chain : basis.chains()) {
      if (chain.from == mode) {
        add(chain.to, basis.eigenvalue(mode), 1, chain.rate / basis.eigenvalue(mode) * coefficient);
      }
    }
  }
  std::stable_sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
    return dominates(a.growth, a.power, b.growth, b.power);
  });
  std::vector<Term> merged;
  for (const Term& term : terms) {
    if (!merged.empty() &&
        !dominates(merged.back().growth, merged.back().power, term.growth, term.power)) {
      merged.back().du += term.du;
      merged.back().dv += term.dv;
    } else {
      merged.push_back(term);
    }
  }
  return merged;
}

}  // namespace

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
  // The boundary is a cubic B-spline curve e_k, v, e_0 with first and second derivatives
  // (e_0 - e_k) / 2 and e_0 - 2 v + e_k at v; pinned, it ends there as e_0 - v and 0.
  const double first = std::ldexp(1., -tile.ring_steps), second = first * first;
  const bool pinned = ring.kind == RingKind::pinned;
  if (onLeft(tile.sides)) {
    patch.du = coefficient(1, first) + (pinned ? coefficient(2, first) : Padded::Zero());
    patch.duu = pinned ? Padded::Zero() : coefficient(2, 6 * second);
  }
  if (onRight(tile.sides)) {
    patch.dv = coefficient(1, -first) + (pinned ? coefficient(2, first) : Padded::Zero());
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

VertexApproach vertexApproach(const TileTable& table, const Pose& pose, int ring_tile, int turns) {
  const RingTile& tile = table.ring_tiles[ring_tile];
  const Points& coefficients = pose.ring(tile.ring).coefficients;
  std::vector<Term> terms = approachTerms(*table.rings[tile.ring].basis, tile.face, coefficients);
  for (Term& term : terms) {
    for (int i = 0; i < turns; ++i) {
      const Vector3 du = term.du;
      term.du = -term.dv;
      term.dv = du;
    }
  }

  const double size = coefficients.bottomRows(coefficients.rows() - 1).cwiseAbs().maxCoeff();
  VertexApproach result{Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  const auto firstPresent = [&](auto member) -> Vector3 {
    for (const Term& term : terms) {
      if ((term.*member).norm() > kVanishing * size) {
        return term.*member;
      }
    }
    return Vector3::Zero();
  };
  result.du = firstPresent(&Term::du);
  result.dv = firstPresent(&Term::dv);

  // The cross product's terms: n^(p + q) (lambda mu)^n du_lambda x dv_mu.
  struct CrossTerm {
    double growth;
    int power;
    Vector3 normal;
  };
  std::vector<CrossTerm> crosses;
  for (const Term& a : terms) {
    for (const Term& b : terms) {
      crosses.push_back({a.growth * b.growth, a.power + b.power, a.du.cross(b.dv)});
    }
  }
  std::stable_sort(crosses.begin(), crosses.end(), [](const CrossTerm& a, const CrossTerm& b) {
    return dominates(a.growth, a.power, b.growth, b.power);
  });
  for (std::size_t i = 0; i < crosses.size();) {
    Vector3 sum = Vector3::Zero();
    const CrossTerm& leading = crosses[i];
    for (; i < crosses.size() &&
           !dominates(leading.growth, leading.power, crosses[i].growth, crosses[i].power);
         ++i) {
      sum += crosses[i].normal;
    }
    if (sum.norm() > kVanishing * size * size) {
      result.normal = sum;
      break;
    }
  }
  return result;
}

}  // namespace limitsurf
