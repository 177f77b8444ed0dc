// SPDX-License-Identifier: Apache-2.0
#include "images.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "batches.h"
#include "bound_class.h"
#include "choices.h"
#include "limitsurf/image/blend.h"
#include "limitsurf/image/filtered_image.h"
#include "limitsurf/project/box_projectors.h"
#include "matrices.h"
#include "progress.h"
#include "projection_docstrings.h"
#include "result_memory.h"
#include "text.h"

namespace limitsurf::python {
namespace {

/// The number of rows sampled between two reports of the progress; Ctrl-C takes effect there.
constexpr Eigen::Index kRowsPerSampling = Eigen::Index{1} << 18;

const Choices<Extension> kExtensions = {{"clip", Extension::clip},
                                        {"extend", Extension::extend},
                                        {"repeat", Extension::repeat},
                                        {"mirror", Extension::mirror}};
const Choices<BlendMode> kBlendModes = {
    {"mix", BlendMode::mix}, {"add", BlendMode::add}, {"multiply", BlendMode::multiply}};

[[noreturn]] void refuseShape(const py::array& array, const char* name, const char* expected) {
  throw std::invalid_argument(std::string(name) + " has shape " + shapeText(array) + "; expected " +
                              expected);
}

std::unique_ptr<FilteredImage> makeImage(const py::object& pixels, const Text& extension,
                                         Flag premultiplied, int threads) {
  const Extension beyond = choice(extension, "extension", kExtensions);
  const Floats array = floatsInRange(maskAsNumbers(pixels), "pixels");
  constexpr py::ssize_t kLargestSide = py::ssize_t{1} << 20;
  if (array.ndim() != 3 || array.size() == 0 || array.shape(2) > 4 ||
      std::max(array.shape(0), array.shape(1)) > kLargestSide) {
    refuseShape(array, "pixels",
                "(h, w, c) with at least one pixel, at most 2^20 a side, c = 1 to 4");
  }
  const GilRelease release;
  const InterruptionPoint point = interruptible();
  return std::make_unique<FilteredImage>(
      array.data(), static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)),
      static_cast<int>(array.shape(2)), beyond, premultiplied, threads);
}

py::object sample(const FilteredImage& image, const py::object& st, const py::object& footprint,
                  int threads, const py::object& progress) {
  checkThreads(threads);
  Doubles places = doubles(st, "st"), steps = doubles(footprint, "footprint");
  requireRows<std::invalid_argument>(places, "st", 2);
  shapeEmpty(steps, {0, 2, 2});
  if (steps.ndim() != 3 || steps.shape(0) != places.shape(0) || steps.shape(1) != 2 ||
      steps.shape(2) != 2) {
    refuseShape(steps, "footprint",
                ("(" + std::to_string(places.shape(0)) + ", 2, 2), as st has rows").c_str());
  }
  const ProgressReport report(progress);
  const Eigen::Index rows = places.shape(0);
  Floats out = newArray<float>({rows, Eigen::Index{image.channels()}});
  const Eigen::Map<const ImagePoints> all_places(places.data(), rows, 2);
  const Eigen::Map<const Footprints> all_steps(steps.data(), rows, 4);
  float* to = out.mutable_data();
  {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    checkSamples(all_places, all_steps);
    for (Eigen::Index begin = 0; begin < rows; begin += kRowsPerSampling) {
      const Eigen::Index count = std::min(kRowsPerSampling, rows - begin);
      const Colours part = image.sample(all_places.middleRows(begin, count),
                                        all_steps.middleRows(begin, count), threads);
      to = std::copy(part.data(), part.data() + part.size(), to);
      report(static_cast<double>(begin + count) / static_cast<double>(rows));
    }
  }
  return std::move(out);
}

