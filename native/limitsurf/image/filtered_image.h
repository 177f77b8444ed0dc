// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/image/image_pyramid.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// What lies outside the frame of an image: nothing (0, transparent), the pixels of its border, its
/// repetition, or its mirrored repetition.
enum class Extension { clip, extend, repeat, mirror };

/// Bound on the error of FilteredImage::sample(), for pixels from 0 to 1 and footprints that are at
/// least 1.5 pixels long and at most kMostEccentric times as long as wide. The error is the
/// difference from the exact integral of the image, linear between the centres of pixels, under a
/// Gaussian whose standard deviation is half a texel. The bound does not hold near borders that
/// Extension::extend continues, because the border of a halved image is repeated there. Measured,
/// not derived: most images stay within 0.05. The worst image for a footprint follows from the
/// responses to single pixels; its error was at most 0.211 for all footprints that were tried. They
/// are worst where they are as long as wide, and just wide enough for the next smaller copy of the
/// image: 2.89, 6.03, 12.2 pixels and so on.
constexpr double kFilterError = 0.22;

/// Narrower footprints are widened to this ratio of length to width.
constexpr double kMostEccentric = 32;

/// A row for each colour, a column for each channel.
using Colours = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Boxes in an image, in each row the lower left corner (s, t) and the upper right one.
using ImageBoxes = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// The least and the largest colours, a row for each box.
struct ColourBounds {
  Colours low, high;
};

/// Throws what FilteredImage::sample() throws for these arguments.
void checkSamples(Eigen::Ref<const ImagePoints> st, Eigen::Ref<const Footprints> footprint);

/// An image that can be sampled under footprints of any size and shape without aliasing.
///
/// The last of four channels is alpha, and colours are filtered after multiplication by it, so that
/// transparent pixels leave no dark fringe. An image of fewer channels has no alpha.
///
/// The filter is implemented here because the libraries that filter textures well either are loaded
/// by host applications under the same symbol names (OpenImageIO in Blender) or read files only.
///
/// Memory: 1.34 times that of the pixels as float32, at most twice that for images of a single row.
class FilteredImage {
 public:
  /// `pixels` holds `height` rows of `width` pixels of `channels` (1 to 4) numbers, from the bottom
  /// up. With `premultiplied` their colours are already multiplied by alpha.
  ///
  /// Throws std::invalid_argument for sizes below 1, for another number of channels, and naming the
  /// first pixel that is not finite. Cost: O(pixels).
  FilteredImage(const float* pixels, int width, int height, int channels, Extension extension,
                bool premultiplied = false, int threads = 0);

  int width() const { return pyramid_.level(0).width; }
  int height() const { return pyramid_.level(0).height; }
  int channels() const { return pyramid_.level(0).channels; }

  /// The image under the footprint at each place, with straight alpha.
  ///
  /// For footprints of at most a pixel's length the result is bilinear between the centres of
  /// pixels. For those of 1.5 pixels and more it is an elliptical weighted average (Greene &
  /// Heckbert: "Creating Raster Omnimax Images from Multiple Perspective Views Using the Elliptical
  /// Weighted Average Filter", 1986) whose standard deviation is half the footprint. It is computed
  /// on the level of the image pyramid on which the short axis of the ellipse has a standard
  /// deviation of about a pixel, and the ellipse is reduced by the averaging that the level has
  /// undergone. Between the two lengths both results are mixed. Error: kFilterError.
  ///
  /// Vectors of a footprint that are longer than kLongestFootprint are shortened to it. Where a row
  /// of `st` has a NaN all channels are 0. The bits of a row depend neither on the number of
  /// threads nor on the other rows.
  ///
  /// Colours are finite: one that is beyond the numbers of single precision is the largest of them.
  /// Where colours times alpha are beyond 2^112, those below 2^-237 of the largest lose digits.
  ///
  /// Throws std::invalid_argument for different numbers of rows, and naming the first row that is
  /// infinite or has a footprint that is not finite. Cost: O(length / width) a row.
  Colours sample(const ImagePoints& st, const Footprints& footprint, int threads = 0) const;

  /// Bounds of what sample() returns in each box, channel by channel, for footprints of 0: those of
  /// the pixels that it interpolates there, and kRounding wider. In boxes of many pixels some
  /// pixels close to the box count as well: boxes are taken to be up to an eighth longer. Where a
  /// row has a NaN both bounds are NaN.
  ///
  /// Throws std::invalid_argument for images with alpha, and naming the first box that is infinite
  /// or has a lower corner above the upper one. Cost: O(pixels) once, then O(1) a box.
  ColourBounds bounds(const ImageBoxes& boxes, int threads = 0) const;
  /// Bound on the rounding errors of bilinear interpolation in single precision, as a part of the
  /// largest pixel: four products and three sums, of weights that are products of rounded numbers
  /// themselves, and one division.
  static constexpr float kRounding = 16 * 0x1p-24f;

 private:
  PixelUnits units_;  // those of colours after the division by alpha
  ImagePyramid pyramid_;
  Extension extension_;
};

}  // namespace limitsurf
