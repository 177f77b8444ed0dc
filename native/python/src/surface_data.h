// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>

#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/uv_map.h"
#include "locks/call_lock.h"
#include "locks/kept_value.h"

namespace limitsurf::python {

/// Data whose values may be set while other Python threads evaluate them without the GIL.
class SharedData {
 public:
  explicit SharedData(SurfaceData data) : data_(std::move(data)) {}

  const SurfaceData& data() const { return data_; }
  SurfaceData& data() { return data_; }

  const CallLock lock{"SurfaceData"};
  KeptValue<UvMap, SurfaceData> uv_map{"map of a SurfaceData"};

 private:
  SurfaceData data_;
};

/// The rule of this name. Throws MeshError for another name.
Interpolation interpolationOf(const std::string& name);

/// The rows of an (m, d) array, or of (m,) as one column. Throws MeshError for another shape.
DataRows rowsOf(const pybind11::object& values);

void bindSurfaceData(pybind11::module_& module);
void bindUvMap(pybind11::class_<SharedData>& type);

}  // namespace limitsurf::python
