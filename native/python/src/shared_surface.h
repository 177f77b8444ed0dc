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
#include "lazily.h"
#include "limitsurf/query/area_sampler.h"
#include "limitsurf/query/surface_search.h"
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

/// Holds a pose still during a call that calls back into Python. What it calls may read the surface
/// as well, but must not re-pose it: that would wait for itself for ever.
class HeldPose {
 public:
  explicit HeldPose(const SharedSurface& shared)
      : shared_(shared), lock_(shared.mutex), outer_(innermost()) {
    innermost() = this;
  }
  ~HeldPose() { innermost() = outer_; }
  HeldPose(const HeldPose&) = delete;
  HeldPose& operator=(const HeldPose&) = delete;

  /// Whether a call further up on this thread does.
  static bool isHeldHere(const SharedSurface& shared) {
    const HeldPose* held = innermost();
    while (held && &held->shared_ != &shared) {
      held = held->outer_;
    }
    return held != nullptr;
  }

 private:
  static HeldPose*& innermost() {
    static thread_local HeldPose* held = nullptr;
    return held;
  }

  const SharedSurface& shared_;
  std::shared_lock<std::shared_mutex> lock_;
  HeldPose* outer_;
};

void bindQueries(py::class_<SharedSurface>& type);
void bindScatter(py::class_<SharedSurface>& type);
void bindTessellate(py::class_<SharedSurface>& type);

}  // namespace limitsurf::python
