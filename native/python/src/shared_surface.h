// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "arrays.h"
#include "control_mesh.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "locks/call_lock.h"
#include "locks/kept_value.h"
#include "locks/long_call.h"

namespace limitsurf::python {

/// A surface whose positions may be set while other Python threads evaluate it without the GIL.
struct SharedSurface : std::enable_shared_from_this<SharedSurface> {
  explicit SharedSurface(std::shared_ptr<BoundMesh> m) : mesh(std::move(m)), surface_(*mesh) {}

  const LimitSurface& surface() const { return surface_; }
  LimitSurface& surface() { return surface_; }

  /// Sets the positions. If something is thrown, the surface is as before as soon as somebody reads
  /// it. The lock must be held for a change.
  void setPositions(Points positions, int threads) {
    try {
      surface_.setPositions(std::move(positions), threads);
    } catch (...) {
      lock.setWhole(surface_.isPosed());
      throw;
    }
    lock.setWhole(true);
    search.forget();
    sampler.forget();
    ++pose_;
  }
  /// The number of the pose, which changes with every set_positions().
  std::uint64_t pose() const { return pose_; }

  std::shared_ptr<BoundMesh> mesh;
  CallLock lock{"LimitSurface", [this] { surface_.setPositions(surface_.positions(), 0); }};
  KeptValue<SurfaceSearch, LimitSurface> search{"search tree of a LimitSurface"};
  KeptValue<AreaSampler, LimitSurface> sampler{"area of a LimitSurface"};

 private:
  LimitSurface surface_;
  std::atomic<std::uint64_t> pose_{0};
};

using SurfaceClass = py::class_<SharedSurface, std::shared_ptr<SharedSurface>>;

// The methods of LimitSurface by subject.
/// evaluate(), frames(), curvature(), stencils()
void bindEvaluation(SurfaceClass& type);
/// face_varying(), vertex_data(), varying()
void bindDataMakers(SurfaceClass& type);
/// tessellate(), levels_within(), levels_of_length()
void bindTessellation(SurfaceClass& type);
/// closest(), ray_cast(), ray_cast_all()
void bindSearch(SurfaceClass& type);
/// lay_path(), fit_path(), smooth_path(), even_path()
void bindPaths(SurfaceClass& type);
/// area() and the scatter methods
void bindSampling(SurfaceClass& type);
/// curve_directions()
void bindFlow(SurfaceClass& type);
/// tiles()
void bindGuideWeights(SurfaceClass& type);
void bindSurfaceTiles(SurfaceClass& type);

}  // namespace limitsurf::python
