// SPDX-License-Identifier: Apache-2.0
#include "ptex_layout.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "batches.h"
#include "bound_class.h"
#include "limitsurf/displace/ptex_layout.h"
#include "limitsurf/image/bilinear_image.h"
#include "result_memory.h"

namespace limitsurf::python {
namespace {

constexpr const char* kPtexLayoutDoc =
    R"(The layout of an image that holds a square tile for each Ptex face, so that no UV map is needed.

A tile has resolution + 1 pixels a side, where resolution is a power of two; pixel (i, j) holds the value
at (u, v) = (i, j) / resolution. The values along the sides of a face stand in the tiles of all faces that
meet there, so that bilinear interpolation within a tile needs no neighbouring tile and is continuous from
face to face, with one exception: two sub-faces of an n-gon that meet the side of a quad have twice as many
pixels along it, so there the values agree at the pixels of the quad, and differ between them. Tiles stand in rows of `columns` from the lower left corner of the image: the tile of face f
begins at the pixel (f % columns, f // columns) * (resolution + 1).
A layout cannot be copied or pickled.

    layout = limitsurf.PtexLayout(surface.face_count, 64)
    texels = layout.texels()                              # .x .y .face .uv of every pixel
    pixels[texels.y, texels.x] = ...                      # (layout.height, layout.width, 3)
    limitsurf.bilinear(pixels, layout.map_coordinates(face, uv))      # reads it back
)";

constexpr const char* kTexelsDoc =
    R"(All pixels of all tiles, face after face: PtexTexels.

.x and .y (upwards) are (n,) int32; .face (n,) int32 and .uv (n, 2) float64 are the pixels' locations.)";

constexpr const char* kMapCoordinatesDoc =
    R"((n, 2) float64: the image coordinates of locations, with (0, 0) at the lower left corner of the image
and (1, 1) at the upper right one.

As the UVs of a mesh they make a renderer read the image; it must filter linearly and without mipmaps.
Raises LocationError for a face that is not in the layout.)";

constexpr const char* kBilinearDoc =
    R"(Values of an image at any place, interpolated bilinearly in double precision.

Parameters
----------
pixels : (h, w, c) array of float
    Rows from the lower left corner upwards, as in Blender's images; values are rounded to float32.
st : (n, 2) array of float
    Places, with (0, 0) at the lower left corner of the image and (1, 1) at the upper right one. The
    centre of the first pixel is half a pixel inside. Beyond the outermost centres the value is the
    nearest one on their border.

Returns
-------
(n, c) float64.

Raises ValueError for arrays of other shapes and naming the first place that is not finite.
)";

py::object texels(const PtexLayout& layout) {
  const std::vector<PtexLayout::Pixel> pixels = released([&] { return layout.pixels(); });
  const Locations at = released([&] { return layout.locations(); });
  const auto rows = static_cast<py::ssize_t>(at.size());
  auto x = newArray<int>({rows}), y = newArray<int>({rows}), face = newArray<int>({rows});
  auto uv = newArray<double>({rows, 2});
  int *const to_x = x.mutable_data(), *const to_y = y.mutable_data();
  int* const to_face = face.mutable_data();
  double* const to_uv = uv.mutable_data();
  forEachRow(at.size(), [&](std::size_t i) {
    to_x[i] = pixels[i].x;
    to_y[i] = pixels[i].y;
    to_face[i] = at[i].face;
    to_uv[2 * i] = at[i].u;
    to_uv[2 * i + 1] = at[i].v;
  });
  return result("PtexTexels")(x, y, face, uv);
}

py::array_t<double> mapCoordinates(const PtexLayout& layout, const py::object& face,
                                   const py::object& uv) {
  const Locations at = locationsOf(layout.faces(), face, uv);
  return rowArray(released([&] { return layout.mapCoordinates(at); }));
}

py::array_t<double> bilinear(const py::object& pixels, const py::object& st, int threads) {
  checkThreads(threads);
  const Floats values = floats(maskAsNumbers(pixels), "pixels");
  if (values.ndim() != 3 || values.size() == 0) {
    throw std::invalid_argument("pixels has shape " + shapeText(values) +
                                "; expected (h, w, c), none of them 0");
  }
  Doubles places = doubles(st, "st");
  requireRows<std::invalid_argument>(places, "st", 2);
  const BilinearImage image{values.data(), static_cast<int>(values.shape(1)),
                            static_cast<int>(values.shape(0)), static_cast<int>(values.shape(2))};
  const Eigen::Map<const BilinearImage::Places> at(places.data(), places.shape(0), 2);
  return rowArray(released([&] { return image.sample(at, threads); }));
}

}  // namespace

void bindPtexLayout(py::module_& module) {
  using namespace py::literals;
  boundClass<py::class_<PtexLayout>>(module, "PtexLayout", kPtexLayoutDoc)
      .def(py::init<int, int>(), "face_count"_a, "resolution"_a)
      .def_property_readonly(
          "face_count", [](const PtexLayout& b) { return b.faces(); }, "The number of Ptex faces.")
      .def_property_readonly(
          "resolution", [](const PtexLayout& b) { return b.resolution(); },
          "The number of pixels along the side of a tile, less one.")
      .def_property_readonly(
          "columns", [](const PtexLayout& b) { return b.columns(); },
          "The number of tiles in a row: the square root of their number, rounded up.")
      .def_property_readonly(
          "width", [](const PtexLayout& b) { return b.width(); },
          "The width of the image, in pixels.")
      .def_property_readonly(
          "height", [](const PtexLayout& b) { return b.height(); },
          "The height of the image, in pixels.")
      .def("texels", &texels, kTexelsDoc)
      .def("map_coordinates", &mapCoordinates, "face"_a, "uv"_a, kMapCoordinatesDoc)
      .def("__repr__", [](const PtexLayout& b) {
        return "PtexLayout(" + std::to_string(b.faces()) + " faces, resolution " +
               std::to_string(b.resolution()) + ")";
      });
  module.def("bilinear", &bilinear, "pixels"_a, "st"_a, py::kw_only(), "threads"_a = 0,
             kBilinearDoc);
}

}  // namespace limitsurf::python
