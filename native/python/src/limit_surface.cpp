// SPDX-License-Identifier: Apache-2.0
#include "limit_surface.h"

#include <memory>
#include <stdexcept>
#include <string>

#include "batches.h"
#include "bound_class.h"
#include "displacement.h"
#include "docstrings.h"
#include "edge_curves.h"
#include "fixed_samples.h"
#include "projection.h"
#include "shared_surface.h"
#include "strand_poser.h"
#include "surface_data.h"
#include "tangent_frames.h"

namespace limitsurf::python {
namespace {

Points currentPositions(const SharedSurface& shared) {
  const LongCall call(shared.lock);
  return shared.surface().positions();
}

void setPositions(SharedSurface& shared, const py::object& positions, int threads) {
  checkThreads(threads);
  Points points = pointsOf(positionRows(positions, shared.mesh->vertexCount()), threads);
  const LongCall call(shared.lock, CallLock::Access::change);
  shared.setPositions(std::move(points), threads);
}

std::shared_ptr<SharedSurface> makeSurface(const std::shared_ptr<BoundMesh>& mesh) {
  const GilRelease release;
  const InterruptionPoint point = interruptible();
  return std::make_shared<SharedSurface>(mesh);
}

py::array_t<double> bounds(const SharedSurface& shared, int threads) {
  checkThreads(threads);
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> box;
  {
    const LongCall call(shared.lock);
    box = shared.surface().bounds(threads);
  }
  return py::array_t<double>({2, 3}, box.data());
}

py::dict refused(const SharedSurface& shared) {
  py::dict reasons;
  for (const auto& [face, reason] : shared.surface().refused()) {
    reasons[py::int_(face)] = reason;
  }
  return reasons;
}

std::string representation(const SharedSurface& shared) {
  return "LimitSurface(" + std::to_string(shared.surface().faceCount()) + " Ptex faces, " +
         std::to_string(shared.surface().refused().size()) + " faces refused)";
}

py::object pickled(const SharedSurface& shared) {
  return py::make_tuple(py::cast(shared.mesh), pointArray(currentPositions(shared)));
}

std::shared_ptr<SharedSurface> unpickled(const py::object& given) {
  const py::tuple state = stateTuple(given, "LimitSurface");
  if (state.size() != 2 || !py::isinstance<BoundMesh>(state[0])) {
    throw py::value_error("no state of a LimitSurface: it is no pair of a mesh and positions");
  }
  auto shared = makeSurface(py::cast<BoundMesh&>(state[0]).shared_from_this());
  setPositions(*shared, state[1], 0);
  return shared;
}

/// What the topology alone decides.
void bindTopology(SurfaceClass& type) {
  type.def_readonly("mesh", &SharedSurface::mesh,
                    "The ControlMesh of which the surface was made, with its original positions.")
      .def_property_readonly(
          "face_count", [](const SharedSurface& s) { return s.surface().faceCount(); },
          "The number of Ptex faces.")
      .def_property_readonly(
          "base_face", [](const SharedSurface& s) { return arrayOf(s.surface().baseFace()); },
          "(face_count,) int32: the face of the mesh to which each Ptex face belongs.")
      .def_property_readonly(
          "corner", [](const SharedSurface& s) { return arrayOf(s.surface().corner()); },
          "(face_count,) int32: the corner of the n-gon to which each Ptex face belongs, 0 for "
          "quads.")
      .def_property_readonly(
          "refused", &refused,
          "dict: the reason for each face of the mesh that has no limit surface, holes included.")
      .def(
          "vertex_locations",
          [](const SharedSurface& s) { return locations(s.surface().vertexLocations()); },
          kVertexLocationsDoc);
}

/// The present pose, and what follows from it.
void bindPose(SurfaceClass& type) {
  using namespace py::literals;
  type.def_property_readonly(
          "positions",
          [](const SharedSurface& shared) { return pointArray(currentPositions(shared)); },
          "(V, 3) float64: a copy of the control mesh's present positions.")
      .def("set_positions", &setPositions, "positions"_a, "threads"_a = 0, kSetPositionsDoc)
      .def(
          "bounds", &bounds, py::kw_only(), "threads"_a = 0,
          "(2, 3) float64: the minimum and the maximum of the tightest axis-aligned box around the "
          "limit surface, with an error of at most 1e-13 of the control mesh's diagonal. NaN if "
          "there is no surface.");
}

}  // namespace

void bindLimitSurface(py::module_& module) {
  using namespace py::literals;
  auto type = boundClass<SurfaceClass>(module, "LimitSurface", kLimitSurfaceDoc);
  type.def(py::init([](BoundMesh& mesh) { return makeSurface(mesh.shared_from_this()); }),
           "mesh"_a.none(false))
      .def("__repr__", &representation)
      .def(py::pickle(&pickled, &unpickled));
  bindTopology(type);
  bindPose(type);
  bindEvaluation(type);
  bindDataMakers(type);
  bindSurfaceTiles(type);
  bindFixedSamplesMaker(type);
  bindStrandPoserMaker(type);
  bindEdgeCurveMakers(type);
  bindTangentFrames(type);
  bindTessellation(type);
  bindSearch(type);
  bindPaths(type);
  bindSampling(type);
  bindGuideWeights(type);
  bindFlow(type);
  bindProjection(type);
  bindDisplacement(type);
}

}  // namespace limitsurf::python
