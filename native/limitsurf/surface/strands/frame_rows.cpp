// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/frame_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "limitsurf/direction_maps.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/parallel.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/differential.h"

namespace limitsurf {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Frame = Eigen::Map<const Matrix>;

/// Rows of one task: some nanoseconds each.
constexpr std::size_t kFramesPerTask = 2048;
/// Points of one strand between two passes of the interruption point.
constexpr int kPointsBetweenPasses = 1 << 16;

template <typename Body>
void forEachRow(Eigen::Index rows, int threads, const Body& body) {
  checkThreads(threads);
  parallelFor(static_cast<std::size_t>(rows), kFramesPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t row = begin; row < end; ++row) {
                  body(static_cast<Eigen::Index>(row));
                }
              });
}

/// The quaternion times four times one of its own components: the largest one, so that no digits
/// cancel.
Eigen::Vector4d scaledQuaternion(const Frame& r) {
  const double four[4] = {1 + r(0, 0) + r(1, 1) + r(2, 2), 1 + r(0, 0) - r(1, 1) - r(2, 2),
                          1 - r(0, 0) + r(1, 1) - r(2, 2), 1 - r(0, 0) - r(1, 1) + r(2, 2)};
  int largest = 0;
  for (int i = 1; i < 4; ++i) {
    if (four[i] > four[largest]) {
      largest = i;
    }
  }
  if (largest == 0) {
    return {four[0], r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
  }
  const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
  Eigen::Vector4d q;
  q[0] = r(k, j) - r(j, k);
  q[i + 1] = four[largest];
  q[j + 1] = r(j, i) + r(i, j);
  q[k + 1] = r(k, i) + r(i, k);
  return q[0] < 0 ? Eigen::Vector4d(-q) : q;
}

}  // namespace

Quaternions quaternionsOf(const Eigen::Ref<const Rotations>& rotations, int threads) {
  Quaternions result(rotations.rows(), 4);
  forEachRow(rotations.rows(), threads, [&](Eigen::Index row) {
    const Frame rotation(rotations.row(row).data());
    if (!rotation.allFinite()) {
      result.row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
    } else {
      result.row(row) = scaledQuaternion(rotation).normalized();
    }
  });
  return result;
}

Rotations framesInWorld(const Eigen::Ref<const Rotations>& frames, const Eigen::Matrix3d& linear,
                        int threads) {
  const DirectionMaps maps(linear);
  Rotations result(frames.rows(), 9);
  forEachRow(frames.rows(), threads, [&](Eigen::Index row) {
    const Frame frame(frames.row(row).data());
    const Vector3 tangent = unitDirection(maps.vectors * frame.col(0));
    const Vector3 normal = unitDirection(maps.normals * frame.col(2));
    Eigen::Map<Matrix> world(result.row(row).data());
    world.col(0) = tangent;
    world.col(1) = maps.side * normal.cross(tangent);
    world.col(2) = normal;
  });
  return result;
}

Points leaning(const Eigen::Ref<const Rotations>& frames, const Eigen::Ref<const Pairs>& angles,
               int threads) {
  checkRows("angles", angles.rows(), frames.rows(), "frames");
  Points result(frames.rows(), 3);
  forEachRow(frames.rows(), threads, [&](Eigen::Index row) {
    const Frame frame(frames.row(row).data());
    const Eigen::Vector2d lean = angles.row(row);
    const double angle = std::hypot(lean[0], lean[1]);  // squares of large angles overflow
    const double sine_part = angle > 0 ? std::sin(angle) / angle : 1;
    const Vector3 sideways = frame.leftCols<2>() * lean;
    result.row(row) = std::cos(angle) * frame.col(2) + sine_part * sideways;
  });
  return result;
}

FloatPoints straightStrands(const Eigen::Ref<const Points>& roots,
                            const Eigen::Ref<const Points>& along, int points, int threads) {
  FloatPoints result(points < 1 ? 0 : roots.rows() * points, 3);
  straightStrands(roots, along, points, Eigen::Map<FloatPoints>(result.data(), result.rows(), 3),
                  threads);
  return result;
}

void straightStrands(const Eigen::Ref<const Points>& roots, const Eigen::Ref<const Points>& along,
                     int points, Eigen::Map<FloatPoints> strands, int threads) {
  checkRows("along", along.rows(), roots.rows(), "roots");
  if (points < 1) {
    throw std::invalid_argument("points is " + std::to_string(points) + "; expected 1 or more");
  }
  checkRows("strands", strands.rows(), roots.rows() * points);
  forEachRow(roots.rows(), threads, [&](Eigen::Index row) {
    const Eigen::RowVector3d root = roots.row(row), whole = along.row(row);
    for (int begin = 0; begin < points;) {
      const int end = begin + std::min(points - begin, kPointsBetweenPasses);
      for (int point = begin; point < end; ++point) {
        const double step = points == 1 ? 0 : static_cast<double>(point) / (points - 1);
        strands.row(row * points + point) = (root + step * whole).cast<float>();
      }
      begin = end;
      if (begin < points) {  // a strand may have a billion of them
        InterruptionPoint::pass();
      }
    }
  });
}

}  // namespace limitsurf
