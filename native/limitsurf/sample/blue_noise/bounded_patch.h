// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/blue_noise/noise_kernels.h"
#include "limitsurf/sample/blue_noise/trial_cell.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A bound on the normals of a part of the surface.
struct NormalBound {
  Vector3 normal;
  double normal_length;
  double normal_reach;  ///< ds x dt differs by at most this from `normal`

  /// Whether the angle between `unit`, a unit vector, and every normal of the part is below 90
  /// degrees.
  bool facesAll(const Vector3& unit) const {
    return unit.dot(normal) - normal_reach > leastFacing();
  }
  double leastFacing() const { return kRightAngle * (normal_length + normal_reach); }
};

/// Bounds on the surface over a whole cell. The normal is the middle's.
struct CellExtent : NormalBound {
  Vector3 middle;
  double along_s, along_t;  ///< the parts of the reach that s and t contribute
  Vector3 half_s, half_t;   ///< from the middle to that of a side, where the cell is flat
  double corner;            ///< from the middle to the farthest corner, where the cell is flat
  double bend;              ///< no point is farther from where it were then

  /// No point of the cell is farther from the middle.
  double reach() const { return corner + bend; }

  /// How far the corner of a parallelogram is from its middle.
  static double cornerReach(const Vector3& s, const Vector3& t) {
    return std::max(length(Vector3(s + t)), length(Vector3(s - t)));
  }

  /// The cell itself, as something that discs may cover. Its parts can be added.
  CellParts parts(double smallest) const {
    CellParts parts;
    parts.smallest = smallest;
    for (int axis = 0; axis < 3; ++axis) {
      parts.normal[axis] = normal[axis];
    }
    parts.normal_reach = normal_reach;
    parts.least = leastFacing();
    parts.add(middle, reach());
    return parts;
  }
};

/// The vectors ds x dt of a cell in which they may vanish or turn over: in parts along an axis,
/// along which they change most, and beside it.
///
/// Where a flat surface folds over, ds x dt passes through 0 from one direction to the opposite
/// one. No disc sees both directions, so that no disc covers a cell on the fold, however small it
/// is. Discs on the two sheets together, however, may see all of it, or all but a strip along the
/// fold.
struct TurningNormals {
  Vector3 axis;      ///< a unit vector
  double low, high;  ///< bounds on the part along the axis
  Vector3 beside;    ///< the part beside the axis in the middle of the cell
  double spread;     ///< elsewhere it differs from that by at most this
  /// The places at which the part along the axis lies between two numbers are a strip whose width
  /// is at most this times their difference. Infinite if nothing is known.
  double width;

  /// The number above which the part along `unit`, the axis or its opposite, has to be for a disc
  /// to see the place. `unit` is the one of them that the disc's normal is closer to. May be
  /// infinite.
  double seenAbove(const Vector3& normal, const Vector3& unit) const {
    const double along = normal.dot(unit);
    if (!(along > kRightAngle)) {
      return std::numeric_limits<double>::infinity();
    }
    // normal . (ds x dt) is at least along z + others, where z is the part along `unit`, and the
    // length of ds x dt is at most |z| + largest.
    const double others = normal.dot(beside) - spread * std::sqrt(std::max(0., 1 - along * along));
    const double largest = length(beside) + spread;
    const double rest = kRightAngle * largest - others;
    return rest / (rest > 0 ? along - kRightAngle : along + kRightAngle);
  }
};

/// A patch with bounds on its derivatives.
class BoundedPatch {
 public:
  /// |ds x dt| relative to bounds on |ds| and |dt|, below which cancellation leaves no correct
  /// digits: some thousand times the rounding of the products. Chosen, not derived.
  static constexpr double kCrossRounding = 1e-12;

