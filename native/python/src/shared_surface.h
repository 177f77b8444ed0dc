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
#include "held_still.h"
#include "lazily.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::python {

/// A surface that may be re-posed while other Python threads, without the GIL, evaluate it.
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

  /// With the mutex held alone.
  void forgetPose() {
    search.forget();
    sampler.forget();
    ++pose_;
  }
  /// Another number after every set_positions().
  std::uint64_t pose() const { return pose_; }

  std::shared_ptr<BoundMesh> mesh;
  mutable std::shared_mutex mutex;
  Lazily<SurfaceSearch, LimitSurface> search;
  Lazily<AreaSampler, LimitSurface> sampler;

 private:
  std::unique_ptr<LimitSurface> surface_;
  std::atomic<std::uint64_t> pose_{0};
};

using HeldPose = HeldStill<SharedSurface>;

void bindQueries(py::class_<SharedSurface>& type);
void bindScatter(py::class_<SharedSurface>& type);
void bindTessellate(py::class_<SharedSurface>& type);

}  // namespace limitsurf::python
