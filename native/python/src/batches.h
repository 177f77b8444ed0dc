// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <shared_mutex>
#include <vector>

#include "arrays.h"
#include "limitsurf/parallel.h"
#include "limitsurf/types.h"

namespace limitsurf::python {

using Locations = std::vector<Location>;

/// The rows of a batch; LocationError for arrays of other shapes and the first face that is none of
/// `face_count` Ptex faces.
Locations locationsOf(int face_count, const py::object& face, const py::object& uv);

/// The rows of a batch on a surface, or on its data, that can be evaluated; the error of the first
/// that cannot.
template <typename Surface>
Locations locationsOn(const Surface& surface, const py::object& face, const py::object& uv) {
  Locations at = locationsOf(surface.faceCount(), face, uv);
  const py::gil_scoped_release release;
  surface.checkLocations(at);
  return at;
}

/// ValueError for orders above `highest` and below 0.
void checkDerivatives(int derivatives, int highest);

/// For a call that has let go of the GIL: lets Ctrl-C end it.
InterruptionPoint interruptible();

/// Rows evaluated at a time, so that results are copied while they are in the cache.
constexpr std::size_t kRowsPerChunk = std::size_t{1} << 17;

/// Calls body(first row, the chunk's locations) for chunk after chunk, without the GIL, with what
/// the mutex guards held still, and so that Ctrl-C ends it.
template <typename Body>
void inChunks(std::shared_mutex& mutex, const Locations& at, const Body& body) {
  const py::gil_scoped_release release;
  const std::shared_lock<std::shared_mutex> lock(mutex);
  const InterruptionPoint point = interruptible();
  for (std::size_t begin = 0; begin < at.size(); begin += kRowsPerChunk) {
    body(begin, Span<Location>(at).subspan(begin, std::min(kRowsPerChunk, at.size() - begin)));
  }
}

/// limitsurf.Locations; rows whose face is -1 have NaN for (u, v).
py::object locations(const Locations& at);

/// A class of limitsurf._results.
py::object result(const char* name);

}  // namespace limitsurf::python
