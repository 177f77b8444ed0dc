// SPDX-License-Identifier: Apache-2.0
#include "gil.h"

#include <chrono>
#include <thread>

namespace limitsurf::python {
namespace {

bool pythonEnds() {
#if PY_VERSION_HEX >= 0x030D0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

/// Whether this thread is the one that ends Python: it held the GIL meanwhile.
thread_local bool ends_python = false;

void waitIfPythonEnds() {
  if (!ends_python && pythonEnds()) {
    waitForTheEnd();
  }
}

}  // namespace

void waitForTheEnd() {
  for (;;) {
    std::this_thread::sleep_for(std::chrono::hours(1));
  }
}

GilRelease::GilRelease() {
  ends_python = pythonEnds();
  thread_ = PyEval_SaveThread();
}

GilRelease::~GilRelease() {
  waitIfPythonEnds();
  orWaitForTheEnd([&] { PyEval_RestoreThread(thread_); });
}

GilAcquire::GilAcquire() {
  waitIfPythonEnds();
  orWaitForTheEnd([&] { before_ = PyGILState_Ensure(); });
}

GilAcquire::~GilAcquire() { PyGILState_Release(before_); }

}  // namespace limitsurf::python
