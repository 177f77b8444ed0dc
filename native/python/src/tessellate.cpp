// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "batches.h"
#include "docstrings.h"
#include "progress.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

bool isOneNumber(const py::object& object) {
  return PyIndex_Check(object.ptr()) &&
         !(py::isinstance<py::array>(object) && py::cast<py::array>(object).ndim() > 0);
}

int levelOf(std::int64_t level) {
  return static_cast<int>(std::clamp<std::int64_t>(level, std::numeric_limits<int>::min(),
                                                   std::numeric_limits<int>::max()));
}

Tessellation tessellation(const SharedSurface& shared, const py::object& levels,
                          const TessellationOptions& options) {
  if (isOneNumber(levels)) {
    const int level = levelOf(py::cast<std::int64_t>(py::int_(levels)));
    const py::gil_scoped_release release;
    const HeldPose held(shared);
    const InterruptionPoint point = interruptible();
    return shared.surface().tessellate(level, options);
  }
  const Integers each = integers<std::invalid_argument>(levels, "levels");
  requireVector<std::invalid_argument>(each, "levels");
  std::vector<int> of_faces(static_cast<std::size_t>(each.size()));
  std::transform(each.data(), each.data() + each.size(), of_faces.begin(), levelOf);
  const py::gil_scoped_release release;
  const HeldPose held(shared);
  const InterruptionPoint point = interruptible();
  return shared.surface().tessellate(std::move(of_faces), options);
}

py::array_t<double> pointArray(const Points& points) {
  return py::array_t<double>({points.rows(), Eigen::Index{3}}, points.data());
}

/// Rows of four corners; those of triangles end in -1.
py::array_t<int> facesOf(const Tessellation& t) {
  const auto count = static_cast<py::ssize_t>(t.face_sizes.size());
  py::array_t<int> faces({count, py::ssize_t{4}});
  const int* corner = t.face_vertices.data();
  int* row = faces.mutable_data();
  for (const int size : t.face_sizes) {
    row[3] = -1;
    std::copy(corner, corner + size, row);
    corner += size;
    row += 4;
  }
  return faces;
}

py::array_t<float> cornerUvs(const Tessellation& t) {
  py::array_t<float> uvs({static_cast<py::ssize_t>(t.corners.size()), py::ssize_t{2}});
  float* to = uvs.mutable_data();
  for (const Tessellation::Corner& corner : t.corners) {
    *to++ = static_cast<float>(corner.u) / Tessellation::Corner::kSteps;
    *to++ = static_cast<float>(corner.v) / Tessellation::Corner::kSteps;
  }
  return uvs;
}

py::object tessellate(const SharedSurface& shared, const py::object& levels, bool corner_normals,
                      int threads, const py::object& progress) {
  checkThreads(threads);
  TessellationOptions options{threads, corner_normals, ProgressReport(progress)};
  const Tessellation t = tessellation(shared, levels, options);
  const py::object normals =
      corner_normals ? py::object(pointArray(t.corner_normals)) : py::object(py::none());
  return result("Tessellation")(pointArray(t.positions), pointArray(t.normals), facesOf(t),
                                locations(t.locations), arrayOf(t.face_sizes),
                                arrayOf(t.face_vertices), arrayOf(t.base_face),
                                arrayOf(t.ptex_face), cornerUvs(t), normals);
}

}  // namespace

void bindTessellate(py::class_<SharedSurface>& type) {
  using namespace py::literals;
  type.def("tessellate", &tessellate, "levels"_a, py::kw_only(), "corner_normals"_a = false,
           "threads"_a = 0, "progress"_a = py::none(), kTessellateDoc);
}

}  // namespace limitsurf::python
