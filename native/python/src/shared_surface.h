// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <utility>

#include "arrays.h"
#include "control_mesh.h"
#include "kept_value.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "pose_hold.h"

namespace limitsurf::python {

/// A surface whose positions may be set while other Python threads evaluate it without the GIL.
struct SharedSurface : ZeroedMemory {
  explicit SharedSurface(std::shared_ptr<BoundMesh> m)
      : mesh(std::move(m)), surface_(std::make_unique<LimitSurface>(*mesh)) {}

  const LimitSurface& surface() const {
    if (!surface_) {
      throw py::value_error("this LimitSurface was never initialised");
    }
    return *surface_;
  }
  LimitSurface& surface() {
    std::as_const(*this).surface();
    return *surface_;
  }

  /// Forgets what was made for the pose. The mutex must be held exclusively.
  void forgetPose() {
    search.forget();
    sampler.forget();
    ++pose_;
  }
  /// The number of the pose, which changes with every set_positions().
  std::uint64_t pose() const { return pose_; }

  std::shared_ptr<BoundMesh> mesh;
  mutable std::shared_mutex mutex;
  KeptValue<SurfaceSearch, LimitSurface> search;
  KeptValue<AreaSampler, LimitSurface> sampler;

 private:
  std::unique_ptr<LimitSurface> surface_;
  std::atomic<std::uint64_t> pose_{0};
};

using HeldPose = PoseHold<SharedSurface>;

// The methods of LimitSurface by subject.
/// evaluate(), frames(), curvature(), stencils()
void bindEvaluation(py::class_<SharedSurface>& type);
/// face_varying(), vertex_data(), varying()
void bindDataMakers(py::class_<SharedSurface>& type);
/// tessellate(), levels_within(), levels_of_length()
void bindTessellation(py::class_<SharedSurface>& type);
/// closest(), ray_cast(), ray_cast_all()
void bindSearch(py::class_<SharedSurface>& type);
/// lay_path(), fit_path(), smooth_path(), even_path()
void bindPaths(py::class_<SharedSurface>& type);
/// area() and the scatter methods
void bindSampling(py::class_<SharedSurface>& type);
/// curve_directions()
void bindFlow(py::class_<SharedSurface>& type);
/// tiles()
void bindGuideWeights(py::class_<SharedSurface>& type);
void bindSurfaceTiles(py::class_<SharedSurface>& type);

}  // namespace limitsurf::python
