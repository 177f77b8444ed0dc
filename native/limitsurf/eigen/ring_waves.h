// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/eigen/chirp_transform.h"
#include "limitsurf/eigen/ring.h"

namespace limitsurf {

/// The sums of a ring's points times the values of its spoke modes (spoke_mode.h): cosines and
/// sines around the vertex, at the angles that Eigenbasis::edgeAngle() and faceAngle() state.
class RingWaves {
 public:
  /// `cos` and `sin` hold one period, and must outlive the object: 2 N values on a closed ring of N
  /// faces, 4 k in a sector of k.
  RingWaves(const Ring& ring, const std::vector<double>& cos, const std::vector<double>& sin)
      : ring_(ring), cos_(cos), sin_(sin) {
    if (ring.faces > kFewFaces) {
      transform_ = std::make_unique<const ChirpTransform>(cos, sin);
    }
  }

  template <typename Value>
  struct Sums {
    Value edge_cos, edge_sin, face_cos, face_sin;
  };

  /// Calls visit(m, sums) for the modes m = 1, ..., count. `at(i)` returns point i of the ring; a
  /// Value is a number or an array of numbers. Only rings that a turn by one face maps onto
  /// themselves have cosines. A sector's values on the first and the last spoke do not matter.
  /// Cost: O(faces log faces) together.
  template <typename Value, typename At, typename Visit>
  void sums(int count, const At& at, const Visit& visit) const {
    if (!transform_) {
      const bool rotates = ring_.closed() && ring_.kind != RingKind::dart;
      for (int m = 1; m <= count; ++m) {
        visit(m, rotates ? directSums<true, Value>(m, at) : directSums<false, Value>(m, at));
      }
      return;
    }
    // Spokes and faces are transformed together, as the real and the imaginary part.
    const std::size_t n = transform_->count();
    std::vector<Value> re, im;
    gather(at, re, im);
    transform_->apply(re, im);
    const double scale = ring_.closed() ? 0.5 : 0.25;  // a sector and its mirror image are summed
    for (int m = 1; m <= count; ++m) {
      const std::size_t i = static_cast<std::size_t>(m), j = n - i;
      const Value face_re = scale * (im[i] + im[j]), face_im = scale * (re[j] - re[i]);
      visit(m, Sums<Value>{scale * (re[i] + re[j]), scale * (im[j] - im[i]),
                           cos_[i] * face_re + sin_[i] * face_im,
                           sin_[i] * face_re - cos_[i] * face_im});
    }
  }

  /// Whether there are so many faces that sums one by one would take longer.
  bool hasTransform() const { return transform_ != nullptr; }

  /// The transpose of sums(), which needs hasTransform(): calls add(point, value) for the points
  /// around the vertex with the sum over the modes m = 1, ..., count of their values at the point
  /// times weight(m), which is a Sums<Value>. On rings without cosines the weights of cosines
  /// must be 0.
  /// Cost: O(faces log faces) together.
  template <typename Value, typename Weight, typename Add>
  void transposedSums(int count, const Weight& weight, const Add& add) const {
    // The sum over modes of c_m cos(a m) + s_m sin(a m) is the real part of the transform of
    // c_m + i s_m. The half of it at m and the conjugate of that at n - m have this real part
    // alone, which leaves the imaginary part to the faces.
    const std::size_t n = transform_->count();
    const Value zero = 0 * weight(1).edge_sin;
    std::vector<Value> re(n, zero), im(n, zero);
    for (int m = 1; m <= count; ++m) {
      const std::size_t i = static_cast<std::size_t>(m), j = n - i;
      const Sums<Value> w = weight(m);
      const Value edge_re = 0.5 * w.edge_cos, edge_im = 0.5 * w.edge_sin;
      const Value face_re = 0.5 * (cos_[i] * w.face_cos + sin_[i] * w.face_sin),
                  face_im = 0.5 * (cos_[i] * w.face_sin - sin_[i] * w.face_cos);
      re[i] += edge_re - face_im;
      im[i] += edge_im + face_re;
      re[j] += edge_re + face_im;
      im[j] += face_re - edge_im;
    }
    transform_->apply(re, im);
    for (int i = 0; i < ring_.edges(); ++i) {
      add(ring_.edge(i), re[static_cast<std::size_t>(i)]);
    }
    for (int j = 0; j < ring_.faces; ++j) {
      add(ring_.face(j), im[static_cast<std::size_t>(j)]);
    }
  }

 private:
  /// Up to here the transform would take longer.
  static constexpr int kFewFaces = 128;

  template <bool kCosines, typename Value, typename At>
  Sums<Value> directSums(int m, const At& at) const {
    const std::int64_t period = static_cast<std::int64_t>(cos_.size()), step = 2 * std::int64_t{m};
    const auto advance = [&](std::int64_t& angle) {
      angle += step;
      while (angle >= period) {
        angle -= period;
      }
    };
    const Value zero = 0 * at(0);
    Sums<Value> sums{zero, zero, zero, zero};
    std::int64_t edge_angle = 0, face_angle = m;
    while (face_angle >= period) {
      face_angle -= period;
    }
    for (int i = 0; i < ring_.edges(); ++i, advance(edge_angle)) {
      const Value e = at(ring_.edge(i));
      if (kCosines) {
        sums.edge_cos += cos_[edge_angle] * e;
      }
      sums.edge_sin += sin_[edge_angle] * e;
    }
    for (int j = 0; j < ring_.faces; ++j, advance(face_angle)) {
      const Value f = at(ring_.face(j));
      if (kCosines) {
        sums.face_cos += cos_[face_angle] * f;
      }
      sums.face_sin += sin_[face_angle] * f;
    }
    return sums;
  }

  /// One period of the spoke points and of the face points. A sector's are continued as odd
  /// functions, whose sums with cosines are 0.
  template <typename Value, typename At>
  void gather(const At& at, std::vector<Value>& re, std::vector<Value>& im) const {
    const int k = ring_.faces;
    for (int i = 0; i < k; ++i) {
      re.push_back(at(ring_.edge(i)));
      im.push_back(at(ring_.face(i)));
    }
    if (ring_.closed()) {
      return;
    }
    re[0] = 0 * re[0];
    for (int i = k; i < 2 * k; ++i) {
      re.push_back(i == k ? re[0] : -re[2 * k - i]);
      im.push_back(-im[2 * k - 1 - i]);
    }
  }

  const Ring ring_;
  const std::vector<double>& cos_;
  const std::vector<double>& sin_;
  std::unique_ptr<const ChirpTransform> transform_;  // of rings with many faces
};

}  // namespace limitsurf
