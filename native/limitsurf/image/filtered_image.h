// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/image/image_pyramid.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// What lies outside an image's frame: nothing (0, transparent), its border's pixels, the image
/// again, or mirrored and again.
enum class Extension { clip, extend, repeat, mirror };

/// Bound on the error of FilteredImage::sample() against the exact integral of the image (linear
/// between pixels' centres) under a Gaussian that has half a texel for standard deviation, for
/// pixels from 0 to 1 and footprints that are at least 1.5 pixels long and at most kMostEccentric
/// times as long as wide. Not near borders that Extension::extend continues: what it repeats is the
/// border of a halving. Measured, not derived: most images stay within 0.05; the worst seen is
/// 0.127, of stripes a pixel wide beside a mirrored border, which halving makes even.
constexpr double kFilterError = 0.15;

/// Narrower footprints are widened to this ratio of length to width.
constexpr double kMostEccentric = 32;

/// One value a row, one column a channel.
using Colours = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What FilteredImage::sample() throws for these arguments.
void checkSamples(Eigen::Ref<const ImagePoints> st, Eigen::Ref<const Footprints> footprint);

/// An image that can be looked up through footprints of any size and shape without aliasing.
///
/// Of four channels the last is alpha, and colours are filtered multiplied by it: what is
/// transparent brings no dark fringe. With fewer channels there is no alpha.
///
/// The code is our own since the libraries that filter textures well are those that hosts load
/// under the same names themselves (OpenImageIO in Blender), or want files.
///
/// Memory: 1.34 times the pixels as float32, at most twice for images of a single row.
class FilteredImage {
 public:
  /// `pixels`: height rows of width pixels of `channels` (1 to 4) numbers, from the bottom up.
  /// `premultiplied`: their colours come multiplied by alpha.
  ///
  /// Throws std::invalid_argument for sizes below 1, another number of channels, and naming the
  /// first pixel that is not finite. Cost: O(pixels).
  FilteredImage(const float* pixels, int width, int height, int channels, Extension extension,
                bool premultiplied = false, int threads = 0);

  int width() const { return pyramid_.level(0).width; }
  int height() const { return pyramid_.level(0).height; }
  int channels() const { return pyramid_.level(0).channels; }

  /// The image at each place as a texel sees it; alpha is straight.
  ///
  /// Footprints of at most a pixel's length: linear between pixels' centres, unfiltered. From 1.5
  /// pixels on: an elliptical weighted average (Greene & Heckbert, "Creating Raster Omnimax Images
  /// from Multiple Perspective Views Using the Elliptical Weighted Average Filter", 1986), with
  /// half the footprint for standard deviation, on the level on which the ellipse's short axis has
  /// about a pixel's standard deviation; what the level has been averaged already is taken off the
  /// ellipse. Between, both are mixed. Error: kFilterError.
  ///
  /// Vectors of a footprint that are longer than kLongestFootprint are shortened to it. A row of
  /// NaN in `st` is nowhere: all channels are 0. The same bits for a row whatever the threads and
  /// the other rows.
  ///
  /// Throws std::invalid_argument for another number of rows and naming the first that is infinite
  /// or has a footprint that is not finite. Cost: O(length / width) a row.
  Colours sample(const ImagePoints& st, const Footprints& footprint, int threads = 0) const;

 private:
  ImagePyramid pyramid_;
  Extension extension_;
};

}  // namespace limitsurf
