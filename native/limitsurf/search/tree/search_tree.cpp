// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/search_tree.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "limitsurf/parallel.h"
#include "limitsurf/search/normals/normal_cones.h"
#include "limitsurf/search/tree/crowd.h"
#include "limitsurf/search/tree/nest_builder.h"

namespace limitsurf {
namespace {

/// The number of tiles whose leaves one task finds, and of leaves whose patches it keeps.
constexpr std::size_t kTilesPerTask = 1024, kLeavesPerTask = 1024;
/// The number of nests that one task makes: less than a millisecond.
constexpr std::size_t kNestsPerTask = 64;
/// A nest has an oriented box if its area is at most this share of half the area of its other box.
/// A long and thin face that lies aslant has a box along the coordinate axes that is nearly empty:
/// searches would enter the nests of most faces around a pole, where few leaves are near. The share
/// is 0.06 to 0.35 for the triangles of a wavy sheet, and less than 0.05 around a pole of 512
/// faces.
constexpr double kThin = 0.05;

}  // namespace

/// What the top of the tree is made of.
struct SearchTree::Pieces {
  std::vector<SearchLeaf> leaves;
  std::vector<BoxF> leaf_boxes;
  std::vector<Tiles> nests;
  std::vector<BoxF> nest_boxes;
  NestBoxes thin;        ///< of the nests
  NestStore::Room room;  ///< for the nests

  void add(const LeafMaker::Leaf& leaf) {
    leaves.push_back(leaf.leaf);
    leaf_boxes.push_back(leaf.box);
  }
  void append(Pieces&& other) {
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(leaves, other.leaves);
    append(leaf_boxes, other.leaf_boxes);
    const auto boxes = static_cast<std::int32_t>(thin.boxes.size());
    for (const std::int32_t box : other.thin.of_nest) {
      thin.of_nest.push_back(box < 0 ? box : boxes + box);
    }
    append(thin.boxes, other.thin.boxes);
    append(nests, other.nests);
    append(nest_boxes, other.nest_boxes);
    room.leaves += other.room.leaves;
    room.nodes += other.room.nodes;
    other = {};
  }
};

SearchTree::SearchTree(const LimitSurface& limit_surface, int threads)
    : surface(limit_surface),
      patches(limit_surface, threads, PatchUnit::own),
      scale(patches.scale()),
      crowd(crowdOf(limit_surface, patches)),
      middle(crowd.value_or(patches.middle())),
      tolerance(kSearchError / 10 * patches.diagonal()),
      rings(patches, tolerance),
      maker_(patches, rings, middle) {
  const int tiles = patches.tileCount();
  const auto blocks_count = (static_cast<std::size_t>(tiles) + kTilesPerTask - 1) / kTilesPerTask;
  std::vector<Pieces> blocks(blocks_count);
  parallelFor(blocks_count, 1, threads, [&](std::size_t begin, std::size_t end) {
    const auto faceOf = [&](int tile) { return patches.rectangle({tile, 0, 0}).face; };
    for (std::size_t block = begin; block < end; ++block) {
      // A face belongs to the block in which its first tile is.
      int tile = static_cast<int>(block * kTilesPerTask);
      const int next_block = std::min(tiles, tile + static_cast<int>(kTilesPerTask));
      while (tile > 0 && tile < next_block && faceOf(tile) == faceOf(tile - 1)) {
        ++tile;
      }
      while (tile < next_block) {
        int next = tile + 1;
        while (next < tiles && faceOf(next) == faceOf(tile)) {
          ++next;
        }
        addFace({tile, next - tile}, blocks[block]);
        tile = next;
      }
    }
  });
  Pieces all;
  for (Pieces& block : blocks) {
    all.append(std::move(block));
    InterruptionPoint::pass();
  }
  for (int ring = 0; ring < patches.ringCount(); ++ring) {
    if (rings.isLarge(ring)) {
      all.add(maker_.ofRing(ring));
    }
  }
  const std::size_t leaf_count = all.leaves.size(), nest_count = all.nests.size();
  std::vector<BoxF> boxes = std::move(all.leaf_boxes);
  boxes.insert(boxes.end(), all.nest_boxes.begin(), all.nest_boxes.end());
  std::vector<std::int32_t> order;
  top_nodes_ = WideTree(BoxTree(boxes, order, threads), threads).takeNodes();
  // Leaves and nests are in the order of the tree, and a node says which is which.
  first_nest_ = static_cast<std::int32_t>(top_nodes_.size());
  top_leaves_.reserve(leaf_count);
  nest_tiles_.reserve(nest_count);
  std::vector<std::int32_t> places;
  places.reserve(order.size());
  NestBoxes thin_nests{std::move(all.thin.boxes), {}};
  thin_nests.of_nest.reserve(nest_count);
  for (const std::int32_t i : order) {
    const auto number = static_cast<std::size_t>(i);
    if (number < leaf_count) {
      places.push_back(~static_cast<std::int32_t>(top_leaves_.size()));
      top_leaves_.push_back(all.leaves[number]);
    } else {
      thin_nests.of_nest.push_back(all.thin.of_nest[number - leaf_count]);
      places.push_back(first_nest_ + static_cast<std::int32_t>(nest_tiles_.size()));
      nest_tiles_.push_back(all.nests[number - leaf_count]);
    }
  }
  for (WideTree::Node& node : top_nodes_) {
    for (int i = 0; i < node.count; ++i) {
      if (WideTree::isLeaf(node.children[i])) {
        node.children[i] = places[static_cast<std::size_t>(WideTree::leaf(node.children[i]))];
      }
    }
  }
  closer_boxes_ = makeCloserBoxes(top_nodes_, top_leaves_, thin_nests);
  constexpr std::size_t kMostPatches = kPatchBytes / sizeof(BezierPatch);
  if (leaf_count <= kMostPatches) {
    top_patches_.resize(leaf_count);
    parallelFor(leaf_count, kLeavesPerTask, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf) {
        if (!top_leaves_[leaf].piece.isCore()) {
          top_patches_[leaf] = patches.patch(top_leaves_[leaf].piece);
        }
      }
    });
  }
  const auto spanOf = [](const auto& vector) { return Span{vector.data(), vector.size()}; };
  top_ = {spanOf(top_nodes_), spanOf(top_leaves_), spanOf(top_patches_)};
  all.room.nests = nest_count;
  all.room.patches = std::min(all.room.leaves, kMostPatches - top_patches_.size());
  nests_ = std::make_unique<NestStore>(all.room);
}

