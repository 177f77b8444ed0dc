// SPDX-License-Identifier: Apache-2.0
#include "surface_data.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "batches.h"
#include "bound_class.h"
#include "choices.h"
#include "docstrings.h"
#include "limitsurf/error.h"
#include "result_memory.h"
#include "shared_surface.h"
#include "text.h"

namespace limitsurf::python {
namespace {

const Choices<Interpolation> kInterpolations = {{"none", Interpolation::none},
                                                {"corners_only", Interpolation::corners_only},
                                                {"corners_plus1", Interpolation::corners_plus1},
                                                {"corners_plus2", Interpolation::corners_plus2},
                                                {"boundaries", Interpolation::boundaries},
                                                {"all", Interpolation::all}};

template <typename Real>
void evaluateInto(const SurfaceData& data, const LocationBatch& at, Derivatives derivatives,
                  const Output outputs[6], int threads) {
  const auto rows = [&](int i) {
    return typename DataArrays<Real>::Rows{outputs[i].numbers<Real>(), at.size()};
  };
  data.evaluate<Real>(at, derivatives, {rows(0), rows(1), rows(2), rows(3), rows(4), rows(5)},
                      threads);
}

py::object evaluate(const SharedData& shared, const py::object& face, const py::object& uv,
                    int derivatives, int threads, const py::object& dtype) {
  checkDerivatives(derivatives, 2);
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const SurfaceData& data = shared.data();
  const LocationArrays at(face, uv);
  const auto rows = static_cast<py::ssize_t>(at.size());
  const auto columns = static_cast<py::ssize_t>(data.columns());
  Output outputs[6];  // value, du, dv, duu, duv, dvv
  const int wanted = derivatives == 0 ? 1 : derivatives == 1 ? 3 : 6;
  for (int i = 0; i < wanted; ++i) {
    outputs[i] = Output(type, {rows, columns});
  }
  {
    const LongCall call(shared.lock);
    const auto into = outputs[0].isSingle() ? evaluateInto<float> : evaluateInto<double>;
    into(data, at.batch(), static_cast<Derivatives>(derivatives), outputs, threads);
  }
  return result("DataEvaluation")(outputs[0].object(), outputs[1].object(), outputs[2].object(),
                                  outputs[3].object(), outputs[4].object(), outputs[5].object());
}

py::object bounds(const SharedData& shared, int side, int threads) {
  checkThreads(threads);
  DataBounds boxes;
  {
    const LongCall call(shared.lock);
    boxes = shared.data().bounds(side, threads);
  }
  const auto rows = static_cast<std::size_t>(boxes.low.rows());
  const auto columns = static_cast<std::size_t>(boxes.low.cols());
  auto out = newArray<double>({py::ssize_t{shared.data().faceCount()}, py::ssize_t{side},
                               py::ssize_t{side}, 2, static_cast<py::ssize_t>(columns)});
  double* const to = out.mutable_data();
  forEachRow(rows, [&](std::size_t row) {
    std::copy_n(boxes.low.data() + columns * row, columns, to + 2 * columns * row);
    std::copy_n(boxes.high.data() + columns * row, columns, to + (2 * row + 1) * columns);
  });
  return std::move(out);
}

void setValues(SharedData& shared, const py::object& values, int threads) {
  checkThreads(threads);
  DataRows rows = rowsOf(values);
  const LongCall call(shared.lock, CallLock::Access::change);
  shared.setValues(std::move(rows), threads);
}

std::unique_ptr<SharedData> faceVarying(const SharedSurface& shared, const py::object& values,
                                        const py::object& indices, const Text& interpolation,
                                        int threads) {
  checkThreads(threads);
  const Interpolation rule = interpolationOf(interpolation);
  DataRows rows = rowsOf(values);
  const Integers picked = integers<MeshError>(indices, "indices");
  requireVector<MeshError>(picked, "indices");
  const std::vector<std::int64_t> corners(picked.data(), picked.data() + picked.size());
  const GilRelease release;
  const InterruptionPoint point = interruptible();
  SurfaceData data = shared.surface().faceVarying(rows, corners, rule, threads);
  return std::make_unique<SharedData>(std::move(data), std::move(rows));
}

/// `make`: LimitSurface::vertexData() or varying().
template <SurfaceData (LimitSurface::*make)(const DataRows&, int) const>
std::unique_ptr<SharedData> perVertex(const SharedSurface& shared, const py::object& values,
                                      int threads) {
  checkThreads(threads);
  DataRows rows = rowsOf(values);
  const GilRelease release;
  const InterruptionPoint point = interruptible();
  SurfaceData data = (shared.surface().*make)(rows, threads);
  return std::make_unique<SharedData>(std::move(data), std::move(rows));
}

}  // namespace

void SharedData::setValues(DataRows values, int threads) {
  try {
    data_.setValues(values, threads);
  } catch (...) {
    lock.setWhole(data_.isSet());
    throw;
  }
  lock.setWhole(true);
  values_ = std::move(values);
  uv_map.forget();
}

Interpolation interpolationOf(const std::string& name) {
  return choice(name, "interpolation", kInterpolations);
}

DataRows rowsOf(const py::object& values) {
  const Doubles array = doubles(values, "values");
  if (array.ndim() < 1 || array.ndim() > 2) {
    throw MeshError("values has shape " + shapeText(array) + "; expected (m, d) or (m,)");
  }
  DataRows rows(array.shape(0), array.ndim() == 2 ? array.shape(1) : 1);
  const double* const from = array.data();
  forEachRow(static_cast<std::size_t>(rows.rows()), [&](std::size_t row) {
    const auto columns = static_cast<std::size_t>(rows.cols());
    std::copy_n(from + columns * row, columns, rows.data() + columns * row);
  });
  return rows;
}

void bindSurfaceData(py::module_& module) {
  using namespace py::literals;
  auto type = boundClass<py::class_<SharedData>>(module, "SurfaceData", kSurfaceDataDoc);
  type.def_property_readonly(
          "shape",
          [](const SharedData& s) { return py::make_tuple(s.data().rows(), s.data().columns()); },
          "(m, d): the shape of the values.")
      .def("set_values", &setValues, "values"_a, "threads"_a = 0, kSetValuesDoc)
      .def("evaluate", &evaluate, "face"_a, "uv"_a, "derivatives"_a = 0, py::kw_only(),
           "threads"_a = 0, "dtype"_a = py::dtype("float64"), kEvaluateDataDoc)
      .def("bounds", &bounds, "side"_a = 1, py::kw_only(), "threads"_a = 0, kDataBoundsDoc)
      .def("__repr__", [](const SharedData& s) {
        return "SurfaceData(" + std::to_string(s.data().rows()) + " values of " +
               std::to_string(s.data().columns()) + " columns)";
      });
  bindUvMap(type);
}

void bindDataMakers(SurfaceClass& type) {
  using namespace py::literals;
  type.def("face_varying", &faceVarying, "values"_a, "indices"_a, "interpolation"_a, py::kw_only(),
           "threads"_a = 0, kFaceVaryingDoc)
      .def("vertex_data", &perVertex<&LimitSurface::vertexData>, "values"_a, py::kw_only(),
           "threads"_a = 0, kVertexDataDoc)
      .def("varying", &perVertex<&LimitSurface::varying>, "values"_a, py::kw_only(),
           "threads"_a = 0, kVaryingDoc);
}

}  // namespace limitsurf::python
