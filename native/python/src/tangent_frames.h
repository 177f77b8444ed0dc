// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shared_surface.h"

namespace limitsurf::python {

/// tangent_frames() and map_distortion()
void bindTangentFrames(SurfaceClass& type);
/// into_shading_frames() and out_of_shading_frames()
void bindShadingFrames(py::module_& module);

}  // namespace limitsurf::python
