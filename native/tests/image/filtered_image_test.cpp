// SPDX-License-Identifier: Apache-2.0
//
// Filtered samples, compared with sums over many values of the image by its definition: linear
// between the centres of its pixels, and continued outside by its extension.
#include "limitsurf/image/filtered_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "limitsurf/pi.h"
#include "support/random.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

/// An image of one channel that can be read anywhere, at a high cost.
struct PlainImage {
  PlainImage(int columns, int rows) : width(columns), height(rows), pixels(columns * rows) {}

  float& at(int x, int y) { return pixels[static_cast<std::size_t>(width * y + x)]; }

  static int continued(int i, int count, Extension extension) {
    if (extension == Extension::extend) return std::min(std::max(i, 0), count - 1);
    if (extension == Extension::clip) return i < 0 || i >= count ? -1 : i;
    const int period = extension == Extension::repeat ? count : 2 * count;
    while (i < 0) i += period;
    while (i >= period) i -= period;
    return i < count ? i : 2 * count - 1 - i;
  }
  double pixel(int x, int y, Extension extension) const {
    const int i = continued(x, width, extension), j = continued(y, height, extension);
    return i < 0 || j < 0 ? 0. : pixels[static_cast<std::size_t>(width * j + i)];
  }
  double linear(double s, double t, Extension extension) const {
    const double x = s * width - 0.5, y = t * height - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const double a = x - i, b = y - j;
    return (1 - b) * ((1 - a) * pixel(i, j, extension) + a * pixel(i + 1, j, extension)) +
           b * ((1 - a) * pixel(i, j + 1, extension) + a * pixel(i + 1, j + 1, extension));
  }
  FilteredImage filtered(Extension extension, int threads = 0) const {
    return FilteredImage(pixels.data(), width, height, 1, extension, false, threads);
  }

  int width, height;
  std::vector<float> pixels;
};

/// An image whose sides are no powers of two, one of them a prime.
PlainImage checker(int square, int width = 300, int height = 257) {
  PlainImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = static_cast<float>((x / square + y / square) % 2);
    }
  }
  return image;
}

PlainImage noise(int width, int height) {
  PlainImage image(width, height);
  Random random(5);
  for (float& pixel : image.pixels) pixel = static_cast<float>(random.uniform());
  return image;
}

struct Footprint {
  double s_x, s_y, t_x, t_y;
};

/// A footprint `length` pixels long and `ratio` times less wide, rotated in the image and in the
/// texel.
Footprint turned(const PlainImage& image, double length, double ratio, double angle,
                 double within) {
  const double width = length / ratio;
  const double c = std::cos(angle), s = std::sin(angle), a = std::cos(within), b = std::sin(within);
  return {(c * length * a - s * width * b) / image.width,
          (-c * length * b - s * width * a) / image.width,
          (s * length * a + c * width * b) / image.height,
          (-s * length * b + c * width * a) / image.height};
}

float sampled(const FilteredImage& image, double s, double t, const Footprint& f) {
  ImagePoints st(1, 2);
  Footprints footprint(1, 4);
  st << s, t;
  footprint << f.s_x, f.s_y, f.t_x, f.t_y;
  return image.sample(st, footprint, 1)(0, 0);
}

/// The mean under weight(x, y), a function of texel coordinates around the centre of the texel.
template <typename Weight>
double mean(const PlainImage& image, Extension extension, double s, double t, const Footprint& f,
            double reach, int per_side, const Weight& weight) {
  double sum = 0, weights = 0;
  for (int i = 0; i < per_side; ++i) {
    for (int j = 0; j < per_side; ++j) {
      const double x = reach * (2 * (i + 0.5) / per_side - 1);
      const double y = reach * (2 * (j + 0.5) / per_side - 1);
      const double w = weight(x, y);
      weights += w;
      sum += w * image.linear(s + f.s_x * x + f.s_y * y, t + f.t_x * x + f.t_y * y, extension);
    }
  }
  return sum / weights;
}

/// The Gaussian with a standard deviation of half a texel.
double gaussian(double x, double y) { return std::exp(-2 * (x * x + y * y)); }

