// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../numbers.h"

#if defined(__GLIBCXX__)
#include <cxxabi.h>
#endif

namespace limitsurf::python {

// While Python ends, only the thread that ends it can take the GIL. Others, daemon threads, may be
// within a call. CPython before 3.14 ends them by unwinding their stack, which ends the whole
// process at the first destructor that takes the GIL, since nothing may leave destructors. Here
// such a thread waits for the end of the process instead, as it does in CPython 3.14.

[[noreturn]] void waitForTheEnd();

/// Calls `work`, which may wait for the GIL.
template <typename Work>
void orWaitForTheEnd(const Work& work) {
#if defined(__GLIBCXX__)
  try {
    work();
  } catch (abi::__forced_unwind&) {
    waitForTheEnd();
  }
#else
  work();  // elsewhere threads end without unwinding
#endif
}

/// Releases the GIL, which the thread must hold, for its lifetime.
class GilRelease {
 public:
  GilRelease();
  ~GilRelease();
  GilRelease(const GilRelease&) = delete;
  GilRelease& operator=(const GilRelease&) = delete;

 private:
  PyThreadState* thread_;
};

/// Takes the GIL, whether or not the thread holds it, for its lifetime.
class GilAcquire {
 public:
  GilAcquire();
  ~GilAcquire();
  GilAcquire(const GilAcquire&) = delete;
  GilAcquire& operator=(const GilAcquire&) = delete;

 private:
  PyGILState_STATE before_;
};

/// Calls `body`, which runs Python functions, with the GIL.
template <typename Body>
void withGil(const Body& body) {
  const GilAcquire acquire;
  orWaitForTheEnd(body);
}

}  // namespace limitsurf::python
