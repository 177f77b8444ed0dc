// SPDX-License-Identifier: Apache-2.0
//
// Bounds of images in boxes hold what is sampled there. The truth for how wide they may be is a
// loop over pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "limitsurf/image/filtered_image.h"
#include "support/random.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

constexpr Extension kExtensions[] = {Extension::clip, Extension::extend, Extension::repeat,
                                     Extension::mirror};

std::vector<float> randomPixels(int count, Random& random) {
  std::vector<float> pixels;
  for (int i = 0; i < count; ++i) {
    pixels.push_back(random.below(3) == 0 ? 0.f : static_cast<float>(random.uniform(-1, 2)));
  }
  return pixels;
}

TEST(ImageBounds, HoldAllSamples) {
  Random random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const int width = 1 + random.below(trial % 4 == 0 ? 70 : 9),
              height = 1 + random.below(trial % 3 == 0 ? 50 : 9), channels = 1 + random.below(3);
    const Extension extension = kExtensions[trial % 4];
    const std::vector<float> pixels = randomPixels(width * height * channels, random);
    const FilteredImage image(pixels.data(), width, height, channels, extension);
    constexpr int kBoxes = 12, kPlaces = 40;
    ImageBoxes boxes(kBoxes, 4);
    ImagePoints st(kBoxes * kPlaces, 2);
    for (int box = 0; box < kBoxes; ++box) {
      const double far = box == 0 ? 80 : 2, size = std::ldexp(1., -random.below(8));
      for (const int axis : {0, 1}) {
        boxes(box, axis) = random.uniform(-far, far);
        boxes(box, 2 + axis) = boxes(box, axis) + size * random.uniform(0, 3);
      }
      for (int i = 0; i < kPlaces; ++i) {
        for (const int axis : {0, 1}) {
          const double low = boxes(box, axis), high = boxes(box, 2 + axis);
          const double part = i < 4 ? (i >> axis) & 1 : random.uniform();
          st(box * kPlaces + i, axis) = std::clamp(low + part * (high - low), low, high);
        }
      }
    }
    const ColourBounds bounds = image.bounds(boxes);
    const Colours colours = image.sample(st, Footprints::Zero(st.rows(), 4));
    for (int box = 0; box < kBoxes; ++box) {
      for (int i = 0; i < kPlaces; ++i) {
        const auto colour = colours.row(box * kPlaces + i).array();
        ASSERT_TRUE((colour >= bounds.low.row(box).array()).all() &&
                    (colour <= bounds.high.row(box).array()).all())
            << "trial " << trial << ": " << colour << " outside of " << bounds.low.row(box)
            << " to " << bounds.high.row(box);
      }
    }
  }
}

/// Pixels farther away than an eighth of the box, beyond those that are interpolated, do not count.
TEST(ImageBounds, AreNotMuchWiderThanThePixels) {
  Random random(2);
  const int width = 173, height = 90;
  const std::vector<float> pixels = randomPixels(width * height, random);
  const FilteredImage image(pixels.data(), width, height, 1, Extension::extend);
  for (int trial = 0; trial < 300; ++trial) {
    const int w = 1 + random.below(width - 2), h = 1 + random.below(height - 2);
    const int x = random.below(width - w), y = random.below(height - h);
    ImageBoxes box(1, 4);  // from the middle of pixel (x, y) to somewhat before (x + w, y + h)
    box << (x + 0.5) / width, (y + 0.5) / height, (x + w + 0.25) / width, (y + h + 0.25) / height;
    const ColourBounds bounds = image.bounds(box);
    const int margin = 1 + (std::max(w, h) + 1) / 8;
    float least = INFINITY, largest = -INFINITY;
    for (int j = std::max(y - margin, 0); j <= std::min(y + h + margin, height - 1); ++j) {
      for (int i = std::max(x - margin, 0); i <= std::min(x + w + margin, width - 1); ++i) {
        least = std::min(least, pixels[static_cast<std::size_t>(width * j + i)]);
        largest = std::max(largest, pixels[static_cast<std::size_t>(width * j + i)]);
      }
    }
    EXPECT_GE(bounds.low(0, 0), least - 3 * FilteredImage::kRounding);
    EXPECT_LE(bounds.high(0, 0), largest + 3 * FilteredImage::kRounding);
  }
}

/// So that a mask that is 0 in a box is known to be 0 there.
TEST(ImageBounds, AreExactlyZeroWhereTheImageIs) {
  std::vector<float> pixels(64 * 64, 0);
  pixels[64 * 40 + 40] = 1;
  const FilteredImage image(pixels.data(), 64, 64, 1, Extension::extend);
  ImageBoxes boxes(2, 4);
  boxes << 0, 0, 0.59, 0.59, 0.7, 0.7, 1, 1;
  const ColourBounds bounds = image.bounds(boxes);
  EXPECT_EQ(bounds.low.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(bounds.high.cwiseAbs().maxCoeff(), 0);
}

/// Denormal pixels, and the largest ones.
TEST(ImageBounds, HoldAtBothEndsOfSinglePrecision) {
  Random random(3);
  for (const float size : {1e-45f, 1e-42f, 1e-38f, 3.4e38f}) {
    std::vector<float> pixels;
    for (int i = 0; i < 16; ++i) pixels.push_back(size * static_cast<float>(random.uniform()));
    const FilteredImage image(pixels.data(), 4, 4, 1, Extension::extend);
    ImageBoxes box(1, 4);
    box << 0, 0, 1, 1;
    const ColourBounds bounds = image.bounds(box);
    EXPECT_TRUE(bounds.high.allFinite());
    ImagePoints st(500, 2);
    for (double& x : st.reshaped()) x = random.uniform();
    const Colours found = image.sample(st, Footprints::Zero(500, 4));
    EXPECT_GE(found.minCoeff(), bounds.low(0, 0)) << size;
    EXPECT_LE(found.maxCoeff(), bounds.high(0, 0)) << size;
  }
}

TEST(ImageBounds, RefuseWhatHasNoMeaning) {
  const std::vector<float> pixels(16, 0.5f);
  const FilteredImage grey(pixels.data(), 4, 4, 1, Extension::clip),
      alpha(pixels.data(), 2, 2, 4, Extension::clip);
  ImageBoxes boxes(2, 4);
  boxes << 0, 0, 1, 1, NAN, 0, 1, 1;
  const ColourBounds bounds = grey.bounds(boxes);
  EXPECT_GT(bounds.high(0, 0), 0.5f);
  EXPECT_LT(bounds.high(0, 0), 0.50001f);
  EXPECT_TRUE(std::isnan(bounds.low(1, 0)) && std::isnan(bounds.high(1, 0)));
  expectThrow<std::invalid_argument>([&] { alpha.bounds(boxes); }, {"4 channels", "alpha"});
  boxes.row(1) << 0, 0.5, 1, 0.25;
  expectThrow<std::invalid_argument>([&] { grey.bounds(boxes); }, {"row 1", "(0, 0.5)", "above"});
  boxes.row(1) << 0, 0.5, INFINITY, 0.75;
  expectThrow<std::invalid_argument>([&] { grey.bounds(boxes); }, {"row 1", "inf"});
}

}  // namespace
}  // namespace limitsurf::test
