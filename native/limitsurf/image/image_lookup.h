// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "limitsurf/image/covariance.h"
#include "limitsurf/image/filtered_image.h"
#include "limitsurf/image/image_pyramid.h"
#include "limitsurf/image/pixel_sum.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// FilteredImage::sample() for one place after the other: bilinear interpolation for footprints up
/// to a pixel, an elliptical weighted average (Greene & Heckbert 1986) for larger ones.
template <int kChannels>
class ImageLookup {
 public:
  ImageLookup(const ImagePyramid& pyramid, const PixelUnits& units, Extension extension)
      : pyramid_(pyramid),
        units_(units),
        is_scaled_(units.colour != 1 || units.alpha != 1),
        extension_(extension) {}

  /// Numbers that single precision cannot hold become infinite.
  void sample(const double* st, const double* footprint, float* out) const {
    std::fill(out, out + kChannels, 0.f);
    const double s = nearby(st[0]), t = nearby(st[1]);
    const Covariance texel = squareOf(footprint);
    const double length = std::sqrt(texel.largest());
    const double average = std::clamp((length - kPixel) / (kFiltered - kPixel), 0., 1.);
    if (average < 1) {
      addLinear(s, t, static_cast<float>(1 - average), out);
    }
    if (average > 0) {
      addAverage(s, t, texel, static_cast<float>(average), out);
    }
    if (is_scaled_) {
      scaleBack(out);
    } else if (kChannels == 4) {
      for (int c = 0; c < 3; ++c) {
        out[c] = out[3] > 0 ? out[c] / out[3] : 0;
      }
    }
  }

 private:
  /// Footprints up to kPixel are interpolated, those from kFiltered on are averaged, and between
  /// the two both are mixed. In pixels.
  static constexpr double kPixel = 1, kFiltered = 1.5;
  /// Variances: of the filter, in squared texels, and of linear interpolation (the convolution of
  /// two unit intervals) and of a pixel (a unit interval), in squared pixels.
  static constexpr double kTexelVariance = 0.25, kLinearVariance = 1. / 6,
                          kSquareVariance = 1. / 12;
  /// The least variance of the filter on the level on which pixels are added up, in squared pixels.
  static constexpr double kLeastVariance = 0.5;
  /// The bell (1 - r^2)^3 on the disc r < 1 has the variance 1 / 10 along each axis.
  static constexpr double kBellSquare = 10;

  /// Brings numbers in the pyramid's units to those of the image, with straight alpha.
  void scaleBack(float* out) const {
    const double alpha = kChannels == 4 ? out[3] : 1;
    constexpr int kColours = kChannels == 4 ? 3 : kChannels;
    for (int c = 0; c < kColours; ++c) {
      out[c] = alpha > 0 ? static_cast<float>(units_.colour * (out[c] / alpha)) : 0;
    }
    if (kChannels == 4) {
      out[3] = static_cast<float>(units_.alpha * alpha);
    }
  }

  /// A place not far from the image that has the same surroundings, as far as footprints reach.
  double nearby(double x) const {
    constexpr double kFar = 64;
    if (std::abs(x) < kFar) {
      return x;
    }
    switch (extension_) {
      case Extension::repeat:
      case Extension::mirror:
        return x - 2 * std::floor(x / 2);
      default:
        return std::clamp(x, -kFar, kFar);
    }
  }

  /// F F^T in squared pixels, where the columns of F are the steps of (s, t) from texel to texel.
  Covariance squareOf(const double* footprint) const {
    const PixelGrid& image = pyramid_.level(0);
    double f[4];
    for (int axis = 0; axis < 2; ++axis) {
      const double s = footprint[axis], t = footprint[2 + axis];
      const double length = std::hypot(s, t);
      const double scale = length > kLongestFootprint ? kLongestFootprint / length : 1;
      f[axis] = scale * s * image.width;
      f[2 + axis] = scale * t * image.height;
    }
    return {f[0] * f[0] + f[1] * f[1], f[0] * f[2] + f[1] * f[3], f[2] * f[2] + f[3] * f[3]};
  }

