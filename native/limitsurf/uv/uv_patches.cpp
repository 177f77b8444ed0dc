// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_patches.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {
namespace {

/// The boxes of SurfacePatches would exceed the range of single precision beyond this.
constexpr double kFarthest = 1e36;

/// The number of pieces that one task finds boxes for.
constexpr std::size_t kPiecesPerTask = 1024;

Box2 inPlane(const Box& box) { return {box.low.head<2>().array(), box.high.head<2>().array()}; }

Box2 boxOf(const BezierPatch& patch) {
  Box2 box;
  for (const BezierPatch::Point& point : patch.points) {
    box.include((patch.anchor + point).head<2>());
  }
  return box;
}

/// Whether a map is mirrored at an extraordinary vertex is decided after this many steps: closer to
/// the vertex directions may become parallel, as at smooth corners, and rounding would decide.
constexpr int kSignSteps = 8;

/// The Jacobian determinant of a patch at its (0, 0), up to a positive factor.
double jacobianAtCorner(const BezierPatch& patch, const PlaneFrame& frame) {
  const Point2 ds = (patch.points[1] - patch.points[0]).head<2>();
  const Point2 dt = (patch.points[4] - patch.points[0]).head<2>();
  return cross(ds * frame.scale, dt * frame.scale);
}

/// Returns the map itself, so that a constructor can check it before its first member is made.
const SurfaceData& checked(const SurfaceData& map) {
  if (map.columns() != 2) {
    throw std::invalid_argument("the data have " + std::to_string(map.columns()) +
                                " columns; a UV map has 2");
  }
  return map;  // NOLINT(bugprone-return-const-ref-from-parameter): the caller's own argument
}

}  // namespace

UvCell cellOf(const BezierPatch& patch, const PlaneFrame& frame) {
  UvCell cell;
  const Point2 anchor = frame.at(patch.anchor.head<2>());
  for (int i = 0; i < 16; ++i) {
    cell.points[i] = anchor + patch.points[i].head<2>() * frame.scale;
  }
  return cell;
}

UvPatches::UvPatches(const SurfaceData& map, int threads) : patches_(checked(map), threads) {
  const Vector3 half = Vector3::Constant(0.5 * patches_.diagonal());
  const Vector3 reach = patches_.middle().cwiseAbs() + half;
  extent_ = std::hypot(reach[0], reach[1]);
  if (!(extent_ <= kFarthest)) {
    std::ostringstream message;
    message << "the UV map's coordinates reach " << extent_ << "; at most " << kFarthest
            << " can be inverted";
    throw std::invalid_argument(message.str());
  }
  for (int tile = 0; tile < patches_.tileCount(); ++tile) {
    std::vector<SurfacePiece> of_tile;
    patches_.appendPieces(tile, of_tile);
    for (const SurfacePiece& piece : of_tile) {
      pieces_.push_back({piece, {}});
    }
  }
  parallelFor(pieces_.size(), kPiecesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfacePiece& piece = pieces_[i].piece;
      pieces_[i].box =
          piece.isCore() ? inPlane(patches_.coreBox(piece)) : boxOf(patches_.patch(piece));
    }
  });
}

void UvPatches::invert(const UvPiece& piece, const PlaneFrame& frame, LatticeInverse& inverse,
                       Sink& sink) const {
  if (inverse.within(frame.at(piece.box)).empty()) {
    return;
  }
  if (piece.piece.isCore()) {
    invertCore(piece, frame, inverse, sink);
    return;
  }
  const BezierPatch patch = patches_.patch(piece.piece);
  sink.enter(patch.on);
  inverse.add(cellOf(patch, frame));
}

void UvPatches::invertCore(const UvPiece& piece, const PlaneFrame& frame, LatticeInverse& inverse,
                           Sink& sink) const {
  SurfacePatches::SplitCore split;
  SurfacePiece core = piece.piece;
  bool flipped = false;
  for (;;) {
    patches_.split(core, split);
    if (core.steps <= kSignSteps) {
      flipped = jacobianAtCorner(split.patches[1], frame) < 0;
    }
    bool is_flat = core.steps == 0;
    for (const BezierPatch& patch : split.patches) {
      const UvCell cell = cellOf(patch, frame);
      is_flat = is_flat && inverse.isFlat(cell);
      sink.enter(patch.on);
      if (core.steps == 0) {
        inverse.add(cell);
      } else {
        inverse.addPart(cell);
      }
    }
    if (is_flat) {
      return;
    }
    core = split.core;
    const Box2 rest = frame.at(inPlane(split.core_box));
    const Lattice inside = inverse.within(rest);
    if (inside.empty()) {
      return;
    }
    const bool is_point = ((rest.high - rest.low) <= inverse.tolerance()).all();
    if (!is_point && core.steps < SurfacePatches::kMostSteps) {
      continue;
    }
    sink.enter(patches_.rectangle(piece.piece));
    addVertex(core, split, flipped, frame, inside, sink);
    return;
  }
}

void UvPatches::addVertex(SurfacePiece core, SurfacePatches::SplitCore& split, bool flipped,
                          const PlaneFrame& frame, const Lattice& inside, Sink& sink) const {
  while (core.steps < SurfacePatches::kMostSteps) {
    patches_.split(core, split);
    core = split.core;
  }
  const Point2 first = split.patches[0].points[0].head<2>() * frame.scale,
               middle = split.patches[1].points[0].head<2>() * frame.scale,
               last = split.patches[2].points[0].head<2>() * frame.scale;
  Find find;
  find.s = find.t = 0;
  find.flipped = flipped;
  find.on_border = true;
  find.wedge_count = 2;
  find.wedges[0] = {first, middle};
  find.wedges[1] = {middle, last};
  if (find.flipped) {
    std::swap(find.wedges[0].first, find.wedges[0].last);
    std::swap(find.wedges[1].first, find.wedges[1].last);
  }
  for (find.y = inside.y0; find.y <= inside.y1; ++find.y) {
    for (find.x = inside.x0; find.x <= inside.x1; ++find.x) {
      sink.add(find);
    }
  }
}

}  // namespace limitsurf
