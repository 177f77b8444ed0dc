// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/patches/settling_cores.h"

namespace limitsurf {
namespace {

/// CoreTangents pay for kinds of which there are at least so many cores.
constexpr int kManyCores = 20;

}  // namespace

SettlingCores::SettlingCores(const SurfacePatches& patches) : patches_(patches) {
  for (const auto& [kind, count] : patches.coreKinds()) {
    if (count >= kManyCores) {
      tangents_.emplace(kind, CoreTangents(*kind.first, kind.second));
    }
  }
}

bool SettlingCores::settle(const SurfacePiece& core, CoreTangents::Settling& out) const {
  const auto tangents = tangents_.find(patches_.coreKind(core));
  Padded points[SurfacePatches::kMostCorePoints];
  return tangents != tangents_.end() && patches_.corePoints(core, points) &&
         tangents->second.settle(points, out);
}

}  // namespace limitsurf
