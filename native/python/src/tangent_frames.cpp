// SPDX-License-Identifier: Apache-2.0
#include "tangent_frames.h"

#include "arrays.h"
#include "batches.h"
#include "limitsurf/surface/shading_frames.h"
#include "limitsurf/surface/tangent_frames.h"
#include "limitsurf/uv/map_distortion.h"
#include "surface_data.h"

namespace limitsurf::python {
namespace {

constexpr const char* kTangentFramesDoc =
    R"((n, 3, 3) frames of tangent-space normals and displacements for a UV map.

uv_map is a SurfaceData of two columns (U, V) on this surface. The columns of a frame are

- tangent: dP/dU made perpendicular to the normal, a unit vector;
- bitangent: sign * normal x tangent, with sign -1 where the map is mirrored, else 1;
- normal: that of the limit surface.

MikkTSpace's frames converge to these as a mesh on the limit surface is tessellated ever more finely.
Frames are always finite: at an irregular vertex the tangent is that 2^-20 inside the face; where the
map or the surface is singular the frame is that of frames().

Raises ValueError for a map that has other than two columns or another number of Ptex faces than the
surface, and the errors of evaluate(). A map of another surface with as many Ptex faces is not noticed.
Cost: two evaluations a location.
)";

constexpr const char* kMapDistortionDoc =
    R"(The distortion of a UV map: MapDistortion.

uv_map is a SurfaceData of two columns (U, V) on this surface. .area (n,) is the area of the surface per
area of the map; .stretch_high and .stretch_low (n,) are the largest and the smallest length on the
surface per length on the map, which are the singular values of dP/d(U, V). Where the map is singular
they are inf, inf and NaN. At an irregular vertex they are those 2^-20 inside the face.

Raises the errors of tangent_frames(). Cost: two evaluations a location.
)";

py::object tangentFrames(const SharedSurface& shared, const SharedData& uv_map,
                         const py::object& face, const py::object& uv, int threads,
                         const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  const SurfaceData& map = uv_map.data();
  Output output(type, {static_cast<py::ssize_t>(at.size()), 3, 3});
  inChunks(shared.lock, at, [&](std::size_t begin, const LocationBatch& chunk) {
    const CallLock::Hold hold(uv_map.lock);
    const auto frames = limitsurf::tangentFrames(shared.surface(), map, chunk, threads);
    output.put(9 * begin, frames.data(), 9 * chunk.size());
  });
  return output.object();
}

py::object mapDistortion(const SharedSurface& shared, const SharedData& uv_map,
                         const py::object& face, const py::object& uv, int threads,
                         const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  const SurfaceData& map = uv_map.data();
  Output outputs[3];  // area, stretch_high, stretch_low
  for (Output& output : outputs) {
    output = Output(type, {static_cast<py::ssize_t>(at.size())});
  }
  inChunks(shared.lock, at, [&](std::size_t begin, const LocationBatch& chunk) {
    const CallLock::Hold hold(uv_map.lock);
    const MapDistortion d = limitsurf::mapDistortion(shared.surface(), map, chunk, threads);
    const Eigen::VectorXd* values[3] = {&d.area, &d.stretch_high, &d.stretch_low};
    for (int i = 0; i < 3; ++i) {
      outputs[i].put(begin, values[i]->data(), chunk.size());
    }
  });
  return result("MapDistortion")(outputs[0].object(), outputs[1].object(), outputs[2].object());
}

constexpr const char* kIntoShadingFramesDoc =
    R"((n, 3) unit vectors: directions (n, 3) as the vectors of a tangent-space normal map.

The map is for renderers whose frames, interpolated from the corners of polygons, are normals (n, 3),
tangents (n, 3) of any length and the signs (n,) of the bitangents. The result is (0, 0, 1) where such a
frame is singular. Raises ValueError for arrays of other shapes.
)";
constexpr const char* kOutOfShadingFramesDoc =
    R"((n, 3) unit vectors: the directions that renderers read from the vectors of a tangent-space normal map.

This is the inverse of into_shading_frames(), with the same parameters and errors.
)";

/// Calls `convert`, which is intoShadingFrames() or outOfShadingFrames().
template <Points (*convert)(const Points&, const ShadingFrames&)>
py::object throughShadingFrames(const py::object& directions, const py::object& normals,
                                const py::object& tangents, const py::object& signs) {
  const Points from = rowsOfThree(directions, "vectors");
  const Doubles sign = doubles(signs, "signs");
  if (sign.ndim() != 1) {
    throw py::value_error("signs has shape " + shapeText(sign) + "; expected (n,)");
  }
  const ShadingFrames frames{rowsOfThree(normals, "normals"), rowsOfThree(tangents, "tangents"),
                             Eigen::Map<const Eigen::VectorXd>(sign.data(), sign.shape(0))};
  return pointArray(released([&] { return convert(from, frames); }));
}

}  // namespace

void bindShadingFrames(py::module_& module) {
  using namespace py::literals;
  module.def("into_shading_frames", &throughShadingFrames<&intoShadingFrames>, "vectors"_a,
             "normals"_a, "tangents"_a, "signs"_a, kIntoShadingFramesDoc);
  module.def("out_of_shading_frames", &throughShadingFrames<&outOfShadingFrames>, "vectors"_a,
             "normals"_a, "tangents"_a, "signs"_a, kOutOfShadingFramesDoc);
}

void bindTangentFrames(SurfaceClass& type) {
  using namespace py::literals;
  const py::object float64 = py::dtype("float64");
  type.def("tangent_frames", &tangentFrames, "uv_map"_a, "face"_a, "uv"_a, py::kw_only(),
           "threads"_a = 0, "dtype"_a = float64, kTangentFramesDoc)
      .def("map_distortion", &mapDistortion, "uv_map"_a, "face"_a, "uv"_a, py::kw_only(),
           "threads"_a = 0, "dtype"_a = float64, kMapDistortionDoc);
}

}  // namespace limitsurf::python
