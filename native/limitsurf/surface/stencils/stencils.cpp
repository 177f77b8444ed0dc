// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/stencils/stencil_row.h"

namespace limitsurf {
namespace {

/// A row takes much longer than an evaluation, so that a task has fewer of them than kRowsPerTask.
constexpr std::size_t kStencilsPerTask = 8;
/// So many are made before they are put together.
constexpr std::size_t kStencilsPerChunk = std::size_t{1} << 17;
/// So many blocks of them are copied by one task.
constexpr std::size_t kBlocksPerCopy = 64;

/// The stencils that one task has made.
struct Block {
  /// Makes room for rows like most rows: memory for each entry by itself takes as long as its
  /// weights.
  void reserve(std::size_t rows, bool first_derivatives) {
    sizes.reserve(rows);
    indices.reserve(16 * rows);
    for (int kind = 0; kind < (first_derivatives ? 3 : 1); ++kind) {
      weights[kind].reserve(16 * rows);
    }
  }

  void add(const std::vector<StencilRow::Entry>& entries, bool first_derivatives) {
    sizes.push_back(static_cast<std::int64_t>(entries.size()));
    for (const StencilRow::Entry& entry : entries) {
      indices.push_back(entry.vertex);
      for (int kind = 0; kind < (first_derivatives ? 3 : 1); ++kind) {
        weights[kind].push_back(entry.weights[kind]);
      }
    }
  }

  std::vector<std::int64_t> sizes;  // of its rows
  std::vector<int> indices;
  std::vector<double> weights[3];  // of position, du and dv
};

/// Gives a vector this size. Where it must grow, it gets room for all rows if they are like the
/// first `rows` of `all`.
template <typename Vector>
void resizeFor(Vector& values, std::size_t size, std::size_t rows, std::size_t all) {
  if (size > values.capacity()) {
    const double share = static_cast<double>(all) / static_cast<double>(rows);
    values.reserve(static_cast<std::size_t>(1.02 * share * static_cast<double>(size)) + 1);
  }
  values.resize(size);
}

/// Appends the stencils of rows from `begin` on, and frees the blocks.
void append(std::vector<Block>& blocks, std::size_t begin, bool first_derivatives, int threads,
            Stencils& out) {
  std::vector<std::size_t> first(blocks.size() + 1, out.indices.size());  // entry of each block
  std::size_t rows = begin;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    first[i + 1] = first[i] + blocks[i].indices.size();
    rows += blocks[i].sizes.size();
  }
  const int kinds = first_derivatives ? 3 : 1;
  const std::size_t all = out.offsets.size() - 1;
  resizeFor(out.indices, first.back(), rows, all);
  LargePageVector<double>* const weights[3] = {&out.weights, &out.du_weights, &out.dv_weights};
  for (int kind = 0; kind < kinds; ++kind) {
    resizeFor(*weights[kind], first.back(), rows, all);
  }
  parallelFor(blocks.size(), kBlocksPerCopy, threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const Block block = std::move(blocks[i]);
      auto offset = static_cast<std::int64_t>(first[i]);
      for (std::size_t row = 0; row < block.sizes.size(); ++row) {
        offset += block.sizes[row];
        out.offsets[begin + i * kStencilsPerTask + row + 1] = offset;
      }
      std::copy(block.indices.begin(), block.indices.end(), out.indices.data() + first[i]);
      for (int kind = 0; kind < kinds; ++kind) {
        std::copy(block.weights[kind].begin(), block.weights[kind].end(),
                  weights[kind]->data() + first[i]);
      }
    }
  });
}

}  // namespace

Stencils LimitSurface::stencils(const LocationBatch& at, bool first_derivatives,
                                int threads) const {
  const LocationBatch checked = checkLocations(at, threads);
  Stencils out;
  out.offsets.resize(at.size() + 1);
  out.offsets[0] = 0;
  for (std::size_t begin = 0; begin < at.size(); begin += kStencilsPerChunk) {
    const std::size_t count = std::min(kStencilsPerChunk, at.size() - begin);
    std::vector<Block> blocks((count + kStencilsPerTask - 1) / kStencilsPerTask);
    parallelFor(count, kStencilsPerTask, threads, [&](std::size_t first, std::size_t last) {
      const TileEvaluator evaluator(data_->table, data_->pose);
      StencilRow row(data_->table);
      Block& block = blocks[first / kStencilsPerTask];
      block.reserve(last - first, first_derivatives);
      for (std::size_t i = first; i < last; ++i) {
        row.set(evaluator.locate(checked[begin + i]), first_derivatives ? 1 : 0);
        block.add(row.entries(), first_derivatives);
      }
    });
    append(blocks, begin, first_derivatives, threads, out);
  }
  return out;
}

}  // namespace limitsurf
