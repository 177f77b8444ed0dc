// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arrays.h"

namespace limitsurf::python {

/// The argument `progress`: None, or a Python function, which is called with the GIL on the calling
/// thread. An exception that it raises ends the call.
class ProgressReport {
 public:
  explicit ProgressReport(const py::object& report) : report_(report) {
    if (!report.is_none() && !PyCallable_Check(report.ptr())) {
      throw py::type_error("progress is not callable");
    }
  }
  void operator()(double part) const {
    if (!report_.is_none()) {
      withGil([&] { report_(part); });
    }
  }

 private:
  const py::object& report_;
};

}  // namespace limitsurf::python
