// SPDX-License-Identifier: Apache-2.0
#include "projection.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "batches.h"
#include "choices.h"
#include "limitsurf/project/projection.h"
#include "matrices.h"
#include "numbers.h"
#include "progress.h"
#include "projection_docstrings.h"
#include "surface_data.h"
#include "text.h"

namespace limitsurf::python {
namespace {

/// The number of rows projected between two reports of the progress; Ctrl-C takes effect there.
constexpr std::size_t kRowsPerProjection = std::size_t{1} << 16;

const Choices<RayDirection> kRayDirections = {{"both", RayDirection::both},
                                              {"outward", RayDirection::outward},
                                              {"inward", RayDirection::inward}};

/// The numpy arrays of a projection.
class ProjectionArrays {
 public:
  explicit ProjectionArrays(py::ssize_t rows)
      : st_(py::dtype("float64"), {rows, 2}),
        footprint_(py::dtype("float64"), {rows, 2, 2}),
        weight_(py::dtype("float64"), {rows}) {}

  /// Sets rows from `begin` on. It may be called without the GIL.
  void put(std::size_t begin, const Projection& part) {
    const auto rows = static_cast<std::size_t>(part.weight.size());
    st_.put(2 * begin, part.st.data(), 2 * rows);
    footprint_.put(4 * begin, part.footprint.data(), 4 * rows);
    weight_.put(begin, part.weight.data(), rows);
  }
  py::object object() const {
    return result("Projection")(st_.object(), footprint_.object(), weight_.object());
  }

 private:
  Output st_, footprint_, weight_;
};

/// Writes body(locations) of one part after the other into the arrays, without the GIL. The lock
/// that `lock` returns is not held while the progress is reported.
template <typename Lock, typename Body>
void projectInParts(const CheckedLocations& at, const ProgressReport& report,
                    ProjectionArrays& arrays, const Lock& lock, const Body& body) {
  for (std::size_t begin = 0; begin < at.size(); begin += kRowsPerProjection) {
    const std::size_t count = std::min(kRowsPerProjection, at.size() - begin);
    {
      const auto held = lock();
      arrays.put(begin, body(at.part(begin, count)));
    }
    report(static_cast<double>(begin + count) / static_cast<double>(at.size()));
  }
}

py::object project(const SharedSurface& shared, const SharedData& uv_map, const py::object& face,
                   const py::object& uv, const py::object& matrix, const py::object& texel,
                   const py::object& facing, Flag two_sided, Flag occlusion, int samples,
                   std::optional<double> bias, double soft_edge, Flag frame,
                   const py::object& depth, const py::object& world, int threads,
                   const py::object& progress) {
  checkThreads(threads);
  const Eigen::Matrix4d projector = matrixOf(matrix, "matrix");
  ProjectOptions options;
  std::tie(options.facing_start, options.facing_end) = twoNumbers(facing, "facing");
  options.two_sided = two_sided;
  options.samples = samples;
  options.bias = bias;
  options.soft_edge = soft_edge;
  options.frame = frame;
  options.depth.reset();
  if (!depth.is_none()) {
    const auto [least, most] = twoNumbers(depth, "depth");
    options.depth = DepthRange{least, most};
  }
  options.world = matrixOrNone(world, "world");
  const auto [width, height] = twoNumbers(texel, "texel");
  const Eigen::Vector2d size(width, height);
  const SurfaceData& map = uv_map.data();
  const ProgressReport report(progress);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  ProjectionArrays arrays(static_cast<py::ssize_t>(at.size()));
  {
    const LongCall call(shared.lock);
    checkProject(shared.surface(), map, projector, size, options);
    const SurfaceSearch* occluder =
        occlusion ? &shared.search.get(shared.surface(), threads) : nullptr;
    projectInParts(
        at, report, arrays, [&] { return CallLock::Hold(uv_map.lock); },
        [&](const LocationBatch& part) {
          return limitsurf::project(shared.surface(), map, part, projector, size, occluder, options,
                                    threads);
        });
  }
  return arrays.object();
}

py::object projectAlongNormals(const SharedSurface& shared, const SharedData& uv_map,
                               const py::object& face, const py::object& uv,
                               const SharedSurface& source, const SharedData& source_map,
                               const py::object& texel, double max_distance, const Text& direction,
                               const py::object& transform, const py::object& world, int threads,
                               const py::object& progress) {
  checkThreads(threads);
  NormalProjectOptions options;
  options.max_distance = max_distance;
  options.direction = choice(direction, "direction", kRayDirections);
  options.transform = matrixOrNone(transform, "transform");
  options.world = matrixOrNone(world, "world");
  const auto [width, height] = twoNumbers(texel, "texel");
  const Eigen::Vector2d size(width, height);
  const SurfaceData &map = uv_map.data(), &other_map = source_map.data();
  const ProgressReport report(progress);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  ProjectionArrays arrays(static_cast<py::ssize_t>(at.size()));
  {
    const LongCall<CallLock::HoldTwo> call(shared.lock, source.lock);
    checkProjectAlongNormals(shared.surface(), map, source.surface(), other_map, size, options);
    const SurfaceSearch& search = source.search.get(source.surface(), threads);
    projectInParts(
        at, report, arrays, [&] { return CallLock::HoldTwo(uv_map.lock, source_map.lock); },
        [&](const LocationBatch& part) {
          return limitsurf::projectAlongNormals(shared.surface(), map, part, source.surface(),
                                                other_map, search, size, options, threads);
        });
  }
  return arrays.object();
}

bool eyeIsInside(const SharedSurface& shared, const py::object& matrix, int threads) {
  checkThreads(threads);
  const Eigen::Matrix4d projector = matrixOf(matrix, "matrix");
  const LongCall call(shared.lock);
  return limitsurf::eyeIsInside(shared.surface(), shared.search.get(shared.surface(), threads),
                                projector, threads);
}

}  // namespace

void bindProjection(SurfaceClass& type) {
  using namespace py::literals;
  const ProjectOptions defaults;
  const DepthRange depth = defaults.depth.value_or(DepthRange());
  type.def("project", &project, "uv_map"_a, "face"_a, "uv"_a, "matrix"_a, "texel"_a, py::kw_only(),
           "facing"_a = py::make_tuple(defaults.facing_start, defaults.facing_end),
           "two_sided"_a = defaults.two_sided, "occlusion"_a = true, "samples"_a = defaults.samples,
           "bias"_a = py::none(), "soft_edge"_a = defaults.soft_edge, "frame"_a = defaults.frame,
           "depth"_a = py::make_tuple(depth.near, depth.far), "world"_a = py::none(),
           "threads"_a = 0, "progress"_a = py::none(), kProjectDoc)
      .def("project_along_normals", &projectAlongNormals, "uv_map"_a, "face"_a, "uv"_a, "source"_a,
           "source_map"_a, "texel"_a, py::kw_only(),
           "max_distance"_a = std::numeric_limits<double>::infinity(), "direction"_a = "both",
           "transform"_a = py::none(), "world"_a = py::none(), "threads"_a = 0,
           "progress"_a = py::none(), kProjectAlongNormalsDoc)
      .def("eye_is_inside", &eyeIsInside, "matrix"_a, py::kw_only(), "threads"_a = 0,
           kEyeIsInsideDoc);
}

}  // namespace limitsurf::python
