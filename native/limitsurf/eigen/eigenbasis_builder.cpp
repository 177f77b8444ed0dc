// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/eigenbasis_builder.h"

#include <algorithm>
#include <cstdint>

#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/eigen/tip_bend.h"
#include "limitsurf/parallel.h"

namespace limitsurf {

using tile_grid::kSlots;
using tile_grid::slot;

namespace {

/// The tables of a mode take some 20 microseconds.
constexpr std::size_t kModesPerTask = 64;

}  // namespace

void Eigenbasis::Builder::build() {
  buildCircle();
  basis_.lambda_.assign(ring_.size(), 1);
  const bool one_face = !ring_.closed() && ring_.faces == 1;
  if (one_face) {
    buildOuterTables(Sides::both);
  } else if (basis_.rotates()) {
    buildOuterTables(Sides::inner);
  } else {
    buildOuterTables(Sides::left);
    buildOuterTables(Sides::right);
    if (ring_.faces > 2) {
      buildOuterTables(Sides::inner);
    }
  }
  buildSpokes();
  if (ring_.kind == RingKind::dart) {
    buildDart();
  } else if (ring_.closed()) {
    buildRadial();
    if (ring_.kind == RingKind::tip) {
      buildBend();
    }
  } else {
    buildCurves();
  }
}

/// On a closed ring spoke i of mode m stands at the angle 2 pi m i / N = (2 pi / 2N) 2 m i and face
/// j at (2 pi / 2N) m (2 j + 1). In a sector spoke i stands at pi m i / k = (2 pi / 4k) 2 m i, and
/// face j likewise.
void Eigenbasis::Builder::buildCircle() {
  basis_.period_ = (ring_.closed() ? 2 : 4) * std::int64_t{ring_.faces};
  circle_ = Circle<Real>(basis_.period_).first(basis_.period_);
  for (const SineCosine<Real>& at : circle_) {
    basis_.cos_.push_back(static_cast<double>(at.cos));
    basis_.sin_.push_back(static_cast<double>(at.sin));
  }
  basis_.waves_ = std::make_unique<const RingWaves>(ring_, basis_.cos_, basis_.sin_);
}

void Eigenbasis::Builder::buildOuterTables(Sides sides) {
  const ModeContinuation::Outer& o = ModeContinuation::of(sides).outer();
  auto tables = std::make_unique<FaceTables>(o);
  for (int q = 0; q < o.count(); ++q) {
    SlotValues values{};
    for (int i = 0; i < o.count(); ++i) {
      values[o.slots()[i]] = o.vectors()(i, q);
    }
    Wide wide;
    wide.outer = o.vectors().col(q);
    wide.grid.fill(0);
    o.step().apply(values, wide.grid);
    tables->outer.push_back(ModeContinuation::rounded(wide));
  }
  basis_.face_tables_[static_cast<int>(sides)] = std::move(tables);
}

/// The values of a spoke mode at the ring's slots, turned so that e_j of this face stands at angle
/// 0.
Eigenbasis::Builder::SlotValues Eigenbasis::Builder::spokeValues(
    int m, const SpokeMode<Real>::Vector& vector, bool sine) const {
  const auto wave = [&](int twice_position) {
    const SineCosine<Real>& at = circleAt(std::int64_t{m} * twice_position);
    return sine ? at.sin : at.cos;
  };
  SlotValues values{};
  values[slot(0, -1)] = vector.edge * wave(-2);
  values[slot(1, -1)] = vector.face * wave(-1);
  values[slot(1, 0)] = vector.edge * wave(0);
  values[slot(1, 1)] = vector.face * wave(1);
  values[slot(0, 1)] = vector.edge * wave(2);
  values[slot(-1, 1)] = vector.face * wave(3);
  values[slot(-1, 0)] = vector.edge * wave(4);
  return values;
}

Eigenbasis::Builder::Wide Eigenbasis::Builder::spokeTable(Sides sides, int m,
                                                          const SpokeMode<Real>& mode, bool plus,
                                                          bool sine) {
  const bool mirror = sides == Sides::right;
  if (plus && mode.linear) {
    const bool along_v = sine != mirror;
    return ModeContinuation::of(sides).linear(along_v ? 0 : 1, along_v ? 1 : 0);
  }
  SlotValues values = spokeValues(m, mode.vector(plus), sine);
  if (mirror) {
    // Counted from the last spoke, which lies on the boundary, the sine mode is the same up to its
    // sign, with u and v exchanged.
    SlotValues mirrored{};
    for (int c = 0; c < kSlots; ++c) {
      mirrored[slot(tile_grid::yOf(c), tile_grid::xOf(c))] = values[c];
    }
    values = mirrored;
  }
  for (int c = 0; c < kSlots; ++c) {
    if (!tile_grid::exists(sides, c)) {
      values[c] = 0;
    }
  }
  return ModeContinuation::of(sides).continued(mode.lambda(plus), values);
}

void Eigenbasis::Builder::buildSpokes() {
  const auto pairs = static_cast<std::size_t>(2 * basis_.spokeCount());
  basis_.spokes_.resize(pairs);
  for (const Sides sides : {Sides::inner, Sides::left, Sides::right, Sides::both}) {
    if (FaceTables* tables = basis_.face_tables_[static_cast<int>(sides)].get()) {
      tables->sine.resize(pairs);
      tables->cosine.resize(sides == Sides::inner ? pairs : 0);
    }
  }
  parallelFor(static_cast<std::size_t>(basis_.spokeCount()), kModesPerTask, 0,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t m = begin; m < end; ++m) {
                  buildSpoke(static_cast<int>(m) + 1);
                }
              });
}

