// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/surface_search.h"

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/parallel.h"
#include "limitsurf/search/checks.h"
#include "limitsurf/search/normals/normal_cones.h"
#include "limitsurf/search/search_tree.h"

namespace limitsurf {
namespace {

/// The number of tiles whose leaves one task finds, and of leaves whose patches it keeps.
constexpr std::size_t kTilesPerTask = 1024, kLeavesPerTask = 1024;

using PatchPoints = Eigen::Matrix<double, 16, 3, Eigen::RowMajor>;

/// The control points of a patch in the coordinates of boxes.
PatchPoints pointsOf(const BezierPatch& patch, const Vector3& middle) {
  PatchPoints points;
  const Vector3 anchor = patch.anchor.head<3>().matrix() - middle;
  for (int i = 0; i < 16; ++i) {
    points.row(i) = (patch.points[i].head<3>().matrix() + anchor).transpose();
  }
  return points;
}

Box boxOf(const Eigen::Ref<const Points>& points) {
  return {points.colwise().minCoeff().transpose(), points.colwise().maxCoeff().transpose()};
}

LeafBox orientedBox(const PatchPoints& points) {
  const auto side = [&](int to, int from) -> Vector3 {
    return (points.row(to) - points.row(from)).transpose();
  };
  return {points, side(3, 0) + side(15, 12), side(12, 0) + side(15, 3)};
}

}  // namespace

SearchTree::SearchTree(const LimitSurface& limit_surface, int threads)
    : surface(limit_surface),
      patches(limit_surface, threads, PatchUnit::own),
      scale(patches.scale()),
      middle(patches.middle()),
      tolerance(kSearchError / 10 * patches.diagonal()),
      rings(patches, tolerance) {
  const std::size_t tiles = static_cast<std::size_t>(patches.tileCount());
  struct Block {
    std::vector<SearchLeaf> leaves;
    std::vector<BoxF> boxes;
  };
  std::vector<Block> blocks((tiles + kTilesPerTask - 1) / kTilesPerTask);
  parallelFor(blocks.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      for (std::size_t tile = block * kTilesPerTask;
           tile < std::min(tiles, (block + 1) * kTilesPerTask); ++tile) {
        addLeaves(static_cast<int>(tile), blocks[block].leaves, blocks[block].boxes);
      }
    }
  });
  std::size_t count = 0;
  for (const Block& block : blocks) {
    count += block.leaves.size();
  }
  std::vector<SearchLeaf> unordered;
  std::vector<BoxF> boxes;
  unordered.reserve(count);
  boxes.reserve(count);
  for (Block& block : blocks) {
    unordered.insert(unordered.end(), block.leaves.begin(), block.leaves.end());
    boxes.insert(boxes.end(), block.boxes.begin(), block.boxes.end());
    block = {};
    InterruptionPoint::pass();
  }
  for (int ring = 0; ring < patches.ringCount(); ++ring) {
    if (rings.isLarge(ring)) {
      addRing(ring, unordered, boxes);
    }
  }
  std::vector<std::int32_t> order;
  tree = std::make_unique<WideTree>(BoxTree(boxes, order, threads), threads);
  leaves.resize(unordered.size());
  parallelFor(leaves.size(), kLeavesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      leaves[leaf] = unordered[order[leaf]];
    }
  });
  if (leaves.size() * sizeof(BezierPatch) <= kPatchBytes) {
    kept.resize(leaves.size());
    parallelFor(leaves.size(), kLeavesPerTask, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf) {
        if (!leaves[leaf].piece.isCore()) {
          kept[leaf] = patches.patch(leaves[leaf].piece);
        }
      }
    });
  }
}

SearchTree::~SearchTree() = default;

const NormalCones& SearchTree::normalCones(int threads) const {
  return cones_.get([&] { return std::make_unique<const NormalCones>(*this, threads); });
}

