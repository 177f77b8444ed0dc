// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"
#include "shared_surface.h"

namespace limitsurf::python {

/// The class FixedSamples.
void bindFixedSamples(py::module_& module);
/// LimitSurface.fixed_samples()
void bindFixedSamplesMaker(SurfaceClass& type);

}  // namespace limitsurf::python
