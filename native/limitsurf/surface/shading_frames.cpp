// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/shading_frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/interruption_point.h"
#include "limitsurf/own_unit.h"
#include "limitsurf/row_check.h"

namespace limitsurf {
namespace {

void checkFrames(const ShadingFrames& frames, Eigen::Index rows) {
  checkRows("normals", frames.normal.rows(), rows, "vectors");
  checkRows("tangents", frames.tangent.rows(), rows, "vectors");
  checkRows("signs", frames.sign.rows(), rows, "vectors");
}

/// Columns tangent, bitangent, normal.
Eigen::Matrix3d frameOf(const ShadingFrames& frames, Eigen::Index row) {
  Eigen::Matrix3d frame;
  frame.col(0) = frames.tangent.row(row).transpose();
  frame.col(2) = frames.normal.row(row).transpose();
  frame.col(1) = frames.sign(row) * frame.col(2).cross(frame.col(0));
  return frame;
}

/// Whether two sizes of products of lengths have neither lost digits to underflow nor overflowed,
/// and are numbers. (The sum is NaN if one of them is.)
bool areSafe(double a, double b) {
  constexpr double kLeast = 1e-140, kMost = 1e140;
  return std::min(a, b) > kLeast && a + b < kMost;
}

/// A vector that stands for `numbers` times 2^exponents: times a power of two that leaves its
/// largest component between 1 and 2.
Vector3 inOwnUnit(const Vector3& numbers, const Eigen::Array3i& exponents) {
  int largest = std::numeric_limits<int>::min();
  for (int i = 0; i < 3; ++i) {
    if (numbers[i] != 0 && std::isfinite(numbers[i])) {
      largest = std::max(largest, std::ilogb(numbers[i]) + exponents[i]);
    }
  }
  Vector3 result = numbers;
  if (largest > std::numeric_limits<int>::min()) {
    for (int i = 0; i < 3; ++i) {
      result[i] = std::ldexp(numbers[i], exponents[i] - largest);
    }
  }
  return result;
}

/// A frame whose columns have units of their own: column i of the frame itself is that of `columns`
/// times 2^exponents[i]. With these, frames of all sizes are as exact as others. Most frames need
/// none, and are looked at without, because making units takes as long as all else.
struct FrameInUnits {
  FrameInUnits(const ShadingFrames& frames, Eigen::Index row) {
    const Vector3 tangent = frames.tangent.row(row), normal = frames.normal.row(row);
    const int of_tangent = exponentOf(tangent.cwiseAbs().maxCoeff()),
              of_normal = exponentOf(normal.cwiseAbs().maxCoeff()),
              of_sign = exponentOf(std::abs(frames.sign(row)));
    const auto inUnit = [](const Vector3& v, int exponent) {
      return Vector3(std::ldexp(v[0], -exponent), std::ldexp(v[1], -exponent),
                     std::ldexp(v[2], -exponent));
    };
    columns.col(0) = inUnit(tangent, of_tangent);
    columns.col(2) = inUnit(normal, of_normal);
    columns.col(1) = std::ldexp(frames.sign(row), -of_sign) * columns.col(2).cross(columns.col(0));
    exponents << of_tangent, of_tangent + of_normal + of_sign, of_normal;
  }

  Eigen::Matrix3d columns;
  Eigen::Array3i exponents;
};

/// The components of a direction in a frame, times the size of its determinant.
[[gnu::always_inline]] inline Vector3 scaledComponents(const Eigen::Matrix3d& frame,
                                                       double determinant,
                                                       const Vector3& direction) {
  return std::copysign(1.0, determinant) * Vector3(frame.col(1).cross(frame.col(2)).dot(direction),
                                                   frame.col(2).cross(frame.col(0)).dot(direction),
                                                   frame.col(0).cross(frame.col(1)).dot(direction));
}

/// intoShadingFrames() for sizes of all kinds.
Vector3 componentsInUnits(const FrameInUnits& frame, const Vector3& given) {
  const Vector3 direction = inOwnUnit(given, Eigen::Array3i::Zero());
  const double volume = frame.columns.determinant();
  const Vector3 found =
      inOwnUnit(scaledComponents(frame.columns, volume, direction), -frame.exponents);
  const double length = found.norm();
  return volume != 0 && length > 0 ? Vector3(found / length) : Vector3(Vector3::UnitZ());
}

/// outOfShadingFrames() for sizes of all kinds.
Vector3 directionInUnits(const FrameInUnits& frame, const Vector3& components) {
  const Vector3 sum = frame.columns * inOwnUnit(components, frame.exponents);
  const Vector3 found = inOwnUnit(sum, Eigen::Array3i::Zero());
  const double length = found.norm();
  return length > 0 ? Vector3(found / length)
                    : Vector3(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace

Points intoShadingFrames(const Points& directions, const ShadingFrames& frames) {
  checkFrames(frames, directions.rows());
  Points out(directions.rows(), 3);
  std::vector<Eigen::Index> others;
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    stride.step();
    const Eigen::Matrix3d frame = frameOf(frames, row);
    const double volume = frame.determinant();
    const Vector3 found = scaledComponents(frame, volume, directions.row(row).transpose());
    const double square = found.squaredNorm();
    if (areSafe(square, std::abs(volume))) {
      out.row(row) = found / std::sqrt(square);
    } else {
      others.push_back(row);
    }
  }
  for (const Eigen::Index row : others) {
    stride.step();
    out.row(row) = componentsInUnits(FrameInUnits(frames, row), directions.row(row));
  }
  return out;
}

Points outOfShadingFrames(const Points& components, const ShadingFrames& frames) {
  checkFrames(frames, components.rows());
  Points out(components.rows(), 3);
  std::vector<Eigen::Index> others;
  InterruptionStride stride;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    stride.step();
    const Eigen::Matrix3d frame = frameOf(frames, row);
    const Vector3 found = frame * components.row(row).transpose();
    const double square = found.squaredNorm();
    if (areSafe(square, frame.col(1).squaredNorm())) {
      out.row(row) = found / std::sqrt(square);
    } else {
      others.push_back(row);
    }
  }
  for (const Eigen::Index row : others) {
    stride.step();
    out.row(row) = directionInUnits(FrameInUnits(frames, row), components.row(row));
  }
  return out;
}

}  // namespace limitsurf