py::object imageBounds(const FilteredImage& image, const py::object& boxes, int threads) {
  checkThreads(threads);
  Doubles array = doubles(boxes, "boxes");
  shapeEmpty(array, {0, 2, 2});
  if (array.ndim() != 3 || array.shape(1) != 2 || array.shape(2) != 2) {
    refuseShape(array, "boxes", "(n, 2, 2)");
  }
  ColourBounds bounds;
  {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    bounds = image.bounds(Eigen::Map<const ImageBoxes>(array.data(), array.shape(0), 4), threads);
  }
  const auto channels = static_cast<std::size_t>(image.channels());
  Floats out = newArray<float>({array.shape(0), 2, static_cast<py::ssize_t>(channels)});
  float* const to = out.mutable_data();
  forEachRow(static_cast<std::size_t>(array.shape(0)), [&](std::size_t row) {
    std::copy_n(bounds.low.data() + channels * row, channels, to + 2 * channels * row);
    std::copy_n(bounds.high.data() + channels * row, channels, to + (2 * row + 1) * channels);
  });
  return std::move(out);
}

Colours pixelRows(const py::object& object, const char* name) {
  Floats array = floats(object, name);
  requireRows<std::invalid_argument>(array, name, 4);
  Colours rows(array.shape(0), 4);
  const float* const from = array.data();
  forEachRow(static_cast<std::size_t>(array.shape(0)),
             [&](std::size_t row) { std::copy_n(from + 4 * row, 4, rows.data() + 4 * row); });
  return rows;
}

py::object blendOver(const py::object& below, const py::object& above, const py::object& weight,
                     const Text& mode, Flag premultiplied) {
  const BlendMode blend = choice(mode, "mode", kBlendModes);
  const Colours lower = pixelRows(below, "below"), upper = pixelRows(above, "above");
  const Doubles weights = doubles(maskAsNumbers(weight), "weight");
  requireVector<std::invalid_argument>(weights, "weight");
  const Eigen::Map<const Eigen::VectorXd> part(weights.data(), weights.size());
  return rowArray(
      released([&] { return limitsurf::blendOver(lower, upper, part, blend, premultiplied); }));
}

py::object boxSides(const py::object& matrix) {
  const std::array<Eigen::Matrix4d, 6> sides = limitsurf::boxSides(matrixOf(matrix, "matrix"));
  py::array_t<double> out({6, 4, 4});
  double* to = out.mutable_data();
  for (const Eigen::Matrix4d& side : sides) {
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        *to++ = side(row, column);
      }
    }
  }
  return std::move(out);
}

py::object boxWeights(const py::object& normals, double blend, const py::object& matrix) {
  Doubles array = doubles(normals, "normals");
  requireRows<std::invalid_argument>(array, "normals", 3);
  const Eigen::Matrix4d to_box = matrixOrNone(matrix, "matrix");
  const Points directions = pointsOf(array);
  return rowArray(released([&] { return limitsurf::boxWeights(directions, blend, to_box); }));
}

}  // namespace

void bindImages(py::module_& module) {
  using namespace py::literals;
  boundClass<py::class_<FilteredImage>>(module, "FilteredImage", kFilteredImageDoc)
      .def(py::init(&makeImage), "pixels"_a, "extension"_a = "clip", py::kw_only(),
           "premultiplied"_a = false, "threads"_a = 0)
      .def_property_readonly(
          "shape",
          [](const FilteredImage& b) {
            return py::make_tuple(b.height(), b.width(), b.channels());
          },
          "(h, w, c): the shape of the pixels.")
      .def("sample", &sample, "st"_a, "footprint"_a, py::kw_only(), "threads"_a = 0,
           "progress"_a = py::none(), kSampleDoc)
      .def("bounds", &imageBounds, "boxes"_a, py::kw_only(), "threads"_a = 0, kImageBoundsDoc)
      .def("__repr__", [](const FilteredImage& b) {
        return "FilteredImage(" + std::to_string(b.width()) + " x " + std::to_string(b.height()) +
               " pixels of " + std::to_string(b.channels()) + " channels)";
      });
  module.def("blend_over", &blendOver, "below"_a, "above"_a, "weight"_a, "mode"_a = "mix",
             py::kw_only(), "premultiplied"_a = false, kBlendOverDoc);
  module.def("box_sides", &boxSides, "matrix"_a, kBoxSidesDoc);
  module.def("box_weights", &boxWeights, "normals"_a, "blend"_a = 0., "matrix"_a = py::none(),
             kBoxWeightsDoc);
}

}  // namespace limitsurf::python
