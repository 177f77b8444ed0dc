// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "call_lock.h"
#include "gil.h"
#include "signals.h"

namespace limitsurf::python {

/// What a call that may take long does for its lifetime: it has released the GIL, keeps what a lock
/// guards as it is (or changes it), and can be ended by Ctrl-C. `Hold` is constructed from the
/// arguments, for example LongCall(lock) or LongCall<CallLock::HoldTwo>(lock, other_lock).
template <typename Hold = CallLock::Hold>
class LongCall {
 public:
  template <typename... Arguments>
  explicit LongCall(const Arguments&... arguments) : hold_(arguments...) {}

 private:
  const GilRelease release_;
  const Hold hold_;
  const InterruptionPoint point_ = interruptible();
};

}  // namespace limitsurf::python
