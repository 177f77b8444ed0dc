// SPDX-License-Identifier: Apache-2.0
//
// What the cores around one extraordinary vertex have in common.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/pi.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/surface/patches/surface_patches_data.h"

namespace limitsurf {

int SurfacePatches::ringCount() const { return static_cast<int>(data_->table.rings.size()); }

int SurfacePatches::ringOf(const SurfacePiece& core) const { return data_->ringTile(core).ring; }

int SurfacePatches::ringFace(const SurfacePiece& core) const { return data_->ringTile(core).face; }

int SurfacePatches::ringLevel(const SurfacePiece& core) const {
  return core.steps + data_->ringTile(core).ring_steps;
}

Eigen::Matrix3d SurfacePatches::ringFrame(int ring) const { return data_->frames[ring]; }

double SurfacePatches::ringAsymmetry(const std::vector<SurfacePiece>& cores, double enough) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (cores.empty()) {
    return kNone;
  }
  const int ring_index = ringOf(cores[0]);
  const Ring& ring = data_->table.rings[ring_index].basis->ring();
  if (ring.kind != RingKind::interior || static_cast<int>(cores.size()) != ring.faces) {
    return kNone;
  }
  const Eigen::Matrix3d& frame = data_->frames[ring_index];
  Padded first[tile_grid::kSlots], grid[tile_grid::kSlots];
  data_->nextGrid(cores[0], false, first);
  // The frame's last axis may point to either side, so that the faces turn either way around it.
  double apart[2] = {0, 0};
  for (std::size_t i = 1; i < cores.size(); ++i) {
    data_->nextGrid(cores[i], false, grid);
    const double angle = 2 * kPi<double> * (ringFace(cores[i]) - ringFace(cores[0])) / ring.faces;
    for (int way = 0; way < 2; ++way) {
      const Eigen::Matrix3d turn =
          frame.transpose() *
          Eigen::AngleAxisd(way == 0 ? angle : -angle, Vector3::UnitZ()).toRotationMatrix() * frame;
      for (int c = 0; c < tile_grid::kSlots; ++c) {
        if (tile_grid::exists(Sides::inner, c)) {
          const Vector3 turned = turn * first[c].head<3>().matrix();
          apart[way] = std::max(apart[way], (turned - grid[c].head<3>().matrix()).norm());
        }
      }
    }
    if (!(data_->scale * std::min(apart[0], apart[1]) < enough)) {
      return kNone;
    }
  }
  return data_->scale * std::min(apart[0], apart[1]);
}

}  // namespace limitsurf
