// SPDX-License-Identifier: Apache-2.0
#include "control_mesh.h"
#include "displacement.h"
#include "edge_curves.h"
#include "fixed_samples.h"
#include "frame_rows.h"
#include "guides.h"
#include "images.h"
#include "limit_surface.h"
#include "limitsurf/error.h"
#include "locks/numpy_calls.h"
#include "numbers.h"
#include "ptex_layout.h"
#include "short_errors.h"
#include "strand_poser.h"
#include "strand_turns.h"
#include "surface_data.h"
#include "tangent_frames.h"

// PyInit_limitsurf_in_main_interpreter(), which PyInit__limitsurf() calls.
PYBIND11_MODULE(limitsurf_in_main_interpreter, module) {
  namespace py = pybind11;
  limitsurf::python::guardNumpyCalls();
  module.doc() = "The native part of limitsurf.";
  module.attr("__version__") = LIMITSURF_VERSION;
  py::register_exception<limitsurf::MeshError>(module, "MeshError", PyExc_ValueError).doc() =
      "An invalid control mesh, or a face that has no limit surface. The message names the face, "
      "vertex or row and the wrong value.";
  py::register_exception<limitsurf::LocationError>(module, "LocationError", PyExc_ValueError)
      .doc() =
      "A location that does not exist: an unknown face, or (u, v) that is NaN or outside [0, 1]. "
      "The "
      "message names the row and the wrong value.";
  limitsurf::python::bindControlMesh(module);
  limitsurf::python::bindSurfaceData(module);
  limitsurf::python::bindImages(module);
  limitsurf::python::bindShadingFrames(module);
  limitsurf::python::bindSubdividedFaces(module);
  limitsurf::python::bindPtexLayout(module);
  limitsurf::python::bindFixedSamples(module);
  limitsurf::python::bindStrandPoser(module);
  limitsurf::python::bindEdgeCurves(module);
  limitsurf::python::bindFrameRows(module);
  limitsurf::python::bindStrandTurns(module);
  limitsurf::python::bindChildStrands(module);
  limitsurf::python::bindLimitSurface(module);
  limitsurf::python::shortenErrors(module);
}

/// What Python calls to import the module. In another interpreter of the process pybind11 would
/// hang before it looked.
// NOLINTNEXTLINE(bugprone-reserved-identifier): Python gives the name
extern "C" PYBIND11_EXPORT PyObject* PyInit__limitsurf() {
  if (PyInterpreterState_Get() != PyInterpreterState_Main()) {
    PyErr_SetString(PyExc_ImportError,
                    "limitsurf cannot be imported in a subinterpreter; import it in the main "
                    "interpreter of the process");
    return nullptr;
  }
  return PyInit_limitsurf_in_main_interpreter();
}
