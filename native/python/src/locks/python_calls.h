// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

// Functions of Python and of numpy give up the GIL for a while. A thread that does not get it back,
// because Python ends, must not unwind through functions that keep Python objects: these would be
// freed without the GIL. So such a thread waits within the function that it has called (gil.h). The
// linker replaces those of Python, where threads unwind at all (LIMITSURF_WRAPS_CALLS).

/// Replaces those of numpy that pybind11 calls. The module calls it once.
void guardNumpyCalls();

}  // namespace limitsurf::python