TEST(FilteredImage, IsTheIntegralUnderAGaussian) {
  Random random(1);
  double worst = 0;
  PlainImage edge(61, 97);
  for (int y = 0; y < edge.height; ++y) {
    for (int x = 30; x < edge.width; ++x) edge.at(x, y) = 1;
  }
  for (const PlainImage& image : {checker(1), checker(8), noise(300, 257), edge}) {
    for (const Extension extension : {Extension::mirror, Extension::clip, Extension::repeat}) {
      const FilteredImage filtered = image.filtered(extension);
      for (const double length : {1.5, 2.7, 6., 20.}) {
        for (const double ratio : {1., 4., kMostEccentric}) {
          const Footprint f = turned(image, length, ratio, random.uniform(0, 2 * kPi<double>),
                                     random.uniform(0, 2 * kPi<double>));
          const double s = random.uniform(-0.05, 1.05), t = random.uniform(-0.05, 1.05);
          const double expected = mean(image, extension, s, t, f, 2., 160, gaussian);
          const double error = std::abs(sampled(filtered, s, t, f) - expected);
          EXPECT_LE(error, kFilterError) << "length " << length << ", ratio " << ratio;
          worst = std::max(worst, error);
        }
      }
    }
  }
  EXPECT_GT(worst, 0.0375);  // small errors are no accident
}

// The error is a sum over the pixels. So the worst image for a footprint is 1 exactly where a
// single pixel counts too much, and the footprints for which it is worst are those that are just
// wide enough for the next smaller copy of the image.
TEST(FilteredImage, TheWorstImageForAFootprintIsWithinTheBound) {
  PlainImage image(24, 24), single(24, 24);
  const Footprint f{6.03 / image.width, 0, 0, 6.03 / image.height};
  constexpr double kMiddle = 0.5005;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    single.pixels[i] = 1;
    const double expected = mean(single, Extension::clip, kMiddle, kMiddle, f, 2.5, 120, gaussian);
    const double found = sampled(single.filtered(Extension::clip, 1), kMiddle, kMiddle, f);
    image.pixels[i] = found > expected ? 1 : 0;
    single.pixels[i] = 0;
  }
  const double expected = mean(image, Extension::clip, kMiddle, kMiddle, f, 2.5, 400, gaussian);
  const double error =
      std::abs(sampled(image.filtered(Extension::clip), kMiddle, kMiddle, f) - expected);
  EXPECT_LE(error, kFilterError);
  EXPECT_GT(error, 0.205);
}

TEST(FilteredImage, SinglePixelsInACornerAreBad) {
  constexpr const char* kRows[4] = {"00101010101010", "10111010101010", "00101010101010",
                                    "10101010101110"};
  PlainImage image(14, 4);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) image.at(x, y) = kRows[y][x] == '1' ? 1 : 0;
  }
  const Footprint f{2.921 / image.width, 0, 0, 2.893 / image.height};
  const double s = -0.0024, t = 0.9771;
  const double expected = mean(image, Extension::mirror, s, t, f, 2.5, 400, gaussian);
  const double error = std::abs(sampled(image.filtered(Extension::mirror), s, t, f) - expected);
  EXPECT_LE(error, kFilterError);
  EXPECT_GT(error, 0.17);
}

TEST(FilteredImage, StripesBesideABorderAreBad) {
  PlainImage stripes(64, 64);
  for (int y = 0; y < stripes.height; ++y) {
    for (int x = 1; x < stripes.width; x += 2) stripes.at(x, y) = 1;
  }
  const FilteredImage filtered = stripes.filtered(Extension::mirror);
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const double length = random.uniform(1.5, 5), ratio = random.uniform(1, 1.3);
    const Footprint f = turned(stripes, length, ratio, random.uniform(0, 2 * kPi<double>),
                               random.uniform(0, 2 * kPi<double>));
    const double s = random.uniform(-0.05, 0.05), t = random.uniform(0, 1);
    const double expected = mean(stripes, Extension::mirror, s, t, f, 2.5, 120, gaussian);
    worst = std::max(worst, std::abs(sampled(filtered, s, t, f) - expected));
  }
  EXPECT_LE(worst, kFilterError);
  EXPECT_GT(worst, 0.06);
}

TEST(FilteredImage, CheckerIsGreyFromAfarAsItsSupersampledTexelIs) {
  const PlainImage image = checker(4);
  const FilteredImage filtered = image.filtered(Extension::mirror);
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Footprint f =
        turned(image, random.uniform(24, 200), random.uniform(1, 1.5),
               random.uniform(0, 2 * kPi<double>), random.uniform(0, 2 * kPi<double>));
    const double s = random.uniform(), t = random.uniform();
    const double box =
        mean(image, Extension::mirror, s, t, f, 0.5, 400, [](double, double) { return 1.; });
    EXPECT_NEAR(box, 0.5, 0.05);
    EXPECT_NEAR(sampled(filtered, s, t, f), 0.5, 0.01);
  }
}

