// SPDX-License-Identifier: Apache-2.0
#include "kept_memory.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <new>

#include "limitsurf/large_pages.h"

namespace limitsurf::python {
namespace {

constexpr std::size_t kMostKept = std::size_t{1} << 26;
constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// What lies before the memory of an array, which thereby begins with a line of the cache.
struct alignas(64) Block {
  std::size_t size;  ///< with this header

  void* memory() { return this + 1; }
  static Block* of(void* memory) { return static_cast<Block*>(memory) - 1; }
};

/// The sizes of blocks are an eighth of a power of two apart, so that arrays of almost equal size
/// can have the same memory, one after another.
std::size_t sizeFor(std::size_t bytes) {
  std::size_t step = sizeof(Block);
  while (16 * step <= bytes) step *= 2;
  return (bytes + sizeof(Block) + step - 1) / step * step;
}

std::align_val_t alignmentOf(std::size_t size) {
  return std::align_val_t(size < kLargePage ? alignof(Block) : kLargePage);
}

Block* newBlock(std::size_t size) {
  void* const memory = ::operator new(size, alignmentOf(size), std::nothrow);
  if (memory == nullptr) return nullptr;
  askForLargePages(memory, size);
  return new (memory) Block{size};
}

void freeBlock(Block* block) { ::operator delete(block, alignmentOf(block->size)); }

/// Freed blocks, the oldest first.
class KeptBlocks {
 public:
  /// The block of this size that was freed last, which is the likeliest to be in a cache; null if
  /// there is none.
  Block* take(std::size_t size) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = count_; i-- > 0;) {
      if (blocks_[i]->size == size) return remove(i);
    }
    return nullptr;
  }

  void keep(Block* block) {
    const std::lock_guard<std::mutex> lock(mutex_);
    while (bytes_ + block->size > kMostKept) freeBlock(remove(0));
    blocks_[count_++] = block;
    bytes_ += block->size;
  }

  void freeAll() {
    const std::lock_guard<std::mutex> lock(mutex_);
    while (count_ > 0) freeBlock(remove(0));
  }

 private:
  Block* remove(std::size_t i) {
    Block* const block = blocks_[i];
    std::copy(blocks_ + i + 1, blocks_ + count_, blocks_ + i);
    --count_;
    bytes_ -= block->size;
    return block;
  }

  std::mutex mutex_;
  Block* blocks_[kMostKept / kLeastKept];  // there are no more, as each has kLeastKept bytes
  std::size_t count_ = 0, bytes_ = 0;
};

/// Arrays may be freed when the process ends, after static objects.
KeptBlocks& keptBlocks() {
  static auto* const blocks = new KeptBlocks;
  return *blocks;
}

bool isKept(std::size_t size) { return size >= kLeastKept && size <= kMostKept; }

}  // namespace

void* takeMemory(std::size_t bytes) noexcept {
  if (bytes > std::numeric_limits<std::size_t>::max() / 2) return nullptr;
  const std::size_t size = sizeFor(bytes);
  Block* block = isKept(size) ? keptBlocks().take(size) : nullptr;
  if (block == nullptr) block = newBlock(size);
  if (block == nullptr) {
    keptBlocks().freeAll();
    block = newBlock(size);
  }
  return block == nullptr ? nullptr : block->memory();
}

void returnMemory(void* memory) noexcept {
  if (memory == nullptr) return;
  Block* const block = Block::of(memory);
  if (isKept(block->size)) {
    keptBlocks().keep(block);
  } else {
    freeBlock(block);
  }
}

void* resizeMemory(void* memory, std::size_t bytes) noexcept {
  void* const resized = takeMemory(bytes);
  if (resized != nullptr && memory != nullptr) {
    const std::size_t room = Block::of(memory)->size - sizeof(Block);
    std::memcpy(resized, memory, std::min(room, bytes));
    returnMemory(memory);
  }
  return resized;
}

}  // namespace limitsurf::python
