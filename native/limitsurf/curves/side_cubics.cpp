// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/side_cubics.h"

#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

/// The sides of a patch: the parameters at which each begins, and the indices of its first Bezier
/// point and of the step to the next.
struct PatchSide {
  double s, t;
  double ds, dt;
  int first, step;
};
constexpr PatchSide kPatchSides[4] = {
    {0, 0, 1, 0, 0, 1}, {1, 0, 0, 1, 3, 4}, {0, 1, 1, 0, 12, 1}, {0, 0, 0, 1, 0, 4}};

/// Where one of a rectangle's sides lies on a side of the face.
struct Overlap {
  int side = -1;  ///< of the rectangle, or -1 where none lies there
  double low = 0, high = 0;
  bool forward = true;  ///< whether the rectangle's side runs in the direction of the face's
};

Overlap overlap(const FaceRectangle& on, const FaceSide& side) {
  // Differences come first: they are exact, also where the rectangle is much smaller than the
  // rounding of places on the face.
  const double u0 = on.u0 - side.u0, v0 = on.v0 - side.v0;
  for (int k = 0; k < 4; ++k) {
    const PatchSide& of = kPatchSides[k];
    const double du = on.us * of.ds + on.ut * of.dt, dv = on.vs * of.ds + on.vt * of.dt;
    const double u = u0 + (on.us * of.s + on.ut * of.t), v = v0 + (on.vs * of.s + on.vt * of.t);
    if (side.du * v - side.dv * u == 0 && side.du * dv - side.dv * du == 0) {
      const double x = side.du * u + side.dv * v, dx = side.du * du + side.dv * dv;
      return {k, std::min(x, x + dx), std::max(x, x + dx), dx > 0};
    }
  }
  return {};
}

class Collector {
 public:
  Collector(const SurfacePatches& patches, const FaceSide& side) : patches_(patches), side_(side) {}

  void add(const SurfacePiece& piece) {
    if (!piece.isCore()) {
      if (overlap(patches_.rectangle(piece), side_).side >= 0) {
        add(patches_.patch(piece));
      }
      return;
    }
    if (overlap(patches_.rectangle(piece), side_).side >= 0) {
      addCore(piece);
    }
  }

  std::vector<CurveCubic> sorted() {
    // Near the end of a side several cubics may begin at the same rounded place: they were added in
    // the right order.
    std::stable_sort(cubics_.begin(), cubics_.end(),
                     [](const CurveCubic& a, const CurveCubic& b) { return a.begin < b.begin; });
    return std::move(cubics_);
  }

 private:
  using Point = CurveCubic::Point;

  static double length(const Point& p) {
    return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  }

  void add(const BezierPatch& patch) {
    const Overlap at = overlap(patch.on, side_);
    if (at.side < 0) {
      return;
    }
    const PatchSide& of = kPatchSides[at.side];
    CurveCubic cubic;
    cubic.anchor = patch.anchor;
    for (int i = 0; i < 4; ++i) {
      cubic.points[at.forward ? i : 3 - i] = patch.points[of.first + of.step * i];
    }
    cubic.begin = at.low;
    cubic.end = at.high;
    length_ += length(cubic.points[3] - cubic.points[0]);
    cubics_.push_back(cubic);
  }

  /// Adds the patches of a core step by step, as long as the rest lies on the side.
  void addCore(SurfacePiece core) {
    SurfacePatches::SplitCore split;
    while (true) {
      patches_.split(core, split);
      for (const BezierPatch& patch : split.patches) {
        add(patch);
      }
      core = split.core;
      const FaceRectangle rest = patches_.rectangle(core);
      const Overlap at = overlap(rest, side_);
      if (at.side < 0) {
        return;
      }
      // Its vertex is where the rectangle's sides 0 and 3 begin; the cubics of the last step run
      // up to the rest's other end.
      const Vector3 vertex = patches_.coreVertex(core);
      const CurveCubic last = cubics_.back();
      const Point end = last.points[at.forward ? 0 : 3];
      Point from = Point::Zero();
      from.head<3>() = vertex.array() - last.anchor.head<3>();
      if (length(end - from) <= kStraightRest * length_ ||
          core.steps >= SurfacePatches::kMostSteps) {
        CurveCubic straight;
        straight.anchor = last.anchor;
        for (int i = 0; i < 4; ++i) {
          straight.points[at.forward ? i : 3 - i] = from + (end - from) * (i / 3.);
        }
        straight.begin = at.low;
        straight.end = at.high;
        cubics_.push_back(straight);
        return;
      }
    }
  }

  const SurfacePatches& patches_;
  const FaceSide& side_;
  std::vector<CurveCubic> cubics_;
  double length_ = 0;  // of the chords
};

}  // namespace

FaceTiles::FaceTiles(const SurfacePatches& patches, int face_count) {
  first_.assign(static_cast<std::size_t>(face_count) + 1, patches.tileCount());
  std::vector<SurfacePiece> pieces;
  for (int tile = patches.tileCount() - 1; tile >= 0; --tile) {
    pieces.clear();
    patches.appendPieces(tile, pieces);
    first_[static_cast<std::size_t>(patches.rectangle(pieces.front()).face)] = tile;
  }
  for (int face = face_count - 1; face >= 0; --face) {
    const auto i = static_cast<std::size_t>(face);
    first_[i] = std::min(first_[i], first_[i + 1]);
  }
}

std::vector<CurveCubic> sideCubics(const SurfacePatches& patches, const FaceTiles& tiles,
                                   const FaceSide& side) {
  Collector collector(patches, side);
  std::vector<SurfacePiece> pieces;
  for (int tile = tiles.begin(side.face); tile < tiles.end(side.face); ++tile) {
    pieces.clear();
    patches.appendPieces(tile, pieces);
    for (const SurfacePiece& piece : pieces) {
      collector.add(piece);
    }
  }
  return collector.sorted();
}

}  // namespace limitsurf
