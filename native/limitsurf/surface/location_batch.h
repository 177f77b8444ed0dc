// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

struct TiledSurface;

/// The locations of a batch call. Any Span or vector of locations converts to one; the call then
/// checks them. checkLocations() returns a batch whose check is done, for calls on the same surface
/// or data. Refers to the locations, which must live on.
class LocationBatch {
 public:
  LocationBatch() = default;
  LocationBatch(const Location* locations, std::size_t count) : locations_(locations, count) {}
  LocationBatch(Span<Location> locations) : locations_(locations) {}
  LocationBatch(const std::vector<Location>& locations) : locations_(locations) {}

  std::size_t size() const { return locations_.size(); }
  const Location& operator[](std::size_t row) const { return locations_[row]; }
  operator Span<Location>() const { return locations_; }

  /// Some rows of the batch. They are checked if the batch is.
  LocationBatch rows(std::size_t begin, std::size_t count) const {
    return LocationBatch(locations_.subspan(begin, count), checked_on_);
  }

 private:
  friend struct TiledSurface;
  LocationBatch(Span<Location> locations, const TiledSurface* checked_on)
      : locations_(locations), checked_on_(checked_on) {}

  Span<Location> locations_;
  const TiledSurface* checked_on_ = nullptr;  // where the check was done
};

}  // namespace limitsurf
