// SPDX-License-Identifier: Apache-2.0
#include "displacement.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "batches.h"
#include "bound_class.h"
#include "choices.h"
#include "displacement_docstrings.h"
#include "limitsurf/displace/displacement.h"
#include "limitsurf/search/checks.h"
#include "progress.h"
#include "text.h"

namespace limitsurf::python {
namespace {

/// The number of rows displaced between two reports of the progress; Ctrl-C takes effect there.
constexpr std::size_t kRowsPerMeasuring = std::size_t{1} << 16;

const Choices<RayDirection> kDirections = {{"both", RayDirection::both},
                                           {"outward", RayDirection::outward},
                                           {"inward", RayDirection::inward}};

py::object locate(const SubdividedFaces& faces, const py::object& face, const py::object& uv,
                  int threads) {
  checkThreads(threads);
  Locations at = locationsOf(faces.baseFaceCount(), face, uv);
  {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    at = faces.locate(at, threads);
  }
  return locations(at);
}

/// The frames of `rows` locations, or none.
FrameRows framesOf(const py::object& frames, std::size_t rows) {
  if (frames.is_none()) {
    return FrameRows(0, 9);
  }
  Doubles array = doubles(frames, "frames");
  shapeEmpty(array, {0, 3, 3});
  const auto expected = static_cast<py::ssize_t>(rows);
  if (array.ndim() != 3 || array.shape(0) != expected || array.shape(1) != 3 ||
      array.shape(2) != 3) {
    throw std::invalid_argument("frames has shape " + shapeText(array) + "; expected (" +
                                std::to_string(rows) + ", 3, 3)");
  }
  return Eigen::Map<const FrameRows>(array.data(), expected, 9);
}

/// Calls body(first row, locations) for one part after the other, without the GIL.
template <typename Body>
void inParts(const CheckedLocations& at, const ProgressReport& report, const Body& body) {
  for (std::size_t begin = 0; begin < at.size(); begin += kRowsPerMeasuring) {
    const std::size_t count = std::min(kRowsPerMeasuring, at.size() - begin);
    body(begin, at.part(begin, count));
    report(static_cast<double>(begin + count) / static_cast<double>(at.size()));
  }
}

FrameRows part(const FrameRows& frames, std::size_t begin, std::size_t count) {
  if (frames.rows() == 0) {
    return frames;
  }
  return frames.middleRows(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(count));
}

py::object vectorDisplacement(const SharedSurface& base, const SharedSurface& target,
                              const py::object& face, const py::object& uv,
                              const py::object& frames, int threads, const py::object& progress) {
  checkThreads(threads);
  const ProgressReport report(progress);
  const CheckedLocations at = locationsOn(base.surface(), face, uv);
  const FrameRows all_frames = framesOf(frames, at.size());
  Output output(py::dtype("float64"), {static_cast<py::ssize_t>(at.size()), 3});
  {
    const LongCall<CallLock::HoldTwo> call(base.lock, target.lock);
    const SubdividedFaces faces(*base.mesh, *target.mesh);
    inParts(at, report, [&](std::size_t begin, const LocationBatch& some) {
      Points vectors =
          limitsurf::vectorDisplacement(base.surface(), target.surface(), faces, some, threads);
      if (all_frames.rows() > 0) {
        vectors = intoFrames(vectors, part(all_frames, begin, some.size()));
      }
      output.put(3 * begin, vectors.data(), 3 * some.size());
    });
  }
  return output.object();
}

py::object scalarDisplacement(const SharedSurface& base, const SharedSurface& target,
                              const py::object& face, const py::object& uv, double max_distance,
                              const Text& direction, int threads, const py::object& progress) {
  checkThreads(threads);
  const ProgressReport report(progress);
  const CheckedLocations at = locationsOn(base.surface(), face, uv);
  const ScalarDisplacementOptions options{max_distance,
                                          choice(direction, "direction", kDirections)};
  checkDistance(max_distance);
  Output output(py::dtype("float64"), {static_cast<py::ssize_t>(at.size())});
  {
    const LongCall<CallLock::HoldTwo> call(base.lock, target.lock);
    const SurfaceSearch& search = target.search.get(target.surface(), threads);
    inParts(at, report, [&](std::size_t begin, const LocationBatch& some) {
      const Eigen::VectorXd distances =
          limitsurf::scalarDisplacement(base.surface(), search, some, options, threads);
      output.put(begin, distances.data(), some.size());
    });
  }
  return output.object();
}

py::object displaced(const SharedSurface& shared, const py::object& face, const py::object& uv,
                     const py::object& values, const py::object& frames, int threads) {
  checkThreads(threads);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  const auto rows = static_cast<py::ssize_t>(at.size());
  Doubles array = doubles(values, "values");
  if (!frames.is_none()) {
    shapeEmpty(array, {0, 3});
  }
  const bool scalar = array.ndim() == 1;
  if (array.ndim() < 1 || array.ndim() > 2 || array.shape(0) != rows ||
      (!scalar && array.shape(1) != 3)) {
    throw std::invalid_argument("values has shape " + shapeText(array) + "; expected (" +
                                std::to_string(rows) + ", 3) or (" + std::to_string(rows) + ",)");
  }
  if (scalar && !frames.is_none()) {
    throw std::invalid_argument(
        "values are distances along the normals, which need no frames: give frames only "
        "with vectors");
  }
  const FrameRows all_frames = framesOf(frames, at.size());
  Output output(py::dtype("float64"), {rows, 3});
  inChunks(shared.lock, at, [&](std::size_t begin, const LocationBatch& chunk) {
    const double* first = array.data() + begin * (scalar ? 1 : 3);
    const auto count = static_cast<Eigen::Index>(chunk.size());
    const Points moved =
        scalar ? displacedAlongNormals(shared.surface(), chunk,
                                       Eigen::Map<const Eigen::VectorXd>(first, count), threads)
               : limitsurf::displaced(shared.surface(), chunk,
                                      Eigen::Map<const Points>(first, count, 3),
                                      part(all_frames, begin, chunk.size()), threads);
    output.put(3 * begin, moved.data(), 3 * chunk.size());
  });
  return output.object();
}

}  // namespace

void bindSubdividedFaces(py::module_& module) {
  using namespace py::literals;
  boundClass<py::class_<SubdividedFaces>>(module, "SubdividedFaces", kSubdividedFacesDoc)
      .def(py::init([](const BoundMesh& base, const BoundMesh& target) {
             const GilRelease release;
             const InterruptionPoint point = interruptible();
             return std::make_unique<SubdividedFaces>(base, target);
           }),
           "base"_a, "subdivided"_a)
      .def_property_readonly(
          "levels", [](const SubdividedFaces& b) { return b.levels(); },
          "The number of subdivisions of the base, 0 to 12.")
      .def_property_readonly(
          "order",
          [](const SubdividedFaces& b) {
            return b.order() == FaceOrder::blender ? "blender" : "opensubdiv";
          },
          "'blender' or 'opensubdiv'. Up to one level both orders are the same, and it is "
          "'blender'.")
      .def("locate", &locate, "face"_a, "uv"_a, py::kw_only(), "threads"_a = 0,
           kLocateOnSubdividedDoc)
      .def("__repr__", [](const SubdividedFaces& b) {
        return "SubdividedFaces(" + std::to_string(b.baseFaceCount()) + " Ptex faces, levels " +
               std::to_string(b.levels()) + ")";
      });
}

void bindDisplacement(SurfaceClass& type) {
  using namespace py::literals;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  type.def("vector_displacement", &vectorDisplacement, "target"_a.none(false), "face"_a, "uv"_a,
           py::kw_only(), "frames"_a = py::none(), "threads"_a = 0, "progress"_a = py::none(),
           kVectorDisplacementDoc)
      .def("scalar_displacement", &scalarDisplacement, "target"_a.none(false), "face"_a, "uv"_a,
           "max_distance"_a = kInfinity, py::kw_only(), "direction"_a = "both", "threads"_a = 0,
           "progress"_a = py::none(), kScalarDisplacementDoc)
      .def("displaced", &displaced, "face"_a, "uv"_a, "values"_a, py::kw_only(),
           "frames"_a = py::none(), "threads"_a = 0, kDisplacedDoc);
}

}  // namespace limitsurf::python
