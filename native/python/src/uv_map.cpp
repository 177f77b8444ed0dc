// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_map.h"

#include <limits>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "batches.h"
#include "docstrings.h"
#include "progress.h"
#include "surface_data.h"

namespace limitsurf::python {
namespace {

/// The number of points searched between two reports of the progress; Ctrl-C takes effect there.
constexpr Eigen::Index kRowsPerLookup = Eigen::Index{1} << 12;

/// The result of use(uv map), called without the GIL. The values do not change meanwhile.
template <typename Use>
auto withMap(const SharedData& shared, int threads, const Use& use) {
  checkThreads(threads);
  const SurfaceData& data = shared.data();
  const LongCall call(shared.lock);
  return use(shared.uv_map.get(data, threads));
}

/// An array that takes over the elements of a vector, without a copy. Its type is `Shown`; a T that
/// consists of several becomes a row.
template <typename Shown, typename T, typename Allocator>
py::array_t<Shown> taken(std::vector<T, Allocator>&& from) {
  // T may be Shown itself
  constexpr auto kColumns =
      static_cast<py::ssize_t>(sizeof(T) / sizeof(Shown));  // NOLINT(bugprone-sizeof-expression)
  auto owned = std::make_unique<std::vector<T, Allocator>>(std::move(from));
  const auto rows = static_cast<py::ssize_t>(owned->size());
  const auto* data = reinterpret_cast<const Shown*>(owned->data());
  const py::capsule owner(owned.get(),
                          [](void* all) { delete static_cast<std::vector<T, Allocator>*>(all); });
  owned.release();
  return kColumns == 1 ? py::array_t<Shown>({rows}, data, owner)
                       : py::array_t<Shown>({rows, kColumns}, data, owner);
}

template <typename Allocator>
py::array_t<bool> flags(std::vector<std::uint8_t, Allocator>&& from) {
  return taken<bool>(std::move(from));
}

py::object rasterize(const SharedData& shared, int width, int height, const py::object& tile,
                     double margin, int threads, const py::object& progress) {
  const ProgressReport report(progress);
  const Progress tell = progress.is_none() ? Progress() : Progress(report);
  RasterOptions options;
  options.width = width;
  options.height = height;
  std::tie(options.tile_x, options.tile_y) = twoIntegers(tile, "tile");
  options.margin = margin;
  Texels texels = withMap(shared, threads,
                          [&](const UvMap& map) { return map.rasterize(options, threads, tell); });
  return result("Texels")(taken<int>(std::move(texels.x)), taken<int>(std::move(texels.y)),
                          taken<int>(std::move(texels.face)), taken<double>(std::move(texels.uv)),
                          flags(std::move(texels.inside)), flags(std::move(texels.overlap)),
                          flags(std::move(texels.flipped)));
}

PlanePoints planePoints(const py::object& object) {
  Doubles array = doubles(object, "points");
  requireRows<std::invalid_argument>(array, "points", 2);
  return Eigen::Map<const PlanePoints>(array.data(), array.shape(0), 2);
}

py::object locate(const SharedData& shared, const py::object& points, int threads,
                  const py::object& progress) {
  const ProgressReport report(progress);
  const PlanePoints all = planePoints(points);
  checkPoints(all);
  const Eigen::Index rows = all.rows();
  MapLocations found;
  withMap(shared, threads, [&](const UvMap& map) {
    for (Eigen::Index begin = 0; begin < rows; begin += kRowsPerLookup) {
      const Eigen::Index count = std::min(kRowsPerLookup, rows - begin);
      const MapLocations part = map.locate(all.middleRows(begin, count), threads);
      found.at.insert(found.at.end(), part.at.begin(), part.at.end());
      found.overlap.insert(found.overlap.end(), part.overlap.begin(), part.overlap.end());
      found.flipped.insert(found.flipped.end(), part.flipped.begin(), part.flipped.end());
      report(static_cast<double>(begin + count) / static_cast<double>(rows));
    }
    return true;
  });
  const py::object at = locations(found.at);
  return result("MapLocations")(at.attr("face"), at.attr("uv"), flags(std::move(found.overlap)),
                                flags(std::move(found.flipped)));
}

}  // namespace

void bindUvMap(py::class_<SharedData>& type) {
  using namespace py::literals;
  type.def("rasterize", &rasterize, "width"_a, "height"_a, "tile"_a = py::make_tuple(0, 0),
           "margin"_a = 0., py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           kRasterizeDoc)
      .def("locate", &locate, "points"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           kLocateDoc);
}

}  // namespace limitsurf::python
