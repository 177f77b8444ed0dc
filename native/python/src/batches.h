// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "arrays.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/thread_count.h"
#include "limitsurf/types.h"
#include "locks/long_call.h"

namespace limitsurf::python {

using Locations = std::vector<Location>;

/// Which face ids locationsOf() refuses.
enum class FaceCheck {
  range,  ///< those of none of the Ptex faces
  size,   ///< those that do not fit into an int; the surface checks the others
};

/// The locations of a batch. Throws LocationError for arrays of other shapes, and naming the first
/// row whose face id is refused.
Locations locationsOf(int face_count, const py::object& face, const py::object& uv,
                      FaceCheck check = FaceCheck::range, const char* face_name = "face",
                      const char* uv_name = "uv");

/// A batch as it lies in numpy's arrays, which this keeps: contiguous float64, and int32 or int64,
/// are read in place. Python's threads may change them meanwhile, so it is for calls that read each
/// location once and look at what they have read. Throws LocationError for arrays of other shapes.
class LocationArrays {
 public:
  LocationArrays(const py::object& face, const py::object& uv);
  std::size_t size() const { return batch_.size(); }
  /// What has not been checked.
  const LocationBatch& batch() const { return batch_; }

 private:
  py::array face_;
  Doubles uv_;
  LocationBatch batch_;
};

/// The rows of a batch on a surface, or on its data. They are checked once, as a whole, so that
/// errors name rows of the batch, and parts of it need not be checked again.
class CheckedLocations {
 public:
  template <typename Surface>
  CheckedLocations(const Surface& surface, Locations rows, const char* face_name,
                   const char* uv_name)
      : rows_(std::move(rows)),
        batch_(surface.checkLocations(LocationBatch(rows_).called(face_name, uv_name), 1)) {}

  std::size_t size() const { return rows_.size(); }
  LocationBatch part(std::size_t begin, std::size_t count) const {
    return batch_.rows(begin, count);
  }
  operator const Locations&() const { return rows_; }
  operator const LocationBatch&() const { return batch_; }
  operator Span<Location>() const { return rows_; }

 private:
  Locations rows_;
  LocationBatch batch_;  // refers to rows_, which keep their address when moved
};

/// The rows of a batch on a surface, or on its data. Throws the error of the first row that cannot
/// be evaluated.
template <typename Surface>
CheckedLocations locationsOn(const Surface& surface, const py::object& face, const py::object& uv,
                             const char* face_name = "face", const char* uv_name = "uv") {
  Locations at = locationsOf(surface.faceCount(), face, uv, FaceCheck::size, face_name, uv_name);
  const GilRelease release;
  return CheckedLocations(surface, std::move(at), face_name, uv_name);
}

/// Throws ValueError for an order below 0 or above `highest`.
void checkDerivatives(int derivatives, int highest);

/// The number of rows evaluated at a time: the results are copied while they are in the cache.
constexpr std::size_t kRowsPerChunk = std::size_t{1} << 17;

/// Calls body(first row, number of rows) for chunk after chunk.
template <typename Body>
void forEachChunk(std::size_t rows, const Body& body) {
  for (std::size_t begin = 0; begin < rows; begin += kRowsPerChunk) {
    body(begin, std::min(kRowsPerChunk, rows - begin));
  }
}

/// Calls body(first row, locations) for chunk after chunk of a batch, without the GIL. What the
/// lock guards does not change meanwhile, and Ctrl-C ends the call.
template <typename Body>
void inChunks(const CallLock& lock, const CheckedLocations& at, const Body& body) {
  const LongCall call(lock);
  forEachChunk(at.size(),
               [&](std::size_t begin, std::size_t count) { body(begin, at.part(begin, count)); });
}

/// A limitsurf.Locations of these locations; where face is -1, (u, v) is NaN.
py::object locations(const Locations& at);

/// The class of this name in limitsurf._results.
py::object result(const char* name);

}  // namespace limitsurf::python