void SearchTree::addLeaves(int tile, std::vector<SearchLeaf>& out, std::vector<BoxF>& boxes) const {
  std::vector<SurfacePiece> pieces;
  patches.appendPieces(tile, pieces);
  const auto addPatch = [&](const SurfacePiece& piece, const BezierPatch& patch) {
    const PatchPoints points = pointsOf(patch, middle);
    out.push_back({orientedBox(points), piece, FootBound(patch)});
    boxes.emplace_back(boxOf(points));
  };
  for (const SurfacePiece& piece : pieces) {
    if (!piece.isCore()) {
      addPatch(piece, patches.patch(piece));
      continue;
    }
    const int steps = stepsBefore(piece);
    SurfacePatches::SplitCore split;
    SurfacePiece core = piece;
    for (int step = 1; step <= steps; ++step) {
      patches.split(core, split);
      core = split.core;
      for (int quarter = 0; quarter < 3; ++quarter) {
        addPatch(split.pieces[quarter], split.patches[quarter]);
      }
    }
    if (!rings.isLarge(patches.ringOf(core))) {
      addCore(core, split, out, boxes);
    }
  }
}

int SearchTree::stepsBefore(const SurfacePiece& core) const {
  const int ring = patches.ringOf(core);
  if (rings.isLarge(ring)) {
    return rings.firstLevel(ring) - patches.ringLevel(core);
  }
  // The cores of small tiles are split once, those of whole faces twice.
  const FaceRectangle on = patches.rectangle(core);
  return std::abs(on.us + on.ut) == 1 ? 2 : 1;
}

void SearchTree::addRing(int ring, std::vector<SearchLeaf>& out, std::vector<BoxF>& boxes) const {
  const Eigen::Matrix3d frame = patches.ringFrame(ring);
  const int first = rings.firstLevel(ring);
  Box box, turned;
  SurfacePatches::SplitCore split;
  InterruptionStride stride;
  const auto include = [&](const Vector3& point) {
    box.include(point);
    turned.include(Vector3(frame * point));
  };
  for (int place = 0; place < rings.coreCount(ring); ++place) {
    stride.step();
    patches.split(rings.core(ring, place, first), split);
    for (const BezierPatch& patch : split.patches) {
      const PatchPoints points = pointsOf(patch, middle);
      for (int i = 0; i < 16; ++i) {
        include(points.row(i).transpose());
      }
    }
    const CoreHull rest = patches.restHull(split);
    for (int corner = 0; corner < 8; ++corner) {
      include(inBoxes(rest.vertex) + rest.axes.transpose() * rest.corner(corner));
    }
  }
  Eigen::Matrix<double, 8, 3, Eigen::RowMajor> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 at((corner & 1 ? turned.high : turned.low)[0],
                     (corner & 2 ? turned.high : turned.low)[1],
                     (corner & 4 ? turned.high : turned.low)[2]);
    corners.row(corner) = (frame.transpose() * at).transpose();
  }
  out.push_back({LeafBox(corners, frame.row(0), frame.row(1)), rings.core(ring, 0, first), {}});
  boxes.emplace_back(box);
}

void SearchTree::addCore(const SurfacePiece& core, SurfacePatches::SplitCore& split,
                         std::vector<SearchLeaf>& out, std::vector<BoxF>& boxes) const {
  // The box is found from the patches of one more step and the hull of the rest.
  patches.split(core, split);
  Eigen::Matrix<double, 3 * 16 + 8, 3, Eigen::RowMajor> points;
  for (int quarter = 0; quarter < 3; ++quarter) {
    points.middleRows<16>(16 * quarter) = pointsOf(split.patches[quarter], middle);
  }
  const CoreHull rest = patches.restHull(split);
  for (int corner = 0; corner < 8; ++corner) {
    points.row(3 * 16 + corner) =
        (inBoxes(rest.vertex) + rest.axes.transpose() * rest.corner(corner)).transpose();
  }
  // The core's opposite corner, the last point of the second patch, gives the first axis.
  const Vector3 normal = rest.axes.row(2);
  const Vector3 along = points.row(2 * 16 - 1).transpose() - inBoxes(rest.vertex);
  const Vector3 tangent = along - along.dot(normal) * normal;
  out.push_back({LeafBox(points, tangent, normal.cross(tangent)), core, {}});
  boxes.emplace_back(boxOf(points));
}

SurfaceSearch::SurfaceSearch(const LimitSurface& surface, int threads)
    : data_(std::make_unique<SearchTree>(surface, threads)) {}
SurfaceSearch::~SurfaceSearch() = default;
SurfaceSearch::SurfaceSearch(SurfaceSearch&&) noexcept = default;
SurfaceSearch& SurfaceSearch::operator=(SurfaceSearch&&) noexcept = default;

double SurfaceSearch::farthestOrigin() const { return kFarthestPoint / data_->scale; }

}  // namespace limitsurf
