// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/nest_store.h"

#include <functional>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace limitsurf {
namespace {

static_assert(std::is_trivially_destructible_v<WideTree::Node> &&
              std::is_trivially_destructible_v<SearchLeaf> &&
              std::is_trivially_destructible_v<BezierPatch> &&
              std::is_trivially_destructible_v<TreePart>);

/// The number of lines of memory that so many objects need.
template <typename T>
constexpr std::size_t linesOf(std::size_t count) {
  constexpr std::size_t kLine = 64;
  static_assert(alignof(T) <= kLine);
  return (count * sizeof(T) + kLine - 1) / kLine;
}

template <typename T, typename Allocator>
Span<T> copied(const std::vector<T, Allocator>& from, void* to) {
  T* const begin = static_cast<T*>(to);
  std::uninitialized_copy(from.begin(), from.end(), begin);
  return {begin, from.size()};
}

}  // namespace

NestStore::NestStore(const Room& room)
    : count_(room.nests),
      made_(new std::atomic<const TreePart*>[room.nests]),
      // What refers to the parts of a nest is rounded up to lines, and so are its nodes and leaves.
      memory_(linesOf<WideTree::Node>(room.nodes) + linesOf<SearchLeaf>(room.leaves) +
              room.nests * (linesOf<TreePart>(1) + 2)),
      patches_(linesOf<BezierPatch>(room.patches)),
      most_patches_(room.patches) {
  for (std::size_t i = 0; i < count_; ++i) {
    made_[i].store(nullptr, std::memory_order_relaxed);
  }
}

NestStore::~NestStore() {
  for (std::size_t i = 0; i < count_; ++i) {
    if (const TreePart* const nest = made(i)) {
      free(reinterpret_cast<Line*>(const_cast<TreePart*>(nest)));
    }
  }
}

const TreePart& NestStore::keep(std::size_t nest, const BuiltPart& built) {
  const std::size_t head = linesOf<TreePart>(1),
                    nodes = linesOf<WideTree::Node>(built.nodes.size());
  Line* const memory = allocate(head + nodes + linesOf<SearchLeaf>(built.leaves.size()));
  TreePart* const part = new (memory) TreePart;
  part->nodes = copied(built.nodes, memory + head);
  part->leaves = copied(built.leaves, memory + head + nodes);
  if (void* const patches = roomForPatches(built.patches.size())) {
    part->kept = copied(built.patches, patches);
  }
  const TreePart* kept = nullptr;
  if (!made_[nest].compare_exchange_strong(kept, part, std::memory_order_acq_rel)) {
    free(memory);
    return *kept;
  }
  return *part;
}

NestStore::Line* NestStore::allocate(std::size_t lines) {
  if (lines_used_.load(std::memory_order_relaxed) < memory_.size()) {
    const std::size_t first = lines_used_.fetch_add(lines, std::memory_order_relaxed);
    if (first + lines <= memory_.size()) {
      return memory_.data() + first;
    }
  }
  return static_cast<Line*>(::operator new(lines * sizeof(Line), std::align_val_t(alignof(Line))));
}

void* NestStore::roomForPatches(std::size_t count) {
  if (patches_used_.load(std::memory_order_relaxed) >= most_patches_) {
    return nullptr;
  }
  const std::size_t first = patches_used_.fetch_add(count, std::memory_order_relaxed);
  return first + count <= most_patches_ ? reinterpret_cast<BezierPatch*>(patches_.data()) + first
                                        : nullptr;
}

void NestStore::free(Line* memory) const {
  const std::less<const Line*> isBefore;
  const bool is_shared =
      !isBefore(memory, memory_.data()) && isBefore(memory, memory_.data() + memory_.size());
  if (!is_shared) {
    ::operator delete(memory, std::align_val_t(alignof(Line)));
  }
}

}  // namespace limitsurf
