// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <shared_mutex>
#include <string>

#include "control_mesh.h"
#include "kept_value.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/uv_map.h"

namespace limitsurf::python {

/// Data whose values may be set while other Python threads evaluate them without the GIL.
class SharedData : public ZeroedMemory {
 public:
  explicit SharedData(SurfaceData data) : data_(std::make_unique<SurfaceData>(std::move(data))) {}

  const SurfaceData& data() const;
  SurfaceData& data();

  mutable std::shared_mutex mutex;
  KeptValue<UvMap, SurfaceData> uv_map;

 private:
  std::unique_ptr<SurfaceData> data_;
};

/// The rule of this name. Throws MeshError for another name.
Interpolation interpolationOf(const std::string& name);

/// The rows of an (m, d) array, or of (m,) as one column. Throws MeshError for another shape.
DataRows rowsOf(const pybind11::object& values);

void bindSurfaceData(pybind11::module_& module);
void bindUvMap(pybind11::class_<SharedData>& type);

}  // namespace limitsurf::python