TEST(FilteredImage, IsLinearBetweenPixelsWhereTheyAreLarge) {
  const PlainImage image = noise(17, 12);
  Random random(3);
  for (const Extension extension :
       {Extension::clip, Extension::extend, Extension::repeat, Extension::mirror}) {
    const FilteredImage filtered = image.filtered(extension);
    for (int i = 0; i < 200; ++i) {
      const Footprint f =
          turned(image, random.uniform(0, 1), random.uniform(1, 100),
                 random.uniform(0, 2 * kPi<double>), random.uniform(0, 2 * kPi<double>));
      const double s = random.uniform(-1, 2), t = random.uniform(-1, 2);
      EXPECT_NEAR(sampled(filtered, s, t, f), image.linear(s, t, extension), 2e-6);
    }
  }
}

TEST(FilteredImage, ChangesSmoothlyWithTheFootprint) {
  const PlainImage image = noise(64, 64);
  const FilteredImage filtered = image.filtered(Extension::extend);
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const double s = random.uniform(), t = random.uniform(),
                 angle = random.uniform(0, 2 * kPi<double>);
    float before = sampled(filtered, s, t, turned(image, 0.5, 2, angle, 0));
    for (double length = 0.5; length < 80; length *= 1.01) {
      const float now = sampled(filtered, s, t, turned(image, length, 2, angle, 0));
      EXPECT_NEAR(now, before, 0.06) << "at length " << length;
      before = now;
    }
  }
}

TEST(FilteredImage, EveryLevelHasTheImagesMean) {
  for (const auto& [width, height] : {std::pair(257, 64), std::pair(1, 100), std::pair(5, 3)}) {
    const PlainImage image = noise(width, height);
    PixelGrid grid(width, height, 1);
    std::copy(image.pixels.begin(), image.pixels.end(), grid.values.get());
    const ImagePyramid pyramid(std::move(grid));
    double total = 0;
    for (const float pixel : image.pixels) total += pixel;
    for (int i = 0; i < pyramid.size(); ++i) {
      const PixelGrid& level = pyramid.level(i);
      double sum = 0;
      for (int k = 0; k < level.width * level.height; ++k) sum += level.values[k];
      EXPECT_NEAR(sum / (level.width * level.height), total / (width * height), 1e-6);
    }
    EXPECT_EQ(pyramid.level(pyramid.size() - 1).width, 1);
    EXPECT_EQ(pyramid.level(pyramid.size() - 1).height, 1);
  }
}

TEST(FilteredImage, HalvesOfOddSizesAreMeansOverArea) {
  PixelGrid grid(3, 1, 1);
  grid.values[0] = 3;
  grid.values[1] = 6;
  grid.values[2] = 12;
  const ImagePyramid pyramid(std::move(grid));
  EXPECT_FLOAT_EQ(pyramid.level(1).values[0], (3 + 6 / 2.f) / 1.5f);
  EXPECT_FLOAT_EQ(pyramid.level(1).values[1], (6 / 2.f + 12) / 1.5f);
}

TEST(FilteredImage, WhatIsTransparentBringsNoFringe) {
  // Red squares on transparent black, and on transparent green.
  for (const float green : {0.f, 1.f}) {
    std::vector<float> pixels;
    for (int i = 0; i < 64 * 64; ++i) {
      const bool red = (i % 64 / 8 + i / 64 / 8) % 2 == 0;
      pixels.insert(pixels.end(), {red ? 1.f : 0.f, red ? 0.f : green, 0, red ? 1.f : 0.f});
    }
    const FilteredImage image(pixels.data(), 64, 64, 4, Extension::clip);
    Random random(6);
    for (int i = 0; i < 200; ++i) {
      ImagePoints st(1, 2);
      st << random.uniform(-0.2, 1.2), random.uniform(-0.2, 1.2);
      Footprints footprint = Footprints::Random(1, 4) * 0.1 * random.uniform();
      const Colours colour = image.sample(st, footprint);
      if (colour(0, 3) > 1e-4) {
        EXPECT_NEAR(colour(0, 0), 1, 1e-5);
        EXPECT_NEAR(colour(0, 1), 0, 1e-5);
      }
      EXPECT_LE(colour(0, 3), 1 + 1e-6);
    }
  }
}

