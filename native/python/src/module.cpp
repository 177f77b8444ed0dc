// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include "bake.h"
#include "control_mesh.h"
#include "displacement.h"
#include "images.h"
#include "limit_surface.h"
#include "limitsurf/error.h"
#include "ptex_layout.h"
#include "surface_data.h"

PYBIND11_MODULE(_limitsurf, module) {
  namespace py = pybind11;
  module.doc() = "The native part of limitsurf.";
  module.attr("__version__") = LIMITSURF_VERSION;
  py::register_exception<limitsurf::MeshError>(module, "MeshError", PyExc_ValueError).doc() =
      "A control mesh that has no meaning, or a request for a face without limit surface. The "
      "message names the face, vertex or row and the value.";
  py::register_exception<limitsurf::LocationError>(module, "LocationError", PyExc_ValueError)
      .doc() = "A location outside the surface's domain. The message names the row and the value.";
  limitsurf::python::bindControlMesh(module);
  limitsurf::python::bindSurfaceData(module);
  limitsurf::python::bindImages(module);
  limitsurf::python::bindShadingFrames(module);
  limitsurf::python::bindSubdividedFaces(module);
  limitsurf::python::bindPtexLayout(module);
  limitsurf::python::bindLimitSurface(module);
}
