// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/interruption_point.h"

namespace limitsurf::python {

/// Runs the handlers of signals that have arrived, on the main thread; throws what they raise. It
/// is called without the GIL.
void lookForSignals();

/// Lets Ctrl-C end a call that has released the GIL.
InterruptionPoint interruptible();

}  // namespace limitsurf::python
