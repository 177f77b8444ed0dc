// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/row_order.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// Sorting pays where a face has about a row; its cost is that of the rows and of the faces.
constexpr std::size_t kFewestRows = 256, kMostFacesPerRow = 2;
/// With fewer rows on a face, on average, and with more bytes of results than the processor has
/// addresses of pages at hand, reading a regular face again for each row takes less time than
/// writing results in another order. Measured on Zen 3 with 5 rows on a face: 115 ns -> 75 ns a row
/// for position, du and dv (7 MB); but 35 ns -> 50 ns for positions (2.4 MB).
constexpr std::size_t kFewRowsOnFace = 16, kManyResultBytes = std::size_t{4} << 20;
/// Rows that are counted by one task.
constexpr std::size_t kRowsPerPart = std::size_t{1} << 16, kMostParts = 8;

/// Whether at least every other row follows one of another face, and not only because there are few
/// rows on each face: then faces come in order, or almost. Of a large batch some blocks of rows are
/// looked at.
bool isScattered(const LocationBatch& at) {
  constexpr std::size_t kBlock = 128, kBlocks = 64;
  const std::size_t step = std::max(kBlock, at.size() / kBlocks);
  std::size_t pairs = 0, changes = 0, descents = 0;
  for (std::size_t begin = 0; begin < at.size(); begin += step) {
    const std::size_t end = std::min(at.size(), begin + kBlock);
    for (std::size_t row = begin + 1; row < end; ++row) {
      const std::int64_t before = at.face(row - 1), face = at.face(row);
      ++pairs;
      changes += face != before ? 1 : 0;
      descents += face < before ? 1 : 0;
    }
  }
  return changes >= pairs / 2 && descents >= pairs / 16;
}

}  // namespace

RowOrder::RowOrder(const LocationBatch& at, const TileTable& table, std::size_t result_bytes,
                   int threads) {
  const std::size_t face_count = table.faces.size();
  if (at.size() < kFewestRows || face_count > kMostFacesPerRow * at.size() ||
      at.size() > std::numeric_limits<std::uint32_t>::max() || !isScattered(at)) {
    return;
  }
  // Faces may have been changed since they were checked, and between the two passes; the evaluator
  // finds that out, and nothing may break before.
  const bool sorts_regular =
      at.size() >= kFewRowsOnFace * face_count || at.size() * result_bytes < kManyResultBytes;
  const auto keyOf = [&](std::size_t row) {
    const auto face = static_cast<std::size_t>(at.face(row));
    const bool is_sorted =
        face < face_count && (sorts_regular || table.faces[face].kind != TileRef::kBSpline);
    return is_sorted ? face + 1 : 0;
  };
  // A counting sort. Each part of the rows has counts of its own, which become the places where
  // its rows of each key begin.
  const std::size_t parts =
      threads == 1 ? 1 : std::clamp<std::size_t>(at.size() / kRowsPerPart, 1, kMostParts);
  const auto first = [&](std::size_t part) { return at.size() * part / parts; };
  std::vector<std::vector<std::uint32_t>> counts(parts);
  const auto forEachPart = [&](const auto& body) {
    parallelFor(parts, 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part) {
        body(counts[part], first(part), first(part + 1));
      }
    });
  };
  forEachPart([&](std::vector<std::uint32_t>& count, std::size_t begin, std::size_t end) {
    count.assign(face_count + 1, 0);
    for (std::size_t row = begin; row < end; ++row) {
      ++count[keyOf(row)];
    }
  });
  std::uint32_t next = 0;
  for (std::size_t key = 0; key <= face_count; ++key) {
    for (std::vector<std::uint32_t>& count : counts) {
      next += std::exchange(count[key], next);
    }
  }
  rows_.resize(at.size());
  forEachPart([&](std::vector<std::uint32_t>& place, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::uint32_t to = place[keyOf(row)]++;
      rows_[to < rows_.size() ? to : 0] = static_cast<std::uint32_t>(row);
    }
  });
}

}  // namespace limitsurf
