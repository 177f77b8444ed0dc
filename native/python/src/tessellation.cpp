// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/tessellate/tessellation.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "batches.h"
#include "docstrings.h"
#include "limitsurf/tessellate/tessellated_face.h"
#include "limitsurf/tessellate/tessellation_levels.h"
#include "progress.h"
#include "result_memory.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

constexpr std::int64_t kLargestInt = std::numeric_limits<int>::max();

[[noreturn]] void refuseLevel(const std::string& name, const std::string& value, int least) {
  throw std::invalid_argument(name + " is " + value + "; expected " + std::to_string(least) +
                              " to " + std::to_string(kMostTessellationLevels));
}

bool isInt(std::int64_t level) { return level >= -kLargestInt && level <= kLargestInt; }

/// The least level that all faces may have.
int leastLevel(const ControlMesh& mesh) {
  for (int face = 0; face < mesh.faceCount(); ++face) {
    if (mesh.faceSize(face) != 4) {
      return 1;
    }
  }
  return 0;
}

Tessellation tessellation(const SharedSurface& shared, const py::object& levels,
                          const TessellationOptions& options) {
  if (const py::object one = integerOf(levels)) {
    int overflow = 0;
    const std::int64_t wide = PyLong_AsLongLongAndOverflow(one.ptr(), &overflow);
    if (overflow != 0 || !isInt(wide)) {
      refuseLevel("levels", valueText(levels), leastLevel(*shared.mesh));
    }
    const int level = static_cast<int>(wide);
    const LongCall call(shared.lock);
    return tessellate(shared.surface(), level, options);
  }
  const Integers each = integers<std::invalid_argument>(levels, "levels");
  requireVector<std::invalid_argument>(each, "levels");
  std::vector<int> of_faces(static_cast<std::size_t>(each.size()));
  for (py::ssize_t face = 0; face < each.size(); ++face) {
    const std::int64_t level = each.data()[face];
    const int own = static_cast<int>(face);
    const bool is_int = isInt(level);
    if (!is_int && own < shared.mesh->faceCount() && !shared.surface().refused().count(own)) {
      refuseLevel("levels[" + std::to_string(face) + "]", std::to_string(level),
                  shared.mesh->faceSize(own) == 4 ? 0 : 1);
    }
    of_faces[static_cast<std::size_t>(face)] = is_int ? static_cast<int>(level) : 0;
  }
  const LongCall call(shared.lock);
  return tessellate(shared.surface(), std::move(of_faces), options);
}

/// The polygons as rows of four corners; the rows of triangles end in -1.
py::array_t<int> facesOf(const Tessellation& t) {
  const auto count = static_cast<py::ssize_t>(t.face_sizes.size());
  auto faces = newArray<int>({count, 4});
  const int* corner = t.face_vertices.data();
  int* row = faces.mutable_data();
  forEachRow(t.face_sizes.size(), [&](std::size_t face) {
    row[3] = -1;
    row = std::copy_n(corner, t.face_sizes[face], row) + (4 - t.face_sizes[face]);
    corner += t.face_sizes[face];
  });
  return faces;
}

py::array_t<float> cornerUvs(const Tessellation& t) {
  auto uvs = newArray<float>({static_cast<py::ssize_t>(t.corners.size()), 2});
  float* to = uvs.mutable_data();
  forEachRow(t.corners.size(), [&](std::size_t i) {
    *to++ = static_cast<float>(t.corners[i].u) / Tessellation::Corner::kSteps;
    *to++ = static_cast<float>(t.corners[i].v) / Tessellation::Corner::kSteps;
  });
  return uvs;
}

py::object tessellate(const SharedSurface& shared, const py::object& levels, Flag corner_normals,
                      int threads, const py::object& progress) {
  checkThreads(threads);
  TessellationOptions options{threads, corner_normals, ProgressReport(progress)};
  Tessellation t = tessellation(shared, levels, options);
  const py::object faces = facesOf(t), uvs = cornerUvs(t),
                   normals = corner_normals ? py::object(pointArray(std::move(t.corner_normals)))
                                            : py::object(py::none());
  return result("Tessellation")(
      pointArray(std::move(t.positions)), pointArray(std::move(t.normals)), faces,
      locations(t.locations), arrayOf(std::move(t.face_sizes)), arrayOf(std::move(t.face_vertices)),
      arrayOf(std::move(t.base_face)), arrayOf(std::move(t.ptex_face)), uvs, normals);
}

py::object faceLevels(const FaceLevels& found) {
  return result("FaceLevels")(arrayOf(found.levels),
                              py::array_t<double>(found.measure.size(), found.measure.data()));
}

py::object levelsWithin(const SharedSurface& shared, double tolerance, int most, int threads,
                        const py::object& progress) {
  const LevelOptions options{most, threads, ProgressReport(progress)};
  FaceLevels found;
  {
    const LongCall call(shared.lock);
    found = limitsurf::levelsWithin(shared.surface(), tolerance, options);
  }
  return faceLevels(found);
}

PictureView viewOf(const py::object& matrix, double nearest) {
  const Doubles array = doubles(matrix, "matrix");
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) {
    throw std::invalid_argument("matrix has shape " + shapeText(array) + "; expected (4, 4)");
  }
  PictureView view;
  view.matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data());
  view.nearest = nearest;
  return view;
}

py::object levelsOfLength(const SharedSurface& shared, double length, const py::object& matrix,
                          double nearest, int most, int threads, const py::object& progress) {
  const LevelOptions options{most, threads, ProgressReport(progress)};
  const bool in_picture = !matrix.is_none();
  const PictureView view = in_picture ? viewOf(matrix, nearest) : PictureView();
  FaceLevels found;
  {
    const LongCall call(shared.lock);
    found =
        limitsurf::levelsOfLength(shared.surface(), length, in_picture ? &view : nullptr, options);
  }
  return faceLevels(found);
}

}  // namespace

void bindTessellation(SurfaceClass& type) {
  using namespace py::literals;
  type.def("tessellate", &tessellate, "levels"_a, py::kw_only(), "corner_normals"_a = false,
           "threads"_a = 0, "progress"_a = py::none(), kTessellateDoc)
      .def("levels_within", &levelsWithin, "tolerance"_a, "most"_a = LevelOptions().most,
           py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), kLevelsWithinDoc)
      .def("levels_of_length", &levelsOfLength, "length"_a, "matrix"_a = py::none(),
           "nearest"_a = 0.0, "most"_a = LevelOptions().most, py::kw_only(), "threads"_a = 0,
           "progress"_a = py::none(), kLevelsOfLengthDoc);
}

}  // namespace limitsurf::python