  explicit BoundedPatch(const BezierPatch& patch) : patch_(patch) {
    const BezierPatch::Point* p = patch.points;
    const auto raise = [](double& bound, const BezierPatch::Point& a) {
      bound = std::max(bound, a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    };
    DerivativeBounds squared;
    for (int i = 0; i < 16; ++i) {
      const bool has_s = i % 4 < 3, has_t = i < 12;
      if (has_s) {
        raise(squared.ds, p[i + 1] - p[i]);
      }
      if (has_t) {
        raise(squared.dt, p[i + 4] - p[i]);
      }
      if (i % 4 < 2) {
        raise(squared.dss, (p[i + 2] - p[i + 1]) - (p[i + 1] - p[i]));
      }
      if (i < 8) {
        raise(squared.dtt, (p[i + 8] - p[i + 4]) - (p[i + 4] - p[i]));
      }
      if (has_s && has_t) {
        raise(squared.dst, (p[i + 5] - p[i + 4]) - (p[i + 1] - p[i]));
      }
    }
    bounds_ = {3 * std::sqrt(squared.ds), 3 * std::sqrt(squared.dt), 6 * std::sqrt(squared.dss),
               9 * std::sqrt(squared.dst), 6 * std::sqrt(squared.dtt)};
  }

  const BezierPatch& patch() const { return patch_; }

  FaceRectangle rectangle(const TrialCell& cell) const {
    return patch_.on.part(cell.column * cell.width(), cell.row * cell.height(), cell.width(),
                          cell.height());
  }

  /// Whether an |ds x dt| of this size is nothing but rounding errors.
  bool vanishes(double area) const { return !(area > kCrossRounding * bounds_.ds * bounds_.dt); }
  /// Whether |ds x dt| is nothing but rounding errors on the whole cell.
  bool vanishes(const CellExtent& extent) const {
    return vanishes(extent.normal_length + extent.normal_reach);
  }

  /// Whether ds x dt may vanish in the cell. Then one disc is never known to face all of it.
  static bool mayTurnOver(const CellExtent& extent) {
    return extent.normal_reach >= extent.normal_length;
  }
  /// Tighter bounds for such a cell.
  TurningNormals turningNormals(const TrialCell& cell) const {
    const double a = cell.width() / 2, b = cell.height() / 2;
    BezierPatch::Values at;
    patch_.evaluate<2>((2. * cell.column + 1) * a, (2. * cell.row + 1) * b, at);
    const Vector3 normal = cross(at.ds, at.dt);
    const Vector3 along_s = a * (cross(at.dss, at.dt) + cross(at.ds, at.dst)),
                  along_t = b * (cross(at.dst, at.dt) + cross(at.ds, at.dtt));
    const double s_length = length(along_s), t_length = length(along_t);
    const AreaForm::SecondBounds& second = secondSlopes();
    const double bend = (a * a * second.ss + b * b * second.tt) / 2 + a * b * second.st +
                        kCrossRounding * bounds_.ds * bounds_.dt;
    TurningNormals result;
    result.axis = s_length > t_length ? Vector3(along_s / s_length) : Vector3(along_t / t_length);
    const auto beside = [&](const Vector3& v) {
      return Vector3(v - v.dot(result.axis) * result.axis);
    };
    const double middle = normal.dot(result.axis), s_part = std::abs(along_s.dot(result.axis)),
                 t_part = std::abs(along_t.dot(result.axis));
    result.low = middle - s_part - t_part - bend;
    result.high = middle + s_part + t_part + bend;
    result.beside = beside(normal);
    result.spread = length(beside(along_s)) + length(beside(along_t)) + bend;
    // The part along the axis changes by at least so much over half the width, or half the height.
    const double s_least = s_part - a * (a * second.ss + b * second.st),
                 t_least = t_part - b * (a * second.st + b * second.tt);
    const double s_reach = a * (length(at.ds) + a * bounds_.dss + b * bounds_.dst),
                 t_reach = b * (length(at.dt) + a * bounds_.dst + b * bounds_.dtt);
    result.width = std::numeric_limits<double>::infinity();
    if (s_least > 0) {
      result.width = s_reach / s_least;
    }
    if (t_least > 0) {
      result.width = std::min(result.width, t_reach / t_least);
    }
    return result;
  }

  /// Computes bounds from the derivatives in the middles of the block's rectangles and from bounds
  /// on how far they change.
  void findExtents(ExtentBlock& block) const {
    NoiseKernels::get().extents(patch_, bounds_, block);
  }
  /// One of them.
  CellExtent extent(const ExtentBlock& block, int place) const {
    const auto vector = [&](const double (&from)[3][ExtentBlock::kCount]) {
      return Vector3(from[0][place], from[1][place], from[2][place]);
    };
    CellExtent result;
    result.middle = vector(block.middle);
    result.normal = vector(block.normal);
    result.half_s = vector(block.half_s);
    result.half_t = vector(block.half_t);
    result.along_s = block.along_s[place];
    result.along_t = block.along_t[place];
    result.bend = block.bend[place];
    result.corner = block.corner[place];
    result.normal_length = block.normal_length[place];
    result.normal_reach = block.normal_reach[place];
    if (result.normal_reach > kLoose * result.normal_length) {
      const Slopes& slopes = normalSlopes();
      result.normal_reach =
          block.half_width[place] * slopes.along_s + block.half_height[place] * slopes.along_t;
    }
    return result;
  }

 private:
  /// Bounds on the derivatives of ds x dt.
  struct Slopes {
    double along_s, along_t;
  };
  /// Products of the bounds on derivatives are cheaper than the derivatives of ds x dt itself. They
  /// serve as long as they prove that ds x dt changes by no more than this part of its length.
  static constexpr double kLoose = 0.25;
  const Slopes& normalSlopes() const {
    if (!slopes_) {
      const AreaForm form(patch_);
      slopes_ = Slopes{form.derivativeBound(false), form.derivativeBound(true)};
    }
    return *slopes_;
  }
  const AreaForm::SecondBounds& secondSlopes() const {
    if (!second_slopes_) {
      second_slopes_ = AreaForm(patch_).secondDerivativeBounds();
    }
    return *second_slopes_;
  }

  BezierPatch patch_;
  mutable std::optional<Slopes> slopes_;
  mutable std::optional<AreaForm::SecondBounds> second_slopes_;
  DerivativeBounds bounds_;
};

}  // namespace limitsurf
