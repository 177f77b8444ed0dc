// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "fuzz/random_mesh.h"
#include "fuzz/require.h"
#include "fuzz/targets.h"
#include "limitsurf/image/filtered_image.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/surface/tangent_frames.h"
#include "limitsurf/uv/map_distortion.h"
#include "limitsurf/uv/uv_map.h"

namespace limitsurf::fuzz {
namespace {

constexpr int kLocations = 8, kPoints = 8, kSamples = 6, kMostPixels = 9;

/// A map with a value for each corner of the mesh's faces, or for fewer corners with seams between
/// them.
std::unique_ptr<SurfaceData> readMap(ByteReader& bytes, const LimitSurface& surface) {
  std::int64_t corners = 0;
  for (const int size : surface.mesh().faceSizes()) {
    corners += size;
  }
  const int rows = 1 + bytes.below(40);
  DataRows values(rows, 2);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values.data()[i] = bytes.coordinate();
  }
  std::vector<std::int64_t> indices;
  const bool any = bytes.flag();
  for (std::int64_t i = 0; i < corners; ++i) {
    indices.push_back(any ? bytes.below(rows + 1) : i % rows);
  }
  const auto interpolation = static_cast<Interpolation>(bytes.below(6));
  std::unique_ptr<SurfaceData> map;
  accepts([&] {
    map = std::make_unique<SurfaceData>(surface.faceVarying(values, indices, interpolation, 1));
  });
  return map;
}

/// Boxes of squares hold what is evaluated on them.
void checkDataBounds(const SurfaceData& data, const std::vector<Location>& at, int side) {
  accepts([&] {
    const DataRows value = data.evaluate(at, Derivatives::none, 1).value;
    const DataBounds boxes = data.bounds(side, 1);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto square = [side](double x) {
        return std::min(static_cast<Eigen::Index>(x * side), static_cast<Eigen::Index>(side - 1));
      };
      const Eigen::Index box = (at[i].face * side + square(at[i].v)) * side + square(at[i].u);
      const auto row = value.row(static_cast<Eigen::Index>(i)).array();
      require(
          (row >= boxes.low.row(box).array()).all() && (row <= boxes.high.row(box).array()).all(),
          "a value lies in its square's box");
    }
  });
}

void checkMap(ByteReader& bytes, const LimitSurface& surface) {
  const std::unique_ptr<SurfaceData> data = readMap(bytes, surface);
  if (!data) {
    return;
  }
  const std::vector<Location> at = readLocations(bytes, surface, kLocations);
  accepts([&] {
    require(data->evaluate(at, Derivatives::first, 1).value.allFinite(), "values are finite");
    require(tangentFrames(surface, *data, at, 1).allFinite(), "tangent frames are finite");
    mapDistortion(surface, *data, at, 1);
  });
  accepts([&] {
    const UvMap map(*data, 1);
    PlanePoints points(kPoints, 2);
    for (Eigen::Index i = 0; i < points.size(); ++i) {
      points.data()[i] = bytes.coordinate();
    }
    const MapLocations found = map.locate(points, 1);
    require(static_cast<Eigen::Index>(found.at.size()) == points.rows(), "a place for each point");
    RasterOptions options;
    options.width = 1 + bytes.below(24);
    options.height = 1 + bytes.below(24);
    options.margin = bytes.below(4);
    const Texels texels = map.rasterize(options, 1);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const auto& uv = texels.uv[i];
      require(uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1, "a texel has a location");
      require(texels.x[i] >= 0 && texels.x[i] < options.width && texels.y[i] >= 0 &&
                  texels.y[i] < options.height,
              "a texel is in the image");
    }
  });
  checkDataBounds(*data, at, 1 + bytes.below(5));
}

/// Bounds of an image hold what is sampled at the corners of a box and in its middle.
void checkImageBounds(const FilteredImage& image, const ImagePoints& corners) {
  accepts([&] {
    ImageBoxes box(1, 4);
    box << corners.topRows(2).colwise().minCoeff(), corners.topRows(2).colwise().maxCoeff();
    const ColourBounds bounds = image.bounds(box, 1);
    ImagePoints st(3, 2);
    st << box.leftCols(2), box.rightCols(2), 0.5 * box.leftCols(2) + 0.5 * box.rightCols(2);
    const Colours colours = image.sample(st, Footprints::Zero(3, 4), 1);
    for (Eigen::Index i = 0; i < 3; ++i) {
      require((colours.row(i).array() >= bounds.low.row(0).array()).all() &&
                  (colours.row(i).array() <= bounds.high.row(0).array()).all(),
              "a colour lies within the bounds of its box");
    }
  });
}

void checkImage(ByteReader& bytes) {
  const int width = bytes.below(kMostPixels), height = bytes.below(kMostPixels),
            channels = bytes.below(6);
  std::vector<float> pixels(static_cast<std::size_t>(width * height * channels));
  for (float& value : pixels) {
    const int kind = bytes.byte();
    value = kind < 250 ? static_cast<float>(kind) / 249.f : static_cast<float>(bytes.anyDouble());
  }
  const auto extension = static_cast<Extension>(bytes.below(4));
  const bool premultiplied = bytes.flag();
  ImagePoints st(kSamples, 2);
  Footprints footprint(kSamples, 4);
  for (Eigen::Index i = 0; i < st.size(); ++i) {
    st.data()[i] = bytes.coordinate();
  }
  for (Eigen::Index i = 0; i < footprint.size(); ++i) {
    footprint.data()[i] = bytes.coordinate();
  }
  accepts([&] {
    const FilteredImage image(pixels.data(), width, height, channels, extension, premultiplied, 1);
    require(image.sample(st, footprint, 1).allFinite(), "colours are finite");
    if (!st.hasNaN()) {
      checkImageBounds(image, st);
    }
  });
}

}  // namespace

void mapTarget(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  if (bytes.below(3) == 0) {
    checkImage(bytes);
    return;
  }
  if (const std::unique_ptr<LimitSurface> surface = readSurface(bytes)) {
    checkMap(bytes, *surface);
  }
}

}  // namespace limitsurf::fuzz