TEST(FilteredImage, PremultipliedPixelsAreTakenAsTheyAre) {
  const float straight[] = {0.8f, 0.4f, 0.2f, 0.5f}, multiplied[] = {0.4f, 0.2f, 0.1f, 0.5f};
  const FilteredImage a(straight, 1, 1, 4, Extension::extend),
      b(multiplied, 1, 1, 4, Extension::extend, true);
  ImagePoints st(1, 2);
  st << 0.3, 0.9;
  const Footprints footprint = Footprints::Zero(1, 4);
  for (int c = 0; c < 4; ++c) {
    EXPECT_FLOAT_EQ(a.sample(st, footprint)(0, c), straight[c]);
    EXPECT_FLOAT_EQ(b.sample(st, footprint)(0, c), straight[c]);
  }
}

TEST(FilteredImage, RepeatedImagesHaveNoSeam) {
  const PlainImage image = noise(100, 75);
  const FilteredImage filtered = image.filtered(Extension::repeat);
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Footprint f = turned(image, random.uniform(0.5, 40), 3, random.uniform(0, 6), 1);
    const double s = random.uniform(), t = random.uniform();
    EXPECT_NEAR(sampled(filtered, s, t, f), sampled(filtered, s + 3, t - 2, f), 1e-5);
    EXPECT_NEAR(sampled(filtered, s, t, f), sampled(filtered, s - 1e5, t + 1e5, f), 1e-4);
  }
}

TEST(FilteredImage, AnyFootprintHasAnAnswer) {
  const PlainImage image = checker(1);
  for (const Extension extension :
       {Extension::clip, Extension::extend, Extension::repeat, Extension::mirror}) {
    const FilteredImage filtered = image.filtered(extension);
    for (const double size : {0., 1e-300, 1e-9, 1., 1e3, 1e150, 1e300}) {
      for (const double place : {0.5, -3., 1e6, -1e18, 1e300}) {
        for (const Footprint& f : {Footprint{size, 0, 0, 0}, Footprint{size, size, size, size},
                                   Footprint{size, 0, 0, -size}, Footprint{0, 0, size, 1e-5}}) {
          const float value = sampled(filtered, place, 0.3, f);
          EXPECT_TRUE(value >= 0 && value <= 1.0001f) << size << " at " << place << ": " << value;
        }
      }
    }
  }
}

/// Images of four channels, as they are and with pixels that are a power of two larger, give the
/// same colours but for that power.
TEST(FilteredImage, PixelsMayBeOfAnySize) {
  const int side = 33;
  Random random(7);
  std::vector<float> pixels(side * side * 4), large(pixels.size());
  for (float& value : pixels) {
    value = static_cast<float>(random.uniform(0.1, 1));
  }
  const ImagePoints st = ImagePoints::Random(500, 2);
  for (const double size : {0., 0.02, 0.3}) {
    const Footprints footprint = size * Footprints::Random(500, 4);
    for (const bool premultiplied : {false, true}) {
      const auto sampled = [&](const std::vector<float>& from) {
        const FilteredImage image(from.data(), side, side, 4, Extension::mirror, premultiplied);
        return image.sample(st, footprint);
      };
      const Colours expected = sampled(pixels);
      for (const int alpha : {0, 50, 127}) {
        for (const int colour : {30, 90, 120}) {
          for (std::size_t i = 0; i < pixels.size(); ++i) {
            large[i] = std::ldexp(pixels[i], i % 4 == 3 ? alpha : colour);
          }
          Colours actual = sampled(large);
          const int quotient = premultiplied ? colour - alpha : colour;
          actual.leftCols(3) *= std::ldexp(1.f, -quotient);
          actual.col(3) *= std::ldexp(1.f, -alpha);
          EXPECT_TRUE(actual == expected) << size << ", alpha 2^" << alpha << ", 2^" << colour;
        }
      }
    }
  }
}

