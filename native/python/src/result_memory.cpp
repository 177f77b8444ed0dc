// SPDX-License-Identifier: Apache-2.0
#include "result_memory.h"

#include <cstdint>
#include <cstring>

#include "kept_memory.h"

namespace limitsurf::python {
namespace {

/// PyDataMem_Handler of numpy 1.22 and later, version 1 (NEP 49, Data allocation strategies).
struct Handler {
  char name[127];
  std::uint8_t version;
  void* context;
  void* (*allocate)(void*, std::size_t);
  void* (*allocateZeros)(void*, std::size_t, std::size_t);
  void* (*reallocate)(void*, void*, std::size_t);
  void (*free)(void*, void*, std::size_t);
};

void* zeros(void*, std::size_t count, std::size_t size) {
  void* const memory = takeMemory(count * size);
  if (memory != nullptr) std::memset(memory, 0, count * size);
  return memory;
}

Handler kHandler = {
    "limitsurf",
    1,
    nullptr,
    [](void*, std::size_t bytes) { return takeMemory(bytes); },
    zeros,
    [](void*, void* memory, std::size_t bytes) { return resizeMemory(memory, bytes); },
    [](void*, void* memory, std::size_t) { returnMemory(memory); },
};

/// PyDataMem_SetHandler(): says how new arrays of this thread get their memory, and returns the
/// capsule that said so before, or null with an error set.
using SetHandler = PyObject* (*)(PyObject*);

SetHandler setHandler() {
  constexpr int kPlace = 304;  // in numpy's table of functions
  const py::object table = py::detail::import_numpy_core_submodule("multiarray").attr("_ARRAY_API");
  void** const functions = static_cast<void**>(PyCapsule_GetPointer(table.ptr(), nullptr));
  if (functions == nullptr) throw py::error_already_set();
  return reinterpret_cast<SetHandler>(functions[kPlace]);
}

/// While it exists, new arrays of this thread have memory that is kept.
class KeptMemory {
 public:
  KeptMemory() {
    static const SetHandler set = setHandler();
    static const py::handle ours = py::capsule(&kHandler, "mem_handler").release();  // for good
    set_ = set;
    before_ = set_(ours.ptr());
    if (before_ == nullptr) throw py::error_already_set();
  }
  ~KeptMemory() {
    PyObject* const ours = set_(before_);
    if (ours == nullptr) PyErr_WriteUnraisable(nullptr);
    Py_XDECREF(ours);
    Py_DECREF(before_);
  }
  KeptMemory(const KeptMemory&) = delete;
  KeptMemory& operator=(const KeptMemory&) = delete;

 private:
  SetHandler set_;
  PyObject* before_;
};

}  // namespace

py::array newArray(const py::dtype& dtype, std::vector<py::ssize_t> shape) {
  auto bytes = static_cast<std::size_t>(dtype.itemsize());
  for (const py::ssize_t extent : shape) bytes *= static_cast<std::size_t>(extent);
  if (bytes < kLeastKept) return py::array(dtype, std::move(shape));
  const KeptMemory memory;
  return py::array(dtype, std::move(shape));
}

}  // namespace limitsurf::python
