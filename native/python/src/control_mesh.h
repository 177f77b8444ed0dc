// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <cstdlib>
#include <new>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf::python {

/// Memory that is zero at first. Python can make an object without initialising it
/// (`cls.__new__(cls)`), and the members of the bound classes take zero for empty.
struct ZeroedMemory {
  static void* operator new(std::size_t size) {
    void* memory = std::calloc(1, size);
    if (!memory) {
      throw std::bad_alloc();
    }
    return memory;
  }
  static void operator delete(void* memory) { std::free(memory); }
};

struct BoundMesh : ZeroedMemory, ControlMesh {
  using ControlMesh::ControlMesh;
};

void bindControlMesh(pybind11::module_& module);

}  // namespace limitsurf::python
