// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/trial_cell.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Two points see each other if the angle between their unit normals is less than 90 degrees. A
/// scalar product up to this constant counts as 90 degrees, because of its rounding.
constexpr double kRightAngle = 1e-9;
inline bool seeEachOther(const Vector3& a, const Vector3& b) { return a.dot(b) > kRightAngle; }

/// A bound on the normals of a part of the surface.
struct NormalBound {
  Vector3 normal;
  double normal_reach;  ///< ds x dt differs by at most this from `normal`

  /// Whether the angle between `unit`, a unit vector, and every normal of the part is below 90
  /// degrees.
  bool facesAll(const Vector3& unit) const {
    return unit.dot(normal) - normal_reach > kRightAngle * (length(normal) + normal_reach);
  }
};

/// Bounds on the surface over a whole cell. The normal is the middle's.
struct CellExtent : NormalBound {
  Vector3 middle;
  double reach;                       ///< no point of the cell is farther from the middle
  double along_s, along_t;            ///< the parts of the reach that s and t contribute
  BezierPatch::Point half_s, half_t;  ///< from the middle to that of a side, where the cell is flat
  double bend;                        ///< no point is farther from where it were then

  /// How far the corner of a parallelogram is from its middle.
  static double cornerReach(const BezierPatch::Point& s, const BezierPatch::Point& t) {
    return std::max(length(BezierPatch::Point(s + t)), length(BezierPatch::Point(s - t)));
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
    for (int i = 0; i < 16; ++i) {
      const bool has_s = i % 4 < 3, has_t = i < 12;
      if (has_s) {
        raise(ds_, 3 * length(BezierPatch::Point(p[i + 1] - p[i])));
      }
      if (has_t) {
        raise(dt_, 3 * length(BezierPatch::Point(p[i + 4] - p[i])));
      }
      if (i % 4 < 2) {
        raise(dss_, 6 * length(BezierPatch::Point((p[i + 2] - p[i + 1]) - (p[i + 1] - p[i]))));
      }
      if (i < 8) {
        raise(dtt_, 6 * length(BezierPatch::Point((p[i + 8] - p[i + 4]) - (p[i + 4] - p[i]))));
      }
      if (has_s && has_t) {
        raise(dst_, 9 * length(BezierPatch::Point((p[i + 5] - p[i + 4]) - (p[i + 1] - p[i]))));
      }
    }
  }

  const BezierPatch& patch() const { return patch_; }

  FaceRectangle rectangle(const TrialCell& cell) const {
    return patch_.on.part(cell.column * cell.width(), cell.row * cell.height(), cell.width(),
                          cell.height());
  }

  /// The position at (s, t), and ds x dt there.
  void evaluate(double s, double t, Vector3& position, Vector3& normal) const {
    BezierPatch::Values values;
    patch_.evaluate<1>(s, t, values);
    position = (values.value + patch_.anchor).head<3>().matrix();
    normal = cross(values.ds, values.dt);
  }
  /// Whether an |ds x dt| of this size is nothing but rounding errors.
  bool vanishes(double area) const { return !(area > kCrossRounding * ds_ * dt_); }
  /// Whether |ds x dt| is nothing but rounding errors on the whole cell.
  bool vanishes(const CellExtent& extent) const {
    return vanishes(length(extent.normal) + extent.normal_reach);
  }

  /// Computed from the derivatives in the cell's middle and bounds on how far they change.
  CellExtent extent(const TrialCell& cell) const {
    const double a = cell.width() / 2, b = cell.height() / 2;
    BezierPatch::Values values;
    patch_.evaluate<1>((2. * cell.column + 1) * a, (2. * cell.row + 1) * b, values);
    CellExtent result;
    result.middle = (values.value + patch_.anchor).head<3>().matrix();
    result.normal = cross(values.ds, values.dt);
    const BezierPatch::Point s = a * values.ds, t = b * values.dt;
    // The second derivatives count as well: ds may vanish in the middle and be large elsewhere.
    result.along_s = length(s) + a * a / 2 * dss_ + a * b / 2 * dst_;
    result.along_t = length(t) + b * b / 2 * dtt_ + a * b / 2 * dst_;
    result.half_s = s;
    result.half_t = t;
    result.bend = a * a / 2 * dss_ + a * b * dst_ + b * b / 2 * dtt_;
    result.reach = CellExtent::cornerReach(s, t) + result.bend;
    result.normal_reach = a * (dss_ * dt_ + ds_ * dst_) + b * (dst_ * dt_ + ds_ * dtt_);
    if (result.normal_reach > kLoose * length(result.normal)) {
      const Slopes& slopes = normalSlopes();
      result.normal_reach = a * slopes.along_s + b * slopes.along_t;
    }
    return result;
  }

 private:
  static void raise(double& bound, double value) { bound = std::max(bound, value); }

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

  BezierPatch patch_;
  mutable std::optional<Slopes> slopes_;
  double ds_ = 0, dt_ = 0, dss_ = 0, dst_ = 0, dtt_ = 0;
};

}  // namespace limitsurf
