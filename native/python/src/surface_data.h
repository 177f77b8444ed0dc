// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <shared_mutex>
#include <string>

#include "control_mesh.h"
#include "lazily.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/uv_map.h"

namespace limitsurf::python {

/// Data whose values may be set while other Python threads, without the GIL, evaluate them.
class SharedData : public ZeroedMemory {
 public:
  explicit SharedData(SurfaceData data) : data_(std::make_unique<SurfaceData>(std::move(data))) {}

  const SurfaceData& data() const;
  SurfaceData& data();

  mutable std::shared_mutex mutex;
  Lazily<UvMap, SurfaceData> uv_map;

 private:
  std::unique_ptr<SurfaceData> data_;
};

/// MeshError for a name that is no rule.
Interpolation interpolationOf(const std::string& name);

/// A (m, d) array, or (m,) as one column; MeshError for another shape.
DataRows rowsOf(const pybind11::object& values);

void bindSurfaceData(pybind11::module_& module);
void bindUvMap(pybind11::class_<SharedData>& type);

}  // namespace limitsurf::python
