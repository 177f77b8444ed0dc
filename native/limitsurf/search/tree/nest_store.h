// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "limitsurf/large_pages.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/search/tree/tree_part.h"

namespace limitsurf {

/// The nests of a search tree that have been made. Searches read them in no particular order, so
/// that they lie side by side in large pages, in the order in which they were made.
///
/// Any number of threads may find that a nest is missing. Each makes it, and the first one that is
/// ready is kept. Nobody waits for another, who might be in a process from which this one was
/// forked.
class NestStore {
 public:
  /// What memory is set aside for. It is only used as nests are made, and does not need to suffice.
  struct Room {
    std::size_t nests = 0, nodes = 0, leaves = 0;
    std::size_t patches = 0;  ///< of leaves; others are not kept
  };

  explicit NestStore(const Room& room);
  ~NestStore();
  NestStore(const NestStore&) = delete;
  NestStore& operator=(const NestStore&) = delete;

  /// A nest, or null if it is not made yet.
  const TreePart* made(std::size_t nest) const {
    return made_[nest].load(std::memory_order_acquire);
  }
  /// Has a nest's first node brought into the processor's caches, if it is made.
  void expect(std::size_t nest) const {
    if (const TreePart* const part = made(nest)) {
      prefetch(*reinterpret_cast<const NestHead*>(part));
    }
  }
  /// Keeps a copy of a nest, unless another thread was faster. Returns what is kept.
  const TreePart& keep(std::size_t nest, const BuiltPart& built);

 private:
  /// The alignment of everything that is kept: a line of the processor's caches.
  struct alignas(64) Line {
    std::byte bytes[64];
  };

  /// Where a nest begins: what refers to its parts, and the root.
  struct NestHead {
    Line part;
    WideTree::Node root;
  };
  static_assert(sizeof(TreePart) <= sizeof(Line) && alignof(WideTree::Node) <= alignof(Line));

  /// Memory for so many lines.
  Line* allocate(std::size_t lines);
  /// Memory for so many patches; null if there is no room for all.
  void* roomForPatches(std::size_t count);
  void free(Line* memory) const;

  std::size_t count_;
  std::unique_ptr<std::atomic<const TreePart*>[]> made_;
  LargePageVector<Line> memory_, patches_;
  const std::size_t most_patches_;
  std::atomic<std::size_t> lines_used_{0}, patches_used_{0};
};

}  // namespace limitsurf
