// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "limitsurf/random_bits.h"
#include "limitsurf/sample/area_form.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// Normals of unit length whose product is not above it do not see each other: they are 90 degrees
/// apart or more, rounding aside.
constexpr double kRightAngle = 1e-9;
inline bool seeEachOther(const Vector3& a, const Vector3& b) { return a.dot(b) > kRightAngle; }

/// A part of the surface in which a dart may still find a place: a dyadic rectangle of a patch, or
/// a core.
struct DartCell {
  SurfacePiece piece;
  std::uint32_t column = 0, row = 0;  ///< of 2^level each
  std::uint8_t s_level = 0, t_level = 0;

  static constexpr int kMostLevels = 31;

  double width() const { return 1. / (std::uint32_t{1} << s_level); }
  double height() const { return 1. / (std::uint32_t{1} << t_level); }

  /// Halves along s (0 or 1) and along t.
  DartCell halfOfS(unsigned which) const {
    DartCell half = *this;
    ++half.s_level;
    half.column = 2 * column + which;
    return half;
  }
  DartCell halfOfT(unsigned which) const {
    DartCell half = *this;
    ++half.t_level;
    half.row = 2 * row + which;
    return half;
  }

  /// Random bits of its own.
  std::uint64_t bits(std::uint64_t key) const {
    const auto join = [](std::uint64_t high, std::uint32_t low) { return high << 32 | low; };
    const std::uint32_t part =
        static_cast<std::uint32_t>(piece.steps) << 16 | static_cast<std::uint16_t>(piece.part);
    key = mixed(key ^ mixed(join(static_cast<std::uint32_t>(piece.tile), part)));
    key = mixed(key ^ mixed(join(column, row)));
    return mixed(key ^ static_cast<std::uint64_t>(s_level << 8 | t_level));
  }
};

/// What is known of the surface on a whole cell.
struct CellExtent {
  Vector3 middle;
  double reach;  ///< nothing is farther from the middle
  Vector3 normal;
  double normal_reach;      ///< no ds x dt is farther from this one, of the middle
  double along_s, along_t;  ///< how much of the reach comes from s and from t

  /// Whether all normals are less than 90 degrees from this one, of unit length.
  bool facesAll(const Vector3& unit) const {
    return unit.dot(normal) - normal_reach > kRightAngle * (length(normal) + normal_reach);
  }
};

/// A patch, with bounds on its derivatives.
class BoundedPatch {
 public:
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

  FaceRectangle rectangle(const DartCell& cell) const {
    return patch_.on.part(cell.column * cell.width(), cell.row * cell.height(), cell.width(),
                          cell.height());
  }

  /// A place on the surface; ds x dt.
  void evaluate(double s, double t, Vector3& position, Vector3& normal) const {
    BezierPatch::Values values;
    patch_.evaluate<1>(s, t, values);
    position = (values.value + patch_.anchor).head<3>().matrix();
    normal = cross(values.ds, values.dt);
  }
  /// Whether ds x dt is no more than rounding errors.
  bool vanishes(double area) const { return !(area > 1e-12 * ds_ * dt_); }
  /// On all of a cell.
  bool vanishes(const CellExtent& extent) const {
    return vanishes(length(extent.normal) + extent.normal_reach);
  }

  /// By the derivatives in its middle, and bounds on how far they change.
  CellExtent extent(const DartCell& cell) const {
    const double a = cell.width() / 2, b = cell.height() / 2;
    BezierPatch::Values values;
    patch_.evaluate<1>((2. * cell.column + 1) * a, (2. * cell.row + 1) * b, values);
    CellExtent result;
    result.middle = (values.value + patch_.anchor).head<3>().matrix();
    result.normal = cross(values.ds, values.dt);
    const BezierPatch::Point s = a * values.ds, t = b * values.dt;
    // Where ds vanishes in the middle it may be large elsewhere.
    result.along_s = length(s) + a * a / 2 * dss_ + a * b / 2 * dst_;
    result.along_t = length(t) + b * b / 2 * dtt_ + a * b / 2 * dst_;
    const double corner =
        std::max(length(BezierPatch::Point(s + t)), length(BezierPatch::Point(s - t)));
    result.reach = corner + a * a / 2 * dss_ + a * b * dst_ + b * b / 2 * dtt_;
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
  /// Products of bounds are quicker than ds x dt's own form: they do where they say that it changes
  /// by no more than this part.
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
