// SPDX-License-Identifier: Apache-2.0
//
// Trials of blue noise, several at once. kernels_by_set.inl.h compiles this file for each
// instruction set, where kLanes and squareRoot() are defined. Nothing here may call a function that
// is defined elsewhere: its code could be that of another set.

#include "limitsurf/surface/batch/lane_vectors.inl.h"

/// kLanes places, or discs, at a time.
using Several = Lanes<kLanes>;

using SeveralVectors = LaneVectors<kLanes>;

inline SeveralVectors load(const double (&from)[3][8], int first) {
  return {{Several::load(from[0] + first), Several::load(from[1] + first),
           Several::load(from[2] + first)}};
}
inline void store(const SeveralVectors& vectors, double (&to)[3][8], int first) {
  for (int i = 0; i < 3; ++i) {
    vectors.axis[i].store(to[i] + first);
  }
}

inline SeveralVectors operator+(const SeveralVectors& a, const SeveralVectors& b) {
  return {{a.axis[0] + b.axis[0], a.axis[1] + b.axis[1], a.axis[2] + b.axis[2]}};
}
inline SeveralVectors operator-(const SeveralVectors& a, const SeveralVectors& b) {
  return {{a.axis[0] - b.axis[0], a.axis[1] - b.axis[1], a.axis[2] - b.axis[2]}};
}
inline SeveralVectors operator*(const Several& a, const SeveralVectors& b) {
  return {{a * b.axis[0], a * b.axis[1], a * b.axis[2]}};
}
inline Several lengths(const SeveralVectors& a) { return squareRoot(squaredLength(a)); }
/// In the order of additions that Eigen has.
inline Several dots(const SeveralVectors& a, const double* b) {
  return a.axis[0] * b[0] + (a.axis[1] * b[1] + a.axis[2] * b[2]);
}

/// A cubic's value, and its derivative over 3, as bezier::cubic computes them.
template <typename Numbers>
inline void cubicAt(const Numbers& a, const Numbers& b, const Numbers& c, const Numbers& d,
                    const Several& t, Several& value, Several& third) {
  const Numbers ab = b - a, bc = c - b, cd = d - c;
  const Several abc = ab + t * (bc - ab), bcd = bc + t * (cd - bc);
  third = abc + t * (bcd - abc);
  const Several p = a + t * ab, q = b + t * bc, r = c + t * cd;
  const Several pq = p + t * (q - p), qr = q + t * (r - q);
  value = pq + t * (qr - pq);
}
inline Several cubicAt(const Several& a, const Several& b, const Several& c, const Several& d,
                       const Several& t) {
  const Several p = a + t * (b - a), q = b + t * (c - b), r = c + t * (d - c);
  const Several pq = p + t * (q - p), qr = q + t * (r - q);
  return pq + t * (qr - pq);
}

/// The position and both derivatives at several places, as BezierPatch::evaluate computes them.
struct SeveralPoints {
  SeveralVectors position, ds, dt;

  SeveralPoints(const BezierPatch& patch, const Several& s, const Several& t) {
    const double* const points = reinterpret_cast<const double*>(patch.points);
    const double* const anchor = reinterpret_cast<const double*>(&patch.anchor);
    for (int i = 0; i < 3; ++i) {
      Several row[4], row_third[4], value, third;
      for (int y = 0; y < 4; ++y) {
        const double* p = points + 16 * y + i;
        cubicAt(p[0], p[4], p[8], p[12], s, row[y], row_third[y]);
        row_third[y] = 3 * row_third[y];
      }
      cubicAt(row[0], row[1], row[2], row[3], t, value, third);
      position.axis[i] = value + anchor[i];
      dt.axis[i] = 3 * third;
      ds.axis[i] = cubicAt(row_third[0], row_third[1], row_third[2], row_third[3], t);
    }
  }
};

inline void places(const BezierPatch& patch, PlaceBlock& block) {
  for (int first = 0; first < PlaceBlock::kCount; first += kLanes) {
    const SeveralPoints at(patch, Several::load(block.s + first), Several::load(block.t + first));
    store(at.position, block.position, first);
    const SeveralVectors normal = crossProduct(at.ds, at.dt);
    const Several area = lengths(normal);
    area.store(block.area + first);
    for (int i = 0; i < 3; ++i) {
      (normal.axis[i] / area).store(block.normal[i] + first);
    }
  }
}

