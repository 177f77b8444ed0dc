// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/child_strands.h"

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/own_unit.h"
#include "limitsurf/parallel.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/strands/strand_offsets.h"
#include "limitsurf/surface/strands/strand_turns.h"

namespace limitsurf {
namespace {

constexpr std::size_t kStrandsPerTask = 64;
constexpr std::size_t kStrandsPerPart = std::size_t{1} << 15;

using Strand = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using StrandRef = Eigen::Ref<const Strand, 0, Eigen::OuterStride<3>>;

/// The length of a strand whose coordinates are multiplied by `scale`.
double lengthOf(const StrandRef& points, double scale = 1) {
  double length = 0;
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    length += (scale * points.row(i) - scale * points.row(i - 1)).norm();
  }
  return length;
}

void checkOffsets(const std::vector<std::int64_t>& offsets, Eigen::Index points) {
  if (offsets.empty() || offsets.front() != 0 || offsets.back() != points) {
    throw std::invalid_argument("offsets must begin with 0 and end with the number of points, " +
                                std::to_string(points));
  }
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    if (offsets[i] <= offsets[i - 1]) {
      throw std::invalid_argument("offsets: strand " + std::to_string(i - 1) + " has no points");
    }
  }
}

void resample(const StrandRef& from, Eigen::Ref<Strand, 0, Eigen::OuterStride<3>> to) {
  // Squares of large and of small coordinates would overflow and vanish.
  const double scale = scaleToOwnUnit(from.cwiseAbs().maxCoeff());
  const double step = lengthOf(from, scale) / static_cast<double>(to.rows() - 1);
  to.row(0) = from.row(0);
  double passed = 0;  // the length before the segment
  Eigen::Index segment = 0;
  for (Eigen::Index i = 1; i + 1 < to.rows(); ++i) {
    const double wanted = step * static_cast<double>(i);
    double length = 0;
    while (segment + 1 < from.rows()) {
      length = (scale * from.row(segment + 1) - scale * from.row(segment)).norm();
      if (passed + length >= wanted || segment + 2 == from.rows()) {
        break;
      }
      passed += length;
      ++segment;
    }
    const double part = length > 0 ? std::clamp((wanted - passed) / length, 0., 1.) : 0;
    const Eigen::Index next = std::min(segment + 1, from.rows() - 1);
    to.row(i) = (1 - part) * from.row(segment) + part * from.row(next);
  }
  to.row(to.rows() - 1) = from.row(from.rows() - 1);
}

void check(const GuideStrands& guides, const ChildRoots& children) {
  if (guides.points_per_strand < 2) {
    throw std::invalid_argument("guide_points has " + std::to_string(guides.points_per_strand) +
                                " points for each guide; expected 2 or more");
  }
  const Eigen::Index count = guides.normals.rows(), rows = children.position.rows();
  checkRows("guide_normals", count, guides.points.rows() / guides.points_per_strand,
            "guide_points");
  checkRows("normals", children.normal.rows(), rows, "roots");
  const auto size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(children.guides);
  if (children.guide.size() != size || children.weight.size() != size) {
    throw std::invalid_argument("guide and weight need a row for each child, and as many columns");
  }
  for (std::size_t i = 0; i < size; ++i) {
    if (children.guide[i] >= count || (children.guide[i] < 0 && children.weight[i] != 0)) {
      throw std::invalid_argument("row " + std::to_string(i / children.guides) + ": guide " +
                                  std::to_string(children.guide[i]) + " is not among the " +
                                  std::to_string(count) + " guides");
    }
  }
}

}  // namespace

Points resampledStrands(const Points& points, const std::vector<std::int64_t>& offsets, int count,
                        int threads) {
  checkThreads(threads);
  if (count < 2) {
    throw std::invalid_argument("count is " + std::to_string(count) + "; expected 2 or more");
  }
  checkOffsets(offsets, points.rows());
  Points result(static_cast<Eigen::Index>(offsets.size() - 1) * count, 3);
  parallelFor(offsets.size() - 1, kStrandsPerTask, threads,
              [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) {
                  resample(points.middleRows(offsets[i], offsets[i + 1] - offsets[i]),
                           result.middleRows(static_cast<Eigen::Index>(i) * count, count));
                }
              });
  return result;
}

FloatPoints childStrands(const GuideStrands& guides, const ChildRoots& children, int threads,
                         const Progress& progress) {
  checkThreads(threads);
  check(guides, children);
  const Eigen::Index side = guides.points_per_strand;
  const auto strand = [&](std::int32_t guide) {
    return guides.points.middleRows(guide * side, side);
  };
  std::vector<double> lengths(static_cast<std::size_t>(guides.normals.rows()));
  for (std::size_t guide = 0; guide < lengths.size(); ++guide) {
    lengths[guide] = lengthOf(strand(static_cast<std::int32_t>(guide)));
  }
  const auto rows = static_cast<std::size_t>(children.position.rows());
  FloatPoints result(static_cast<Eigen::Index>(rows) * side, 3);
  const auto grow = [&](std::size_t row, Strand& shape) {
    const Vector3 normal = children.normal.row(static_cast<Eigen::Index>(row));
    shape.setZero();
    double wanted = 0;
    for (int k = 0; k < children.guides; ++k) {
      const std::size_t entry = row * static_cast<std::size_t>(children.guides) + k;
      const double weight = children.weight[entry];
      if (weight == 0) {
        continue;
      }
      const std::int32_t guide = children.guide[entry];
      const Vector3 from = guides.normals.row(guide);
      const Eigen::Matrix3d turn = weight * shortestTurn(from, normal);
      const auto points = strand(guide);
      shape += (points.rowwise() - points.row(0)) * turn.transpose();
      wanted += weight * lengths[guide];
    }
    const double length = lengthOf(shape);
    const double scale = length > 0 ? wanted / length : 1;
    const auto root = children.position.row(static_cast<Eigen::Index>(row));
    result.middleRows(static_cast<Eigen::Index>(row) * side, side) =
        ((scale * shape).rowwise() + root).cast<float>();
  };
  for (std::size_t begin = 0; begin < rows; begin += kStrandsPerPart) {
    const std::size_t count = std::min(kStrandsPerPart, rows - begin);
    parallelFor(count, kStrandsPerTask, threads, [&](std::size_t first, std::size_t last) {
      Strand shape(side, 3);
      for (std::size_t row = begin + first; row < begin + last; ++row) {
        grow(row, shape);
      }
    });
    if (progress) {
      progress(static_cast<double>(begin + count) / static_cast<double>(rows));
    }
  }
  return result;
}

}  // namespace limitsurf
