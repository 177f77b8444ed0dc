// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shared_surface.h"

namespace limitsurf::python {

void bindProjection(SurfaceClass& type);

}  // namespace limitsurf::python
