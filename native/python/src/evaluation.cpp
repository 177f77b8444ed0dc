// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "batches.h"
#include "choices.h"
#include "docstrings.h"
#include "limitsurf/large_pages.h"
#include "result_memory.h"
#include "shared_surface.h"
#include "text.h"

namespace limitsurf::python {
namespace {

/// Writes an evaluation to arrays of one type.
template <typename Real>
void evaluateInto(const LimitSurface& surface, const LocationBatch& at, Derivatives derivatives,
                  const Output outputs[7], int threads) {
  using Rows = typename EvaluationArrays<Real>::Rows;
  const auto rows = [&](int i) {
    return Rows{outputs[i].numbers<Real>(), outputs[i].wanted() ? at.size() : 0};
  };
  surface.evaluate<Real>(at, derivatives,
                         {rows(0), rows(1), rows(2), rows(4), rows(5), rows(6), rows(3)}, threads);
}

py::object evaluate(const SharedSurface& shared, const py::object& face, const py::object& uv,
                    int derivatives, int threads, const py::object& dtype) {
  checkDerivatives(derivatives, 2);
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const LocationArrays at(face, uv);
  // position, du, dv, normal, duu, duv, dvv
  Output outputs[7];
  const int wanted = derivatives == 0 ? 1 : derivatives == 1 ? 4 : 7;
  for (int i = 0; i < wanted; ++i) {
    outputs[i] = Output(type, {static_cast<py::ssize_t>(at.size()), 3});
  }
  {
    const LongCall call(shared.lock);
    const auto into = outputs[0].isSingle() ? evaluateInto<float> : evaluateInto<double>;
    into(shared.surface(), at.batch(), static_cast<Derivatives>(derivatives), outputs, threads);
  }
  return result("Evaluation")(outputs[0].object(), outputs[1].object(), outputs[2].object(),
                              outputs[4].object(), outputs[5].object(), outputs[6].object(),
                              outputs[3].object());
}

/// Frames, and the positions for an output that is wanted.
void framesInto(const SharedSurface& shared, const LocationArrays& at, Output& position,
                Output& frame, int threads) {
  const LongCall call(shared.lock);
  const LocationBatch checked = shared.surface().checkLocations(at.batch(), threads);
  if (double* const rotations = frame.numbers<double>()) {
    shared.surface().frames(
        checked, {{position.numbers<double>(), at.size()}, {rotations, at.size()}}, threads);
    return;
  }
  forEachChunk(at.size(), [&](std::size_t begin, std::size_t count) {
    Points positions(position.wanted() ? count : 0, 3);
    Rotations rotations(count, 9);
    shared.surface().frames(
        checked.rows(begin, count),
        {{position.wanted() ? positions.data() : nullptr, count}, {rotations.data(), count}},
        threads);
    if (position.wanted()) {
      position.put(3 * begin, positions.data(), 3 * count);
    }
    frame.put(9 * begin, rotations.data(), 9 * count);
  });
}

py::object frames(const SharedSurface& shared, const py::object& face, const py::object& uv,
                  int threads, const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const LocationArrays at(face, uv);
  Output position, frame(type, {static_cast<py::ssize_t>(at.size()), 3, 3});
  framesInto(shared, at, position, frame, threads);
  return frame.object();
}

py::object placedFrames(const SharedSurface& shared, const py::object& face, const py::object& uv,
                        int threads, const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const LocationArrays at(face, uv);
  const auto rows = static_cast<py::ssize_t>(at.size());
  Output position(type, {rows, 3}), frame(type, {rows, 3, 3});
  framesInto(shared, at, position, frame, threads);
  return result("PlacedFrames")(position.object(), frame.object());
}

py::object curvature(const SharedSurface& shared, const py::object& face, const py::object& uv,
                     const Text& irregular, double radius, int threads, const py::object& dtype) {
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
  auto is_irregular = newArray<bool>({rows});
  bool* const flags = is_irregular.mutable_data();
  if (scalars[0].isSingle()) {
    inChunks(shared.lock, at, [&](std::size_t begin, const LocationBatch& chunk) {
      const Curvature c = shared.surface().curvature(chunk, rule, radius, threads);
      const Eigen::VectorXd* values[4] = {&c.gaussian, &c.mean, &c.k1, &c.k2};
      for (int i = 0; i < 4; ++i) {
        scalars[i].put(begin, values[i]->data(), chunk.size());
      }
      directions[0].put(3 * begin, c.direction1.data(), 3 * chunk.size());
      directions[1].put(3 * begin, c.direction2.data(), 3 * chunk.size());
      std::copy(c.irregular.data(), c.irregular.data() + chunk.size(), flags + begin);
    });
  } else {
    const auto into = [&](const Output& output) {
      return CurvatureArrays::Rows{output.numbers<double>(), at.size()};
    };
    const LongCall call(shared.lock);
    shared.surface().curvature(at,
                               {into(scalars[0]),
                                into(scalars[1]),
                                into(scalars[2]),
                                into(scalars[3]),
                                into(directions[0]),
                                into(directions[1]),
                                {flags, at.size()}},
                               rule, radius, threads);
  }
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
  {
    const LongCall call(shared.lock);
    all = shared.surface().stencils(at, derivatives > 0, threads);
  }
  const auto optional = [&](LargePageVector<double>&& weights) {
    return derivatives > 0 ? py::object(arrayOf(std::move(weights))) : py::object(py::none());
  };
  return result("Stencils")(arrayOf(std::move(all.offsets)), arrayOf(std::move(all.indices)),
                            arrayOf(std::move(all.weights)), optional(std::move(all.du_weights)),
                            optional(std::move(all.dv_weights)));
}

}  // namespace

void bindEvaluation(SurfaceClass& type) {
  using namespace py::literals;
  const py::object float64 = py::dtype("float64");
  type.def("evaluate", &evaluate, "face"_a, "uv"_a, "derivatives"_a = 0, py::kw_only(),
           "threads"_a = 0, "dtype"_a = float64, kEvaluateDoc)
      .def("frames", &frames, "face"_a, "uv"_a, py::kw_only(), "threads"_a = 0, "dtype"_a = float64,
           kFramesDoc)
      .def("placed_frames", &placedFrames, "face"_a, "uv"_a, py::kw_only(), "threads"_a = 0,
           "dtype"_a = float64, kPlacedFramesDoc)
      .def("curvature", &curvature, "face"_a, "uv"_a, py::kw_only(), "irregular"_a = "none",
           "radius"_a = kCurvatureRadius, "threads"_a = 0, "dtype"_a = float64, kCurvatureDoc)
      .def("stencils", &stencils, "face"_a, "uv"_a, "derivatives"_a = 0, py::kw_only(),
           "threads"_a = 0, kStencilsDoc);
}

}  // namespace limitsurf::python
