// SPDX-License-Identifier: Apache-2.0
#include "numpy_calls.h"

#include "../numbers.h"
#include "gil.h"

namespace limitsurf::python {
namespace {

using Numpy = pybind11::detail::npy_api;

/// A function in numpy's table, which is replaced by one that waits.
template <auto member>
struct NumpyCall;

template <typename Result, typename... Arguments, Result (*Numpy::*member)(Arguments...)>
struct NumpyCall<member> {
  static inline Result (*real)(Arguments...) = nullptr;

  static Result call(Arguments... arguments) {
    Result result{};
    orWaitForTheEnd([&] { result = real(arguments...); });
    return result;
  }
  static void replace() {
    Numpy& numpy = Numpy::get();
    real = numpy.*member;
    numpy.*member = &call;
  }
};

}  // namespace

void guardNumpyCalls() {
  NumpyCall<&Numpy::PyArray_NewCopy_>::replace();
  NumpyCall<&Numpy::PyArray_FromAny_>::replace();
}

}  // namespace limitsurf::python
