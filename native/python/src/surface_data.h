// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/uv_map.h"
#include "locks/call_lock.h"
#include "locks/kept_value.h"
#include "numbers.h"

namespace limitsurf::python {

/// Data whose values may be set while other Python threads evaluate them without the GIL.
class SharedData {
 public:
  SharedData(SurfaceData data, DataRows values)
      : data_(std::move(data)), values_(std::move(values)) {}

  const SurfaceData& data() const { return data_; }
  /// Sets the values. If something is thrown, they are as before as soon as somebody reads them.
  /// The lock must be held for a change.
  void setValues(DataRows values, int threads);

  CallLock lock{"SurfaceData", [this] { data_.setValues(values_, 0); }};
  KeptValue<UvMap, SurfaceData> uv_map{"map of a SurfaceData"};

 private:
  SurfaceData data_;
  DataRows values_;
};

/// The rule of this name. Throws MeshError for another name.
Interpolation interpolationOf(const std::string& name);

/// The rows of an (m, d) array, or of (m,) as one column. Throws MeshError for another shape.
DataRows rowsOf(const pybind11::object& values);

void bindSurfaceData(pybind11::module_& module);
void bindUvMap(pybind11::class_<SharedData>& type);

}  // namespace limitsurf::python
