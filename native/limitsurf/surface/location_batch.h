// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

struct TiledSurface;

/// Throws LocationError unless u and v are in [0, 1]. `uv_word` is what the message calls them.
void checkParameters(const Location& at, std::size_t row, const char* uv_word = "uv");

/// The locations of a batch call. Any Span or vector of locations converts to one, and so do an
/// array of faces and an array of (u, v), as other programs keep them. The call then checks them.
/// checkLocations() returns a batch whose check is done, for calls on the same surface or data.
/// Refers to the locations, which must live on.
class LocationBatch {
 public:
  LocationBatch() = default;
  LocationBatch(const Location* locations, std::size_t count);
  LocationBatch(Span<Location> locations) : LocationBatch(locations.data(), locations.size()) {}
  LocationBatch(const std::vector<Location>& locations)
      : LocationBatch(locations.data(), locations.size()) {}
  /// `uv` alternates u and v. There is one face for each pair, or a single face for all of them;
  /// throws std::invalid_argument otherwise.
  LocationBatch(Span<std::int32_t> faces, Span<double> uv)
      : LocationBatch(faces.data(), sizeof(std::int32_t), faces.size(), uv) {}
  LocationBatch(Span<std::int64_t> faces, Span<double> uv)
      : LocationBatch(faces.data(), sizeof(std::int64_t), faces.size(), uv) {}

  std::size_t size() const { return size_; }
  Location operator[](std::size_t row) const {
    return {static_cast<int>(face(row)), parameter(row, 0), parameter(row, 1)};
  }
  /// The face of a row, which need not fit into an int before the batch has been checked.
  std::int64_t face(std::size_t row) const {
    const void* const at = faces_ + row * face_step_;
    return is_wide_ ? *static_cast<const std::int64_t*>(at) : *static_cast<const std::int32_t*>(at);
  }

  double u(std::size_t row) const { return parameter(row, 0); }
  double v(std::size_t row) const { return parameter(row, 1); }

  /// The same batch with other words for "face" and "uv" in messages: a call may take two batches.
  /// The words must live on.
  LocationBatch called(const char* face_word, const char* uv_word) const;

  /// Some rows of the batch. They are checked if the batch is.
  LocationBatch rows(std::size_t begin, std::size_t count) const;

 private:
  friend struct TiledSurface;
  LocationBatch(const void* faces, std::size_t face_size, std::size_t face_count, Span<double> uv);

  /// -0 is read as 0: otherwise it would depend on the rest of a batch which of the two a result
  /// is.
  double parameter(std::size_t row, std::size_t which) const {
    return reinterpret_cast<const double*>(uv_ + row * uv_step_)[which] + 0.;
  }

  const char *faces_ = nullptr, *uv_ = nullptr;  // of the first row
  std::size_t face_step_ = 0, uv_step_ = 0;      // bytes from row to row
  std::size_t size_ = 0;
  bool is_wide_ = false;                      // faces of 64 bits
  const TiledSurface* checked_on_ = nullptr;  // where the check was done
  const char *face_word_ = "face", *uv_word_ = "uv";
};

}  // namespace limitsurf