TEST(FilteredImage, ColoursAreFinite) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const ImagePoints st = ImagePoints::Random(200, 2);
  const Footprints footprint = 0.2 * Footprints::Random(200, 4);
  std::vector<float> pixels(16 * 16, kLargest);
  const FilteredImage flat(pixels.data(), 16, 16, 1, Extension::repeat);
  const Colours colours = flat.sample(st, footprint);
  EXPECT_TRUE((colours.array() <= kLargest && colours.array() >= 0.99999f * kLargest).all());
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    pixels[i] = -kLargest;
  }
  const FilteredImage mixed(pixels.data(), 16, 16, 1, Extension::repeat);
  EXPECT_TRUE(mixed.sample(st, footprint).allFinite());
  // colours that alpha divides
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = i % 4 == 3 ? 1e-42f : 1.f;
  }
  const FilteredImage thin(pixels.data(), 8, 8, 4, Extension::repeat, true);
  EXPECT_TRUE((thin.sample(st, Footprints::Zero(200, 4)).leftCols(3).array() == kLargest).all());
}

TEST(FilteredImage, OneVeryLargePixelLeavesTheOthersAsTheyAre) {
  std::vector<float> pixels(4 * 64, 0.5f);
  const ImagePoints st = ImagePoints::Constant(1, 2, 0.2);
  for (const float large : {1e20f, 1e33f, 3e38f}) {
    for (const float alpha : {1.f, 1e20f}) {
      for (const bool premultiplied : {false, true}) {
        pixels[252] = pixels[253] = pixels[254] = large;
        pixels[255] = alpha;
        const FilteredImage image(pixels.data(), 8, 8, 4, Extension::clip, premultiplied);
        const Colours colours = image.sample(st, Footprints::Constant(1, 4, 0.01));
        const float expected = premultiplied ? 1.f : 0.5f;
        EXPECT_NEAR(colours(0, 1), expected, 1e-6) << large << ", alpha " << alpha;
        EXPECT_NEAR(colours(0, 3), 0.5f, 1e-6);
      }
    }
  }
}

TEST(FilteredImage, NowhereIsTransparent) {
  const FilteredImage image = checker(1).filtered(Extension::extend);
  ImagePoints st(2, 2);
  st << std::numeric_limits<double>::quiet_NaN(), 0.5, 0.5, 0.5;
  const Colours colours = image.sample(st, Footprints::Constant(2, 4, 0.1));
  EXPECT_EQ(colours(0, 0), 0);
  EXPECT_NE(colours(1, 0), 0);
}

TEST(FilteredImage, SaysWhatIsWrong) {
  const float pixels[] = {0, 1, std::numeric_limits<float>::infinity(), 3};
  const auto make = [&](int width, int height, int channels) {
    return FilteredImage(pixels, width, height, channels, Extension::clip);
  };
  expectThrow<std::invalid_argument>([&] { make(2, 2, 1); }, {"pixel (0, 1)", "channel 0", "inf"});
  expectThrow<std::invalid_argument>([&] { make(0, 2, 1); }, {"0 x 2"});
  expectThrow<std::invalid_argument>([&] { make(1, 1, 5); }, {"5 channels"});
  const FilteredImage image = make(2, 1, 1);
  ImagePoints st = ImagePoints::Constant(3, 2, 0.5);
  Footprints footprint = Footprints::Zero(3, 4);
  expectThrow<std::invalid_argument>([&] { image.sample(st, footprint.topRows(2)); },
                                     {"3 rows", "2"});
  st(2, 1) = std::numeric_limits<double>::infinity();
  expectThrow<std::invalid_argument>([&] { image.sample(st, footprint); }, {"row 2", "inf"});
  st(2, 1) = 0;
  footprint(1, 3) = std::numeric_limits<double>::quiet_NaN();
  expectThrow<std::invalid_argument>([&] { image.sample(st, footprint); }, {"row 1", "nan"});
}

TEST(FilteredImage, ThreadsGiveTheSameBits) {
  const PlainImage image = noise(333, 217);
  const ImagePoints st = ImagePoints::Random(5000, 2);
  const Footprints footprint = Footprints::Random(5000, 4) * 0.1;
  const Colours one = image.filtered(Extension::mirror, 1).sample(st, footprint, 1);
  EXPECT_TRUE(one == image.filtered(Extension::mirror, 0).sample(st, footprint, 0));
  EXPECT_TRUE(one.bottomRows(7) ==
              image.filtered(Extension::mirror).sample(st.bottomRows(7), footprint.bottomRows(7)));
  EXPECT_EQ(image.filtered(Extension::clip).sample(ImagePoints(0, 2), Footprints(0, 4)).rows(), 0);
}

}  // namespace
}  // namespace limitsurf::test
