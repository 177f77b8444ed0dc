// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/point_rows.h"

#include <cstddef>
#include <cstring>

#include "limitsurf/interruptible_vector.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/random_bits.h"

namespace limitsurf {
namespace {

std::uint64_t hashOf(const CageRow& row) {
  std::uint64_t hash = row.indices.size();
  for (std::size_t i = 0; i < row.indices.size(); ++i) {
    std::uint64_t bits;
    std::memcpy(&bits, &row.weights[i], sizeof bits);
    hash = mixed(hash ^ static_cast<std::uint64_t>(row.indices[i]));
    hash = mixed(hash ^ bits);
  }
  return hash;
}

}  // namespace

int PointRows::numberOf(const CageRow& row) {
  const std::uint64_t hash = hashOf(row);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  for (; slots_[slot] >= 0; slot = (slot + 1) & mask) {
    const int number = slots_[slot];
    if (hashes_[static_cast<std::size_t>(number)] == hash && isRow(number, row)) {
      return number;
    }
  }
  const int number = static_cast<int>(hashes_.size());
  add(row);
  slots_[slot] = number;
  reserveMore(hashes_, 1);
  hashes_.push_back(hash);
  if (2 * hashes_.size() > slots_.size()) {
    doubleSlots();
  }
  return number;
}

bool PointRows::isRow(int number, const CageRow& row) const {
  const auto at = static_cast<std::size_t>(number);
  const auto begin = static_cast<std::size_t>(tiles_.points_offsets[at]);
  const std::size_t count = static_cast<std::size_t>(tiles_.points_offsets[at + 1]) - begin;
  // Weights are compared as bits: -0 is another one than 0.
  return count == row.indices.size() &&
         (count == 0 || (std::memcmp(&tiles_.points_indices[begin], row.indices.data(),
                                     count * sizeof(int)) == 0 &&
                         std::memcmp(&tiles_.points_weights[begin], row.weights.data(),
                                     count * sizeof(double)) == 0));
}

void PointRows::add(const CageRow& row) {
  reserveMore(tiles_.points_indices, row.indices.size());
  reserveMore(tiles_.points_weights, row.weights.size());
  reserveMore(tiles_.points_offsets, 1);
  tiles_.points_indices.insert(tiles_.points_indices.end(), row.indices.begin(), row.indices.end());
  tiles_.points_weights.insert(tiles_.points_weights.end(), row.weights.begin(), row.weights.end());
  tiles_.points_offsets.push_back(static_cast<std::int64_t>(tiles_.points_indices.size()));
}

void PointRows::doubleSlots() {
  std::vector<int> slots(2 * slots_.size(), -1);
  const std::size_t mask = slots.size() - 1;
  InterruptionStride stride;
  for (std::size_t number = 0; number < hashes_.size(); ++number) {
    stride.step();
    std::size_t slot = hashes_[number] & mask;
    while (slots[slot] >= 0) {
      slot = (slot + 1) & mask;
    }
    slots[slot] = static_cast<int>(number);
  }
  slots_.swap(slots);
}

}  // namespace limitsurf