SearchTree::~SearchTree() = default;

std::vector<SurfacePiece> SearchTree::piecesOf(const Tiles& tiles) const {
  std::vector<SurfacePiece> pieces;
  for (int tile = tiles.first; tile < tiles.first + tiles.count; ++tile) {
    patches.appendPieces(tile, pieces);
  }
  return pieces;
}

void SearchTree::addFace(const Tiles& tiles, Pieces& out) const {
  const std::vector<SurfacePiece> pieces = piecesOf(tiles);
  if (std::none_of(pieces.begin(), pieces.end(),
                   [](const SurfacePiece& piece) { return piece.isCore(); })) {
    for (const SurfacePiece& piece : pieces) {
      out.add(maker_.ofPatch(piece, patches.patch(piece)));
    }
    return;
  }
  const NestBuilder builder(patches, maker_);
  const auto [box, area] = maker_.boxAround(pieces);
  if (!(box.low[0] <= box.high[0])) {
    return;  // all of the face belongs to leaves of whole rings
  }
  const BoxF bounds(box);
  std::int32_t thin_box = -1;
  if (area < kThin * double{bounds.halfArea()}) {
    thin_box = static_cast<std::int32_t>(out.thin.boxes.size());
    out.thin.boxes.push_back(maker_.orientedBoxAround(pieces));
  }
  out.thin.of_nest.push_back(thin_box);
  out.nests.push_back(tiles);
  out.nest_boxes.push_back(bounds);
  const std::size_t leaves = builder.leafCount(pieces);
  out.room.leaves += leaves;
  out.room.nodes += leaves / 2 + 1;  // about as many as it has
}

const TreePart& SearchTree::makeNest(std::int32_t i) const {
  const auto nest = static_cast<std::size_t>(i);
  return nests_->keep(nest, NestBuilder(patches, maker_).build(piecesOf(nest_tiles_[nest])));
}

void SearchTree::prepare(std::size_t searches, int threads) const {
  const std::size_t before = searches_.load(std::memory_order_relaxed);
  if (before >= nest_tiles_.size()) {
    return;  // all are made
  }
  if (before + searches >= nest_tiles_.size()) {
    makeAllNests(threads);
  }
  searches_.fetch_add(searches, std::memory_order_relaxed);
}

void SearchTree::makeAllNests(int threads) const {
  parallelFor(nest_tiles_.size(), kNestsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      nest(static_cast<std::int32_t>(i));
    }
  });
}

std::int32_t SearchTree::nestsMade() const {
  std::int32_t count = 0;
  for (std::size_t i = 0; i < nest_tiles_.size(); ++i) {
    count += nests_->made(i) ? 1 : 0;
  }
  return count;
}

void SearchTree::expect(const NearestFirst::Entry& at) const {
  if (at.part == kTop && at.place >= first_nest_) {
    nests_->expect(static_cast<std::size_t>(at.place - first_nest_));
    return;
  }
  const TreePart& part = at.part == kTop ? top_ : *nests_->made(static_cast<std::size_t>(at.part));
  if (WideTree::isLeaf(at.place)) {
    prefetch(part.leaves[static_cast<std::size_t>(WideTree::leaf(at.place))]);
  } else {
    prefetch(part.nodes[static_cast<std::size_t>(at.place)]);
  }
}

const NormalCones& SearchTree::normalCones(int threads) const {
  return cones_.get([&] { return std::make_unique<const NormalCones>(*this, threads); });
}

}  // namespace limitsurf
