// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "limitsurf/interruption_point.h"

namespace limitsurf::python {

/// Runs the handlers of signals that have arrived, on the main thread; throws what they raise. It
/// is called without the GIL.
void lookForSignals();

/// Lets Ctrl-C end a call that has released the GIL. `also` is called as often as signals are
/// looked for, some 50 times in a second; if it throws, the call ends, too.
InterruptionPoint interruptible(std::function<void()> also = nullptr);

}  // namespace limitsurf::python
