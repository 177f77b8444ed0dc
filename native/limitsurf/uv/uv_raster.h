// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "limitsurf/uv/uv_borders.h"
#include "limitsurf/uv/uv_map.h"
#include "limitsurf/uv/uv_overlap.h"
#include "limitsurf/uv/uv_patches.h"

namespace limitsurf {

/// The best find at each point of a lattice.
class LatticeFinds : public UvPatches::Sink {
 public:
  struct Slot {
    double u = 0, v = 0;
    std::int32_t face = -1;
    bool overlap = false;
    bool flipped = false;
    bool within_cell = false;  ///< there is a find that is not on the border of its cell
  };

  /// The slots are overwritten. Their memory is the caller's, so that many lattices can share it.
  LatticeFinds(const Lattice& lattice, std::vector<Slot>& slots)
      : lattice_(lattice), width_(lattice.x1 - lattice.x0 + 1), slots_(slots) {
    slots_.assign(static_cast<std::size_t>(width_) * (lattice.y1 - lattice.y0 + 1), Slot());
  }

  void enter(const FaceRectangle& on) override { on_ = on; }
  void add(const Find& find) override;
  bool wants(int x, int y, const UvCell& cell) const override;
  /// Decides about overlaps. It must be called after all finds have been added.
  void finish();

  const Slot& at(int x, int y) const {
    return slots_[static_cast<std::size_t>(y - lattice_.y0) * width_ + (x - lattice_.x0)];
  }

 private:
  /// Whether a location comes before that of a slot.
  static bool isBefore(const Location& at, const Slot& slot);

  const Lattice lattice_;
  const std::int64_t width_;
  FaceRectangle on_;
  std::vector<Slot>& slots_;
  std::vector<BorderFind> border_finds_;
};

/// Throws std::invalid_argument naming the first option out of range.
void checkOptions(const RasterOptions& options);

/// UvMap::rasterize(). `borders` is called only if there is a margin.
Texels rasterize(const UvPatches& map, const std::function<const UvBorders&()>& borders,
                 const RasterOptions& options, int threads, const Progress& progress);

}  // namespace limitsurf
