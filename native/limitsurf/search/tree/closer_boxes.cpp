// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/closer_boxes.h"

#include <utility>

#include "limitsurf/interruption_point.h"
#include "limitsurf/search/tree/box_points.h"

namespace limitsurf {
namespace {

/// A box counts as nearly empty if the largest faces of the leaves' boxes in it have together at
/// most this part of half its own surface. Chosen: over faces that are about as long as wide, the
/// part is 0.3 or more.
constexpr double kNearlyEmpty = 0.25;
/// An oriented box is kept if its surface is at most this part of that of the other box.
constexpr double kSmaller = 0.5;
/// Over fewer leaves a box has the axes of the largest of them.
constexpr std::int32_t kFewLeaves = 8;

/// The number of leaves and nests under a node, and the sum of the largest faces of their boxes.
struct Content {
  std::int32_t leaves = 0;
  double area = 0;

  void add(const Content& other) {
    leaves += other.leaves;
    area += other.area;
  }
};

class Maker {
 public:
  Maker(LargePageVector<WideTree::Node>& nodes, const LargePageVector<SearchLeaf>& leaves,
        const NestBoxes& nests)
      : nodes_(nodes), leaves_(leaves), nests_(nests), contents_(nodes.size()) {}

  std::vector<CloserBoxes> make() {
    InterruptionStride stride;
    for (std::size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
      stride.step();
      WideTree::Node& node = nodes_[i];
      CloserBoxes closer{};
      for (int child = 0; child < node.count; ++child) {
        const std::int32_t place = node.children[child];
        const double half_area = boxOf(node, child).halfArea();
        Content& all = contents_[i];
        if (WideTree::isLeaf(place)) {
          all.add({1, leafOf(place).box.largestFace()});
        } else if (!isNode(place)) {
          // Nests have the numbers after those of all nodes. What is in most of them is not known.
          const LeafBox* const own = nests_.find(static_cast<std::size_t>(place) - nodes_.size());
          all.add({1, own ? own->largestFace() : half_area});
          if (own && own->halfArea() <= kSmaller * half_area) {
            closer.set(child, *own);
          }
        } else {
          const Content& content = contents_[static_cast<std::size_t>(place)];
          all.add(content);
          if (content.area <= kNearlyEmpty * half_area) {
            const LeafBox box = boxAround(nodes_[static_cast<std::size_t>(place)], content.leaves);
            if (box.halfArea() <= kSmaller * half_area) {
              closer.set(child, box);
            }
          }
        }
      }
      if (closer.children != 0) {
        node.closer = static_cast<std::int32_t>(made_.size());
        made_.push_back(closer);
      }
    }
    made_.shrink_to_fit();
    return std::move(made_);
  }

 private:
  bool isNode(std::int32_t place) const { return static_cast<std::size_t>(place) < nodes_.size(); }
  const SearchLeaf& leafOf(std::int32_t place) const {
    return leaves_[static_cast<std::size_t>(WideTree::leaf(place))];
  }
  static BoxF boxOf(const WideTree::Node& node, int child) {
    BoxF box = BoxF::empty();
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = node.bounds[axis][0][child];
      box.high[axis] = node.bounds[axis][1][child];
    }
    return box;
  }

  /// An oriented box around all children of a node, which is over so many leaves.
  LeafBox boxAround(const WideTree::Node& node, std::int32_t leaves) const {
    BoxPoints points(Vector3::Zero());
    points.reserve(8 * WideTree::kWidth);
    const LeafBox* largest = nullptr;
    for (int child = 0; child < node.count; ++child) {
      const std::int32_t place = node.children[child];
      const LeafBox* box = nullptr;
      if (WideTree::isLeaf(place)) {
        box = &leafOf(place).box;
      } else if (node.closer >= 0 && (made_[node.closer].children >> child & 1) != 0) {
        box = &made_[node.closer].boxes[child];
      }
      if (box) {
        points.add(*box);
        largest = !largest || box->halfArea() > largest->halfArea() ? box : largest;
      } else {
        points.add(boxOf(node, child));
      }
    }
    LeafBox box = largest && leaves < kFewLeaves ? alongAxesOf(*largest, points)
                                                 : points.alongPrincipalAxes();
    box.widenForRoundedAxes();
    return box;
  }

  static LeafBox alongAxesOf(const LeafBox& box, const BoxPoints& points) {
    const auto [longest, second] = box.longestAxes();
    return points.oriented<float>(box.axis(longest), box.axis(second));
  }

  LargePageVector<WideTree::Node>& nodes_;
  const LargePageVector<SearchLeaf>& leaves_;
  const NestBoxes& nests_;
  std::vector<Content> contents_;  // of each node
  std::vector<CloserBoxes> made_;
};

}  // namespace

std::vector<CloserBoxes> makeCloserBoxes(LargePageVector<WideTree::Node>& nodes,
                                         const LargePageVector<SearchLeaf>& leaves,
                                         const NestBoxes& nests) {
  return Maker(nodes, leaves, nests).make();
}

}  // namespace limitsurf
