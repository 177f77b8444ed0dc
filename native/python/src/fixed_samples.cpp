// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/fixed/fixed_samples.h"

#include <memory>

#include "arrays.h"
#include "batches.h"
#include "bound_class.h"
#include "fixed_samples.h"
#include "locks/gil.h"
#include "locks/signals.h"

namespace limitsurf::python {
namespace {

constexpr char kFixedSamplesDoc[] =
    R"(fixed_samples(face, uv, derivatives=0, *, threads=0)

Prepares locations that stay the same while the mesh deforms: FixedSamples. Its evaluate() computes their
positions from the vertices of one frame after another.

Parameters
    face, uv: (n,) Ptex faces and (n, 2), as in evaluate().
    derivatives: 0: evaluate() gives positions; 1: du and dv too.
    threads: 0 uses all cores.

The result depends on the topology and the locations alone. It stays valid when set_positions() gives this
surface another pose, and when this surface is deleted.

Raises LocationError and MeshError as evaluate() does, and ValueError for other derivatives. Cost: about
0.1 microseconds a location on quads whose vertices are all regular; elsewhere that of stencils(), 2 to 8
microseconds. Memory: 24 bytes a location on such quads; elsewhere the weights of the vertices that it
depends on: on triangles some 13 of them, 160 bytes (with derivatives 360), and near a vertex of many
faces up to 64, 800 bytes (1,800).
)";

constexpr char kFixedClassDoc[] =
    R"(Locations that stay the same while a control mesh deforms (LimitSurface.fixed_samples()).

This is what OpenSubdiv's LimitStencilTable is for, but exact. Take it for roots, particles or tracked
points that are evaluated in every frame. It is the fastest way where there are few locations on each
face: set_positions() and evaluate() prepare the whole mesh first. On regular quads with a hundred
locations each they are as fast.

Several threads may use the same FixedSamples at once. FixedSamples cannot be copied or pickled.
)";

constexpr char kFixedEvaluateDoc[] =
    R"(Positions, and du and dv if these were asked for, where the mesh has these vertices: Evaluation.

Parameters
    positions: (vertices, 3), those of the control mesh in the frame. A contiguous array of float64 is
        read in place, and must not change meanwhile.
    threads: 0 uses all cores.
    dtype: float32 or float64, that of the results.

The errors are at most those of LimitSurface.evaluate(), 1e-13 of the mesh's diagonal in position. Where a
derivative has no limit it is NaN. There are no normals: take LimitSurface.evaluate() or strand_poser().
A result has the same bits for any number of threads, and whatever the other locations are. Positions
with and without derivatives may differ in their last bits.

Raises MeshError as set_positions() does. Cost: O(vertices), and 10 to 35 nanoseconds a location on one
thread. If a location depends on more than 64 vertices, a call also looks at each irregular face, which
takes about two nanoseconds.
)";

template <typename Real>
void evaluateFixedInto(const FixedSamples& samples, const RowsIn<Points>& positions,
                       const Output outputs[3], int threads) {
  using Rows = typename EvaluationArrays<Real>::Rows;
  const auto rows = [&](int i) {
    return Rows{outputs[i].numbers<Real>(), outputs[i].wanted() ? samples.size() : 0};
  };
  EvaluationArrays<Real> into;
  into.position = rows(0);
  into.du = rows(1);
  into.dv = rows(2);
  samples.evaluate<Real>(positions, into, threads);
}

py::object evaluateFixed(const FixedSamples& samples, const py::object& positions, int threads,
                         const py::object& dtype) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const Doubles array = positionRows(positions, samples.vertexCount());
  const Eigen::Map<const Points> points(array.data(), array.shape(0), 3);
  Output outputs[3];
  const int wanted = samples.derivatives() == Derivatives::none ? 1 : 3;
  for (int i = 0; i < wanted; ++i) {
    outputs[i] = Output(type, {static_cast<py::ssize_t>(samples.size()), 3});
  }
  {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    const auto into = outputs[0].isSingle() ? evaluateFixedInto<float> : evaluateFixedInto<double>;
    into(samples, points, outputs, threads);
  }
  const py::none none;
  return result("Evaluation")(outputs[0].object(), outputs[1].object(), outputs[2].object(), none,
                              none, none, none);
}

std::unique_ptr<FixedSamples> makeFixedSamples(const SharedSurface& shared, const py::object& face,
                                               const py::object& uv, int derivatives, int threads) {
  checkDerivatives(derivatives, 1);
  checkThreads(threads);
  const LocationArrays at(face, uv);
  const LongCall call(shared.lock);
  return std::make_unique<FixedSamples>(shared.surface(), at.batch(),
                                        static_cast<Derivatives>(derivatives), threads);
}

}  // namespace

void bindFixedSamples(py::module_& module) {
  using namespace py::literals;
  const py::object float64 = py::dtype("float64");
  boundClass<py::class_<FixedSamples>>(module, "FixedSamples", kFixedClassDoc)
      .def("__len__", &FixedSamples::size)
      .def_property_readonly(
          "derivatives",
          [](const FixedSamples& self) { return static_cast<int>(self.derivatives()); },
          "0 or 1: what evaluate() computes.")
      .def_property_readonly("vertex_count", &FixedSamples::vertexCount,
                             "The number of the control mesh's vertices.")
      .def_property_readonly("nbytes", &FixedSamples::bytes,
                             "The memory of the samples in bytes. It does not include the mesh's "
                             "topology, nor 32 bytes for each vertex, which are kept from the "
                             "first evaluate() on.")
      .def("evaluate", &evaluateFixed, "positions"_a, py::kw_only(), "threads"_a = 0,
           "dtype"_a = float64, kFixedEvaluateDoc);
}

void bindFixedSamplesMaker(SurfaceClass& type) {
  using namespace py::literals;
  type.def("fixed_samples", &makeFixedSamples, "face"_a, "uv"_a, "derivatives"_a = 0, py::kw_only(),
           "threads"_a = 0, kFixedSamplesDoc);
}

}  // namespace limitsurf::python