inline void extents(const BezierPatch& patch, const DerivativeBounds& bounds, ExtentBlock& block) {
  for (int first = 0; first < ExtentBlock::kCount; first += kLanes) {
    const SeveralPoints at(patch, Several::load(block.s + first), Several::load(block.t + first));
    store(at.position, block.middle, first);
    const SeveralVectors normal = crossProduct(at.ds, at.dt);
    store(normal, block.normal, first);
    lengths(normal).store(block.normal_length + first);
    const Several a = Several::load(block.half_width + first);
    const Several b = Several::load(block.half_height + first);
    const SeveralVectors s = a * at.ds, t = b * at.dt;
    store(s, block.half_s, first);
    store(t, block.half_t, first);
    const Several aa = a * a * 0.5, ab = a * b, bb = b * b * 0.5, half_ab = ab * 0.5;
    // The second derivatives count as well: ds may vanish in the middle and be large elsewhere.
    (lengths(s) + aa * bounds.dss + half_ab * bounds.dst).store(block.along_s + first);
    (lengths(t) + bb * bounds.dtt + half_ab * bounds.dst).store(block.along_t + first);
    (aa * bounds.dss + ab * bounds.dst + bb * bounds.dtt).store(block.bend + first);
    squareRoot(Several::larger(squaredLength(s + t), squaredLength(s - t)))
        .store(block.corner + first);
    (a * (bounds.dss * bounds.dt + bounds.ds * bounds.dst) +
     b * (bounds.dst * bounds.dt + bounds.ds * bounds.dtt))
        .store(block.normal_reach + first);
  }
}

/// Whether any of the numbers is above 0.
inline bool anyPositive(const Several& a) {
  double numbers[kLanes];
  a.store(numbers);
  bool found = false;
  for (const double number : numbers) {
    found |= number > 0;
  }
  return found;
}

/// Below, a condition is a number that is above 0 where it holds; the smaller one of two such
/// numbers stands for both.
inline bool conflict(const DiscBlock* blocks, std::size_t count, const NoiseDisc& own,
                     double number) {
  const double* const position = reinterpret_cast<const double*>(&own.position);
  const double* const normal = reinterpret_cast<const double*>(&own.normal);
  for (const DiscBlock* block = blocks; block != blocks + count; ++block) {
    for (int first = 0; first < DiscBlock::kCount; first += kLanes) {
      SeveralVectors off = load(block->position, first);
      for (int i = 0; i < 3; ++i) {
        off.axis[i] = off.axis[i] - position[i];
      }
      const Several reach = (Several::load(block->radius + first) + own.radius) * 0.5;
      const Several is_close = reach * reach - squaredLength(off);
      const Several faces = dots(load(block->normal, first), normal) - kRightAngle;
      const Several is_before =
          Several::unlessZero(Several::of(own.rank) - Several::load(block->rank + first),
                              Several::of(number) - Several::load(block->number + first));
      if (anyPositive(Several::smaller(Several::smaller(is_close, faces), is_before))) {
        return true;
      }
    }
  }
  return false;
}

inline unsigned covered(const DiscBlock* blocks, std::size_t count, const CellParts& parts) {
  Several best[CellParts::kMost];
  for (Several& condition : best) {
    condition = Several::of(0);
  }
  for (const DiscBlock* block = blocks; block != blocks + count; ++block) {
    for (int first = 0; first < DiscBlock::kCount; first += kLanes) {
      const Several faces =
          (dots(load(block->normal, first), parts.normal) - parts.normal_reach) - parts.least;
      const SeveralVectors position = load(block->position, first);
      const Several reach = (Several::load(block->radius + first) + parts.smallest) * 0.5;
      for (int part = 0; part < parts.count; ++part) {
        SeveralVectors off;
        for (int i = 0; i < 3; ++i) {
          off.axis[i] = position.axis[i] - parts.middle[i][part];
        }
        const Several rest = reach - parts.reach[part];
        const Several is_inside = Several::smaller(rest, rest * rest - squaredLength(off));
        best[part] = Several::larger(best[part], Several::smaller(is_inside, faces));
      }
    }
  }
  unsigned result = 0;
  for (int part = 0; part < parts.count; ++part) {
    result |= (anyPositive(best[part]) ? 1u : 0u) << part;
  }
  return result;
}

constexpr NoiseKernels kKernels = {places, extents, conflict, covered};
