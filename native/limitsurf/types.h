// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace limitsurf {

using Vector3 = Eigen::Vector3d;

/// One point or vector per row.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// The same in single precision: the form in which applications store the points of hair.
using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// One 3 x 3 matrix per row, row-major.
using Rotations = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

/// Arguments of these types refer to matrices with contiguous rows, or to memory of their layout
/// (Eigen::Map).
template <typename Rows>
using RowsIn = Eigen::Ref<const Rows, 0, Eigen::OuterStride<Rows::ColsAtCompileTime>>;
template <typename Rows>
using RowsOut = Eigen::Ref<Rows, 0, Eigen::OuterStride<Rows::ColsAtCompileTime>>;

/// A read-only view of contiguous elements. It does not own them.
template <typename T>
class Span {
 public:
  Span() = default;
  Span(const T* data, std::size_t size) : data_(data), size_(size) {}
  Span(const std::vector<T>& elements) : Span(elements.data(), elements.size()) {}

  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  Span subspan(std::size_t begin, std::size_t count) const { return {data_ + begin, count}; }

 private:
  const T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// An address on the limit surface. `face` is a Ptex face id. Ptex faces are numbered in the order
/// of the control mesh's faces: a quad has one, an n-gon (n != 4) has n sub-faces, one for each
/// corner. (u, v) lie in [0, 1]^2. On a quad (0,0), (1,0), (1,1), (0,1) are its vertices 0 to 3; on
/// a sub-face they are its corner, the midpoint of the edge that leaves the corner, the n-gon's
/// centre, and the midpoint of the edge that arrives at the corner.
struct Location {
  int face = -1;
  double u = 0;
  double v = 0;
};

}  // namespace limitsurf
