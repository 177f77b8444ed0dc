// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "limitsurf/surface/patches/core_tangents.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// The tangents of the kinds of cores that a surface has often.
class SettlingCores {
 public:
  /// Refers to the patches. O(valence^3) for each kind.
  explicit SettlingCores(const SurfacePatches& patches);

  /// CoreTangents::settle() of a core. Returns false if nothing is known, as for kinds that are
  /// rare. May be called from many threads at once.
  bool settle(const SurfacePiece& core, CoreTangents::Settling& out) const;

 private:
  const SurfacePatches& patches_;
  std::map<SurfacePatches::CoreKind, CoreTangents> tangents_;
};

}  // namespace limitsurf
