// SPDX-License-Identifier: Apache-2.0
#include "result_memory.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <new>
#include <utility>

#include "limitsurf/large_pages.h"
#include "traced_memory.h"

namespace limitsurf::python {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;
constexpr std::size_t kCacheLine = 64;

/// The sizes of blocks are an eighth of a power of two apart, so that arrays of almost equal size
/// can have the same memory, one after another.
std::size_t blockSize(std::size_t bytes) {
  std::size_t step = kLeastKept / 8;
  while (16 * step <= bytes) step *= 2;
  return (bytes + step - 1) / step * step;
}

std::align_val_t alignmentOf(std::size_t size) {
  return std::align_val_t(size < kLargePage ? kCacheLine : kLargePage);
}

struct Block {
  void* memory;
  std::size_t size;
};

void freeBlock(const Block& block) { ::operator delete(block.memory, alignmentOf(block.size)); }

/// Freed blocks, the oldest first. The GIL guards them.
class KeptBlocks {
 public:
  /// A block of this size; the one that was freed last is the likeliest to be in a cache.
  Block take(std::size_t size) {
    const auto kept = std::find_if(blocks_.rbegin(), blocks_.rend(),
                                   [&](const Block& block) { return block.size == size; });
    if (kept != blocks_.rend()) {
      const Block block = *kept;
      blocks_.erase(std::next(kept).base());
      bytes_ -= size;
      return block;
    }
    void* const memory = ::operator new(size, alignmentOf(size));
    askForLargePages(memory, size);
    return {memory, size};
  }

  void keep(const Block& block) {
    blocks_.push_back(block);
    bytes_ += block.size;
    while (bytes_ > kMostKept) {
      bytes_ -= blocks_.front().size;
      freeBlock(blocks_.front());
      blocks_.erase(blocks_.begin());
    }
  }

 private:
  std::vector<Block> blocks_;
  std::size_t bytes_ = 0;
};

KeptBlocks& keptBlocks() {
  static auto* const blocks = new KeptBlocks;  // arrays may be freed when the process ends
  return *blocks;
}

}  // namespace

py::array newArray(const py::dtype& dtype, std::vector<py::ssize_t> shape) {
  std::size_t bytes = static_cast<std::size_t>(dtype.itemsize());
  for (const py::ssize_t extent : shape) bytes *= static_cast<std::size_t>(extent);
  if (bytes < kLeastKept || bytes > kMostKept) return py::array(dtype, std::move(shape));
  auto block = std::make_unique<Block>(keptBlocks().take(blockSize(bytes)));
  const py::capsule owner(block.get(), [](void* pointer) {
    const std::unique_ptr<Block> freed(static_cast<Block*>(pointer));
    untraceMemory(freed->memory);
    keptBlocks().keep(*freed);
  });
  void* const memory = block.release()->memory;
  traceMemory(memory, bytes);
  return py::array(dtype, std::move(shape), memory, owner);
}

}  // namespace limitsurf::python