void Eigenbasis::Builder::buildSpoke(int m) {
  const SpokeMode<Real> mode = spokeMode(m);
  for (const bool plus : {true, false}) {
    const auto& vector = mode.vector(plus);
    const int pair = basis_.pairIndex(m, plus);
    basis_.spokes_[pair] = {static_cast<double>(vector.edge), static_cast<double>(vector.face),
                            static_cast<double>(1 / vector.square)};
    Part part[2];
    const int parts = basis_.parts(m, plus, 0, part);
    for (int i = 0; i < parts; ++i) {
      basis_.lambda_[part[i].mode] = static_cast<double>(mode.lambda(plus));
    }
    for (const Sides sides : {Sides::inner, Sides::left, Sides::right, Sides::both}) {
      if (FaceTables* tables = basis_.face_tables_[static_cast<int>(sides)].get()) {
        tables->sine[pair] = ModeContinuation::rounded(spokeTable(sides, m, mode, plus, true));
        if (sides == Sides::inner) {
          tables->cosine[pair] = ModeContinuation::rounded(spokeTable(sides, m, mode, plus, false));
        }
      }
    }
  }
}

/// Modes 1 and 2 of a closed ring: (a, b) = (mean e - v, mean f - v) moves v by (p, q) (a, b) and
/// goes to Q (a, b), Q = B(0) - [p q; p q], B as in spoke_mode.h. The eigenvalues of Q are
/// (3 N - 7 +- sqrt(5 N^2 - 30 N + 49)) / (8 N), those of B(0), where v stays, (3 +- sqrt 5) / 8.
/// At a tip v stays but for the bend of its crease.
void Eigenbasis::Builder::buildRadial() {
  const Real n = ring_.faces;
  const bool moves = ring_.kind == RingKind::interior;
  const Real p = moves ? 3 / (2 * n) : 0, q = moves ? 1 / (4 * n) : 0;
  const Real column = Real(1) / 2 - p, q01 = Real(1) / 8 - q, q11 = Real(1) / 4 - q;
  const Real mean = moves ? (3 * n - 7) / (8 * n) : Real(3) / 8;
  const Real root = moves ? sqrt(5 * n * n - 30 * n + 49) / (8 * n) : sqrt(Real(5)) / 8;
  Eigen::Matrix<Real, 2, 2> vectors;
  basis_.fixed_.resize(1);
  for (int i = 0; i < 2; ++i) {
    const Real lambda = mean + (i == 0 ? root : -root);
    Eigen::Matrix<Real, 2, 1> x(q01, lambda - column), other(lambda - q11, column);
    if (other.norm() > x.norm()) {
      x = other;
    }
    x.normalize();
    vectors.col(i) = x;
    const Real v = (p * x[0] + q * x[1]) / (lambda - 1);
    SlotValues values{};
    for (const int c : tile_grid::kRingSlots) {
      const bool on_spoke = tile_grid::xOf(c) == 0 || tile_grid::yOf(c) == 0;
      values[c] = c == slot(0, 0) ? v : v + (on_spoke ? x[0] : x[1]);
    }
    const Wide wide = ModeContinuation::of(Sides::inner).continued(lambda, values);
    basis_.lambda_[1 + i] = static_cast<double>(lambda);
    basis_.radial_vertex_[i] = static_cast<double>(v);
    basis_.fixed_[0].tables[i] = ModeContinuation::rounded(wide);
    if (moves && ring_.faces == 2 && i == 0) {  // 1/8 is also an eigenvalue of S12: a Jordan pair
      basis_.rest_mode_ = 1;
      for (Eigen::Index j = 0; j < wide.rest.size(); ++j) {
        basis_.rest_.push_back(static_cast<double>(wide.rest[j]));
      }
    }
  }
  basis_.radial_ = vectors.cast<double>();
  const Real determinant = vectors(0, 0) * vectors(1, 1) - vectors(0, 1) * vectors(1, 0);
  Eigen::Matrix<Real, 2, 2> inverse;
  inverse << vectors(1, 1), -vectors(0, 1), -vectors(1, 0), vectors(0, 0);
  basis_.radial_inverse_ = (inverse / determinant).cast<double>();
}