  void addLinear(double s, double t, float part, float* out) const {
    const PixelGrid& image = pyramid_.level(0);
    const double x = s * image.width - 0.5, y = t * image.height - 0.5;
    const double left = std::floor(x), below = std::floor(y);
    const auto a = static_cast<float>(x - left), b = static_cast<float>(y - below);
    const int i = static_cast<int>(left), j = static_cast<int>(below);
    PixelSum<kChannels> sum(image, extension_);
    sum.add(i, j, (1 - a) * (1 - b));
    sum.add(i + 1, j, a * (1 - b));
    sum.add(i, j + 1, (1 - a) * b);
    sum.add(i + 1, j + 1, a * b);
    sum.addMean(part, out);
  }

  void addAverage(double s, double t, const Covariance& texel, float part, float* out) const {
    Covariance wanted = {kTexelVariance * texel.xx + kLinearVariance, kTexelVariance * texel.xy,
                         kTexelVariance * texel.yy + kLinearVariance};
    wanted = wanted.widened(wanted.largest() / (kMostEccentric * kMostEccentric));
    const PixelGrid& level = pyramid_.level(levelFor(wanted.smallest()));
    const double x_scale = static_cast<double>(level.width) / pyramid_.level(0).width,
                 y_scale = static_cast<double>(level.height) / pyramid_.level(0).height;
    // In pixels of the level. Averaging s pixels into one has already contributed a variance of
    // (s^2 - 1) / 12.
    const Covariance filter = {x_scale * x_scale * (wanted.xx + kSquareVariance) - kSquareVariance,
                               x_scale * y_scale * wanted.xy,
                               y_scale * y_scale * (wanted.yy + kSquareVariance) - kSquareVariance};
    addBell(s * level.width - 0.5, t * level.height - 0.5, filter, level, part, out);
  }

  /// The coarsest level on which a variance, in squared pixels of the image, is still at least
  /// kLeastVariance.
  int levelFor(double variance) const {
    int level = 0;
    double pixel = 4;
    while (level + 1 < pyramid_.size() &&
           variance + kSquareVariance >= pixel * (kLeastVariance + kSquareVariance)) {
      ++level;
      pixel *= 4;
    }
    return level;
  }

  /// Adds the mean of the level under the bell around (x, y) that has the covariance of the filter.
  void addBell(double x, double y, const Covariance& filter, const PixelGrid& level, float part,
               float* out) const {
    const double scale = 1 / (kBellSquare * (filter.xx * filter.yy - filter.xy * filter.xy));
    const double a = scale * filter.yy, b = -scale * filter.xy, c = scale * filter.xx;
    const double reach = std::sqrt(kBellSquare * filter.yy);
    PixelSum<kChannels> sum(level, extension_);
    const int top = static_cast<int>(std::floor(y + reach));
    for (int row = static_cast<int>(std::ceil(y - reach)); row <= top; ++row) {
      // a dx^2 + 2 b dx dy + c dy^2 < 1
      const double dy = row - y;
      const double middle = -b * dy / a;
      const double square = (1 - (c - b * b / a) * dy * dy) / a;
      if (square <= 0) {
        continue;
      }
      const double half = std::sqrt(square);
      const int first = static_cast<int>(std::ceil(x + middle - half)),
                last = static_cast<int>(std::floor(x + middle + half));
      const auto a_float = static_cast<float>(a);
      const auto from_middle = static_cast<float>(first - (x + middle));
      const auto square_float = static_cast<float>(square);
      sum.addRow(row, first, last, [&](int pixel) {
        const float d = from_middle + static_cast<float>(pixel - first);
        const float rest = std::max(0.f, a_float * (square_float - d * d));
        return rest * rest * rest;
      });
    }
    sum.addMean(part, out);
  }

  const ImagePyramid& pyramid_;
  const PixelUnits& units_;
  bool is_scaled_;
  Extension extension_;
};

}  // namespace limitsurf
