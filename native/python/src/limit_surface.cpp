// SPDX-License-Identifier: Apache-2.0
#include "limit_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <shared_mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "arrays.h"
#include "bake.h"
#include "batches.h"
#include "choices.h"
#include "displacement.h"
#include "docstrings.h"
#include "limitsurf/sample/area.h"
#include "limitsurf/sample/jittered.h"
#include "projection.h"
#include "shared_surface.h"
#include "surface_data.h"

namespace limitsurf::python {
namespace {

py::object evaluate(const SharedSurface& shared, const py::object& face, const py::object& uv,
                    int derivatives, int threads, const py::object& dtype) {
  checkDerivatives(derivatives, 2);
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  const auto rows = static_cast<py::ssize_t>(at.size());
  // position, du, dv, normal, duu, duv, dvv
  Output outputs[7];
  const int wanted = derivatives == 0 ? 1 : derivatives == 1 ? 4 : 7;
  for (int i = 0; i < wanted; ++i) {
    outputs[i] = Output(type, {rows, 3});
  }
  inChunks(shared.mutex, at, [&](std::size_t begin, const LocationBatch& chunk) {
    const Evaluation e = shared.surface().evaluate(chunk, static_cast<Derivatives>(derivatives),
                                                   derivatives > 0, threads);
    const Points* values[7] = {&e.position, &e.du, &e.dv, &e.normal, &e.duu, &e.duv, &e.dvv};
    for (int i = 0; i < wanted; ++i) {
      outputs[i].put(3 * begin, values[i]->data(), 3 * chunk.size());
    }
  });
  return result("Evaluation")(outputs[0].object(), outputs[1].object(), outputs[2].object(),
                              outputs[4].object(), outputs[5].object(), outputs[6].object(),
                              outputs[3].object());
}

py::object frames(const SharedSurface& shared, const py::object& face, const py::object& uv,
                  int threads, const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  Output output(type, {static_cast<py::ssize_t>(at.size()), 3, 3});
  inChunks(shared.mutex, at, [&](std::size_t begin, const LocationBatch& chunk) {
    const auto rotations = shared.surface().frames(chunk, threads);
    output.put(9 * begin, rotations.data(), 9 * chunk.size());
  });
  return output.object();
}

py::object curvature(const SharedSurface& shared, const py::object& face, const py::object& uv,
                     const std::string& irregular, double radius, int threads,
                     const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const IrregularRule rule = choice<IrregularRule>(
      irregular, "irregular", {{"none", IrregularRule::none}, {"average", IrregularRule::average}});
  checkCurvatureRadius(radius);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  const auto rows = static_cast<py::ssize_t>(at.size());
  Output scalars[4], directions[2];
  for (Output& output : scalars) {
    output = Output(type, {rows});
  }
  for (Output& output : directions) {
    output = Output(type, {rows, 3});
  }
  py::array_t<bool> is_irregular(rows);
  bool* flags = is_irregular.mutable_data();
  inChunks(shared.mutex, at, [&](std::size_t begin, const LocationBatch& chunk) {
    const Curvature c = shared.surface().curvature(chunk, rule, radius, threads);
    const Eigen::VectorXd* values[4] = {&c.gaussian, &c.mean, &c.k1, &c.k2};
    for (int i = 0; i < 4; ++i) {
      scalars[i].put(begin, values[i]->data(), chunk.size());
    }
    directions[0].put(3 * begin, c.direction1.data(), 3 * chunk.size());
    directions[1].put(3 * begin, c.direction2.data(), 3 * chunk.size());
    std::copy(c.irregular.data(), c.irregular.data() + chunk.size(), flags + begin);
  });
  return result("Curvature")(scalars[0].object(), scalars[1].object(), scalars[2].object(),
                             scalars[3].object(), directions[0].object(), directions[1].object(),
                             is_irregular);
}

py::object stencils(const SharedSurface& shared, const py::object& face, const py::object& uv,
                    int derivatives, int threads) {
  checkDerivatives(derivatives, 1);
  checkThreads(threads);
  const CheckedLocations at = locationsOn(shared.surface(), face, uv);
  Stencils all;
  all.offsets.push_back(0);
  inChunks(shared.mutex, at, [&](std::size_t, const LocationBatch& chunk) {
    const Stencils part = shared.surface().stencils(chunk, derivatives > 0, threads);
    const std::int64_t before = all.offsets.back();
    for (std::size_t i = 1; i < part.offsets.size(); ++i) {
      all.offsets.push_back(before + part.offsets[i]);
    }
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(all.indices, part.indices);
    append(all.weights, part.weights);
    append(all.du_weights, part.du_weights);
    append(all.dv_weights, part.dv_weights);
  });
  const auto optional = [&](const std::vector<double>& weights) {
    return derivatives > 0 ? py::object(arrayOf(weights)) : py::object(py::none());
  };
  return result("Stencils")(arrayOf(all.offsets), arrayOf(all.indices), arrayOf(all.weights),
                            optional(all.du_weights), optional(all.dv_weights));
}

py::array_t<double> pointArray(const Points& points) {
  return py::array_t<double>({points.rows(), Eigen::Index{3}}, points.data());
}

Points currentPositions(const SharedSurface& shared) {
  const py::gil_scoped_release release;
  const std::shared_lock<std::shared_mutex> lock(shared.mutex);
  return shared.surface().positions();
}

void setPositions(SharedSurface& shared, const py::object& positions, int threads) {
  checkThreads(threads);
  const Doubles array = doubles(positions, "positions");
  if (array.ndim() != 2 || array.shape(1) != 3 || array.shape(0) != shared.mesh->vertexCount()) {
    throw MeshError("positions has shape " + shapeText(array) + "; expected (" +
                    std::to_string(shared.mesh->vertexCount()) + ", 3)");
  }
  const Points points = pointsOf(array);
  const py::gil_scoped_release release;
  if (HeldPose::isHeldHere(shared)) {
    throw std::runtime_error(
        "set_positions() called by a function that a call on the same surface "
        "called: it would wait for itself");
  }
  const std::unique_lock<std::shared_mutex> lock(shared.mutex);
  shared.surface().setPositions(points, threads);
  shared.forgetPose();
}

std::unique_ptr<SharedData> faceVarying(const SharedSurface& shared, const py::object& values,
                                        const py::object& indices, const std::string& interpolation,
                                        int threads) {
  checkThreads(threads);
  const Interpolation rule = interpolationOf(interpolation);
  const DataRows rows = rowsOf(values);
  const Integers picked = integers<MeshError>(indices, "indices");
  requireVector<MeshError>(picked, "indices");
  const std::vector<std::int64_t> corners(picked.data(), picked.data() + picked.size());
  const py::gil_scoped_release release;
  const InterruptionPoint point = interruptible();
  return std::make_unique<SharedData>(shared.surface().faceVarying(rows, corners, rule, threads));
}

/// `make`: LimitSurface::vertexData() or varying().
template <SurfaceData (LimitSurface::*make)(const DataRows&, int) const>
std::unique_ptr<SharedData> perVertex(const SharedSurface& shared, const py::object& values,
                                      int threads) {
  checkThreads(threads);
  const DataRows rows = rowsOf(values);
  const py::gil_scoped_release release;
  const InterruptionPoint point = interruptible();
  return std::make_unique<SharedData>((shared.surface().*make)(rows, threads));
}

std::unique_ptr<SharedSurface> makeSurface(const std::shared_ptr<BoundMesh>& mesh) {
  const py::gil_scoped_release release;
  const InterruptionPoint point = interruptible();
  return std::make_unique<SharedSurface>(mesh);
}

}  // namespace

void bindLimitSurface(py::module_& module) {
  using namespace py::literals;
  const py::object float64 = py::dtype("float64");
  py::class_<SharedSurface> type(module, "LimitSurface", kLimitSurfaceDoc);
  bindBake(type);
  bindQueries(type);
  bindDisplacement(type);
  bindProjection(type);
  bindScatter(type);
  bindTessellate(type);
  type.def(py::init(&makeSurface), "mesh"_a.none(false))
      .def_readonly("mesh", &SharedSurface::mesh, "The ControlMesh, in the pose it was made with.")
      .def_property_readonly(
          "positions",
          [](const SharedSurface& shared) { return pointArray(currentPositions(shared)); },
          "(V, 3) float64: the cage's current positions, a copy.")
      .def_property_readonly(
          "face_count", [](const SharedSurface& s) { return s.surface().faceCount(); },
          "Number of Ptex faces.")
      .def_property_readonly(
          "base_face", [](const SharedSurface& s) { return arrayOf(s.surface().baseFace()); },
          "(face_count,) int32: the mesh's face that each Ptex face belongs to.")
      .def_property_readonly(
          "corner", [](const SharedSurface& s) { return arrayOf(s.surface().corner()); },
          "(face_count,) int32: the n-gon's corner that each Ptex face belongs to, 0 for quads.")
      .def_property_readonly(
          "refused",
          [](const SharedSurface& s) {
            py::dict refused;
            for (const auto& [face, reason] : s.surface().refused()) {
              refused[py::int_(face)] = reason;
            }
            return refused;
          },
          "dict: faces of the mesh without a limit surface (holes included) -> the reason.")
      .def("set_positions", &setPositions, "positions"_a, "threads"_a = 0, kSetPositionsDoc)
      .def("evaluate", &evaluate, "face"_a, "uv"_a, "derivatives"_a = 0, py::kw_only(),
           "threads"_a = 0, "dtype"_a = float64, kEvaluateDoc)
      .def("frames", &frames, "face"_a, "uv"_a, py::kw_only(), "threads"_a = 0, "dtype"_a = float64,
           kFramesDoc)
      .def("curvature", &curvature, "face"_a, "uv"_a, py::kw_only(), "irregular"_a = "none",
           "radius"_a = kCurvatureRadius, "threads"_a = 0, "dtype"_a = float64, kCurvatureDoc)
      .def("stencils", &stencils, "face"_a, "uv"_a, "derivatives"_a = 0, py::kw_only(),
           "threads"_a = 0, kStencilsDoc)
      .def("face_varying", &faceVarying, "values"_a, "indices"_a, "interpolation"_a, py::kw_only(),
           "threads"_a = 0, kFaceVaryingDoc)
      .def("vertex_data", &perVertex<&LimitSurface::vertexData>, "values"_a, py::kw_only(),
           "threads"_a = 0, kVertexDataDoc)
      .def("varying", &perVertex<&LimitSurface::varying>, "values"_a, py::kw_only(),
           "threads"_a = 0, kVaryingDoc)
      .def(
          "vertex_locations",
          [](const SharedSurface& s) { return locations(s.surface().vertexLocations()); },
          kVertexLocationsDoc)
      .def(
          "scatter_jittered",
          [](const SharedSurface& shared, int per_side, std::uint64_t seed, int threads) {
            checkThreads(threads);
            Locations at;
            {
              const py::gil_scoped_release release;
              const InterruptionPoint point = interruptible();
              at = scatterJittered(shared.surface(), per_side, seed, threads);
            }
            return locations(at);
          },
          "per_side"_a, "seed"_a = 0, py::kw_only(), "threads"_a = 0, kScatterJitteredDoc)
      .def(
          "area",
          [](const SharedSurface& shared, int threads) {
            checkThreads(threads);
            const py::gil_scoped_release release;
            const std::shared_lock<std::shared_mutex> lock(shared.mutex);
            const InterruptionPoint point = interruptible();
            return surfaceArea(shared.surface(), threads);
          },
          py::kw_only(), "threads"_a = 0,
          "Area of the limit surface, refused faces left out; relative error below 1e-9.")
      .def(
          "bounds",
          [](const SharedSurface& shared, int threads) {
            checkThreads(threads);
            Eigen::Matrix<double, 2, 3, Eigen::RowMajor> box;
            {
              const py::gil_scoped_release release;
              const std::shared_lock<std::shared_mutex> lock(shared.mutex);
              const InterruptionPoint point = interruptible();
              box = shared.surface().bounds(threads);
            }
            return py::array_t<double>({2, 3}, box.data());
          },
          py::kw_only(), "threads"_a = 0,
          "(2, 3) float64: the tightest axis-aligned box around the limit surface, minimum and "
          "maximum; error 1e-13 of the cage's diagonal. NaN where there is no surface.")
      .def("__repr__",
           [](const SharedSurface& s) {
             return "LimitSurface(" + std::to_string(s.surface().faceCount()) + " Ptex faces, " +
                    std::to_string(s.surface().refused().size()) + " faces refused)";
           })
      .def(py::pickle(
          [](const SharedSurface& s) {
            return py::make_tuple(py::cast(s.mesh), pointArray(currentPositions(s)));
          },
          [](const py::tuple& state) {
            if (state.size() != 2 || !py::isinstance<BoundMesh>(state[0])) {
              throw py::value_error("no state of a LimitSurface");
            }
            auto shared = makeSurface(py::cast<std::shared_ptr<BoundMesh>>(state[0]));
            setPositions(*shared, state[1], 0);
            return shared;
          }));
}

}  // namespace limitsurf::python