void Eigenbasis::Builder::buildBend() {
  SlotValues values{};
  for (const int c : tile_grid::kRingSlots) {
    const bool on_spoke = tile_grid::xOf(c) == 0 || tile_grid::yOf(c) == 0;
    values[c] = c == slot(0, 0) ? TipBend::kVertex : on_spoke ? TipBend::kEdge : TipBend::kFace;
  }
  const Wide wide = ModeContinuation::of(Sides::inner).continued(TipBend::kEigenvalue, values);
  basis_.lambda_[TipBend::kMode] = TipBend::kEigenvalue;
  basis_.fixed_[0].tables[TipBend::kMode - 1] = ModeContinuation::rounded(wide);
}

void Eigenbasis::Builder::buildDart() {
  const int first = basis_.firstSymmetric();
  auto modes = std::make_unique<DartModes>(ring_.faces);
  for (int mode = 0; mode < modes->count(); ++mode) {
    basis_.lambda_[first + mode] = modes->lambda(mode);
  }
  ModePair pair = modes->pair();
  pair.a += first;
  pair.b += first;
  basis_.pairs_.push_back(pair);
  if (modes->restMode() >= 0) {
    basis_.rest_mode_ = first + modes->restMode();
  }
  basis_.dart_ = std::move(modes);
}

Eigenbasis::Builder::SlotValues Eigenbasis::Builder::ringValues(const std::vector<Real>& ring,
                                                                int face) const {
  SlotValues values{};
  forEachRingSlot(ring_, face, [&](int slot, int point) { values[slot] = ring[point]; });
  return values;
}

/// A sector's spoke mode on one of its faces.
Eigenbasis::Builder::Wide Eigenbasis::Builder::spokeOnFace(int m, const SpokeMode<Real>& mode,
                                                           bool plus, int face) {
  const auto& vector = mode.vector(plus);
  SlotValues values{};
  forEachRingSlot(ring_, face, [&](int slot, int point) {
    const std::int64_t i = point - ring_.edge(0), j = point - ring_.face(0);
    values[slot] = point == 0 ? Real(0)
                   : j < 0    ? vector.edge * circleAt(2 * i * m).sin
                              : vector.face * circleAt((2 * j + 1) * m).sin;
  });
  return ModeContinuation::of(basis_.sides(face)).continued(mode.lambda(plus), values);
}

void Eigenbasis::Builder::buildCurves() {
  const std::vector<CurveMode<Real>> modes = curveModes<Real>(ring_);
  basis_.fixed_.resize(ring_.faces);
  InterruptionStride stride;
  for (int i = 0; i < 2; ++i) {
    const CurveMode<Real>& mode = modes[i];
    basis_.lambda_[1 + i] = static_cast<double>(mode.lambda);
    for (const Real& value : mode.ring) {
      basis_.curve_ring_[i].push_back(static_cast<double>(value));
    }
    const SpokeMode<Real> fed_mode = spokeMode(std::max(mode.fed_mode, 1));
    for (int j = 0; j < ring_.faces; ++j) {
      stride.step();
      const SlotValues values = ringValues(mode.ring, j);
      const Sides sides = basis_.sides(j);
      Wide wide;
      if (mode.fed_mode) {
        const Wide fed = spokeOnFace(mode.fed_mode, fed_mode, mode.feeds_plus, j);
        wide = ModeContinuation::of(sides).continued(mode.lambda, values, mode.feeds, &fed);
      } else if (mode.lambda == Real(1) / 2) {  // a sum of spoke modes to phi = pi/2
        wide = ModeContinuation::of(sides).linear(values[slot(1, 0)], values[slot(0, 1)]);
      } else {
        wide = ModeContinuation::of(sides).continued(mode.lambda, values);
      }
      basis_.fixed_[j].tables[i] = ModeContinuation::rounded(wide);
    }
    if (mode.fed_mode) {
      Part part[2];
      basis_.parts(mode.fed_mode, mode.feeds_plus, 0, part);
      basis_.chains_.push_back({1 + i, part[0].mode, static_cast<double>(mode.feeds)});
    }
  }
}

}  // namespace limitsurf
