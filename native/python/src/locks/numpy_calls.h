// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

/// Has the functions of numpy that this module calls wait for the end of the process where Python
/// ends meanwhile (gil.h): they give up the GIL while they copy large arrays, and take it again.
/// Must be called once, with the GIL, before any array is converted.
void guardNumpyCalls();

}  // namespace limitsurf::python
