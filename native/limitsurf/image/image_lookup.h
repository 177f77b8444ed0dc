// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "limitsurf/image/filtered_image.h"
#include "limitsurf/image/image_pyramid.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// Sums of weighted pixels, of which some lie outside the image.
template <int kChannels>
class PixelSum {
 public:
  PixelSum(const PixelGrid& level, Extension extension) : level_(level), extension_(extension) {}

  void add(int x, int y, float weight) {
    weights_ += weight;
    const int column = inside(x, level_.width), row = inside(y, level_.height);
    if (column >= 0 && row >= 0) {
      addPixel(level_.row(row) + kChannels * column, weight);
    }
  }

  /// weight(x) for the pixels first to last of row y.
  template <typename Weight>
  void addRow(int y, int first, int last, const Weight& weight) {
    const int row = inside(y, level_.height);
    if (row < 0) {
      for (int x = first; x <= last; ++x) {
        weights_ += weight(x);
      }
      return;
    }
    const float* pixels = level_.row(row);
    if (first >= 0 && last < level_.width) {
      for (int x = first; x <= last; ++x) {
        const float w = weight(x);
        weights_ += w;
        addPixel(pixels + kChannels * x, w);
      }
      return;
    }
    for (int x = first; x <= last; ++x) {
      const float w = weight(x);
      weights_ += w;
      const int column = inside(x, level_.width);
      if (column >= 0) {
        addPixel(pixels + kChannels * column, w);
      }
    }
  }

  /// Adds the mean, times `part`, to `out`.
  void addMean(float part, float* out) const {
    for (int c = 0; c < kChannels; ++c) {
      out[c] += part * sum_[c] / weights_;
    }
  }

 private:
  void addPixel(const float* pixel, float weight) {
    for (int c = 0; c < kChannels; ++c) {
      sum_[c] += weight * pixel[c];
    }
  }

  /// The pixel that stands for one at i, or -1 for none.
  int inside(int i, int count) const {
    if (i >= 0 && i < count) {
      return i;
    }
    switch (extension_) {
      case Extension::clip:
        return -1;
      case Extension::extend:
        return std::clamp(i, 0, count - 1);
      case Extension::repeat:
        return modulo(i, count);
      default: {
        const int j = modulo(i, 2 * count);
        return j < count ? j : 2 * count - 1 - j;
      }
    }
  }
  static int modulo(int i, int period) {
    const int rest = i % period;
    return rest < 0 ? rest + period : rest;
  }

  const PixelGrid& level_;
  Extension extension_;
  float sum_[kChannels] = {};
  float weights_ = 0;
};

/// A covariance in the plane, of an ellipse around it.
struct Spread {
  double xx, xy, yy;

  /// The larger and the smaller of both principal variances.
  double largest() const { return (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy); }
  double smallest() const { return std::max(0., (xx * yy - xy * xy) / largest()); }

  /// With a smallest variance of at least `least`, which is below the largest.
  Spread widened(double least) const {
    const double large = largest(), small = smallest();
    if (small >= least) {
      return *this;
    }
    // (large I - V) / (large - small) projects on the short axis.
    const double factor = (least - small) / (large - small);
    return {xx + factor * (large - xx), xy - factor * xy, yy + factor * (large - yy)};
  }
};

/// FilteredImage::sample() for one place after the other.
template <int kChannels>
class ImageLookup {
 public:
  ImageLookup(const ImagePyramid& pyramid, Extension extension)
      : pyramid_(pyramid), extension_(extension) {}

  void sample(const double* st, const double* footprint, float* out) const {
    std::fill(out, out + kChannels, 0.f);
    const double s = nearby(st[0]), t = nearby(st[1]);
    const Spread texel = squareOf(footprint);
    const double length = std::sqrt(texel.largest());
    const double average = std::clamp((length - kPixel) / (kFiltered - kPixel), 0., 1.);
    if (average < 1) {
      addLinear(s, t, static_cast<float>(1 - average), out);
    }
    if (average > 0) {
      addAverage(s, t, texel, static_cast<float>(average), out);
    }
    if (kChannels == 4) {
      for (int c = 0; c < 3; ++c) {
        out[c] = out[3] > 0 ? out[c] / out[3] : 0;
      }
    }
  }

 private:
  /// Footprints up to the first are not filtered, and from the second on not interpolated.
  static constexpr double kPixel = 1, kFiltered = 1.5;
  /// Of the filter in texels, and of linear interpolation and a pixel's square in pixels.
  static constexpr double kTexelVariance = 0.25, kLinearVariance = 1. / 6,
                          kSquareVariance = 1. / 12;
  /// The least variance with which a level is summed up, in pixels.
  static constexpr double kLeastVariance = 0.5;
  /// The bell (1 - r^2)^3 on the disc r < 1 has the variance 1 / 10.
  static constexpr double kBellSquare = 10;

  /// A place with the same surroundings, as far as footprints reach, that is not far away.
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

  /// F F^T in pixels, where the columns of F are how far (s, t) moves from texel to texel.
  Spread squareOf(const double* footprint) const {
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

  void addAverage(double s, double t, const Spread& texel, float part, float* out) const {
    Spread wanted = {kTexelVariance * texel.xx + kLinearVariance, kTexelVariance * texel.xy,
                     kTexelVariance * texel.yy + kLinearVariance};
    wanted = wanted.widened(wanted.largest() / (kMostEccentric * kMostEccentric));
    const PixelGrid& level = pyramid_.level(levelFor(wanted.smallest()));
    const double x_scale = static_cast<double>(level.width) / pyramid_.level(0).width,
                 y_scale = static_cast<double>(level.height) / pyramid_.level(0).height;
    // In the level's pixels, less what averaging has done: s pixels in one, (s^2 - 1) / 12.
    const Spread spread = {x_scale * x_scale * (wanted.xx + kSquareVariance) - kSquareVariance,
                           x_scale * y_scale * wanted.xy,
                           y_scale * y_scale * (wanted.yy + kSquareVariance) - kSquareVariance};
    addBell(s * level.width - 0.5, t * level.height - 0.5, spread, level, part, out);
  }

  /// The coarsest level on which so small a variance in pixels of the image is still
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

  /// The mean under the bell around (x, y), which has the given spread.
  void addBell(double x, double y, const Spread& spread, const PixelGrid& level, float part,
               float* out) const {
    const double scale = 1 / (kBellSquare * (spread.xx * spread.yy - spread.xy * spread.xy));
    const double a = scale * spread.yy, b = -scale * spread.xy, c = scale * spread.xx;
    const double reach = std::sqrt(kBellSquare * spread.yy);
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
  Extension extension_;
};

}  // namespace limitsurf
