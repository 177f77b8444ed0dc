// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiled_surface.h"

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"

namespace limitsurf {

TiledSurface::TiledSurface(const ControlMesh& mesh, const Topology& topology)
    : ptex(mesh), refused(topology.refused()), table(buildTileTable(mesh, topology, ptex)) {}

void TiledSurface::check(const LocationBatch& at, int threads) const {
  checkThreads(threads);
  checked(at);
}

void TiledSurface::check(const LocationBatch& at, std::size_t row) const {
  const auto inside = [](double t) { return t >= 0 && t <= 1; };  // false for NaN
  const std::int64_t face = at.face(row);
  const bool exists = face >= 0 && face < static_cast<std::int64_t>(table.faces.size());
  const Location location = at[row];
  if (exists && inside(location.u) && inside(location.v) &&
      table.faces[location.face].kind != TileRef::kNone) {
    return;
  }
  std::ostringstream message;
  message << "row " << row << ": ";
  if (!exists) {
    message << "face " << face << " is not among the " << table.faces.size() << " Ptex faces";
    throw LocationError(message.str());
  }
  if (!inside(location.u) || !inside(location.v)) {
    message << "(u, v) = (" << numberText(location.u) << ", " << numberText(location.v)
            << ") is outside [0, 1]";
    throw LocationError(message.str());
  }
  const int base = ptex.base_face[location.face];
  message << "Ptex face " << face << " belongs to face " << base
          << ", which has no limit surface: " << refused.at(base);
  throw MeshError(message.str());
}

LocationBatch TiledSurface::checked(const LocationBatch& at) const {
  if (at.checked_on_ == this) {
    return at;
  }
  // A quick pass, without branches, and another one only where it found something.
  const std::uint64_t faces = table.faces.size();
  const bool all_have_surfaces = refused.empty();
  InterruptionStride stride;
  for (std::size_t begin = 0; begin < at.size(); begin += kRowsPerTask) {
    stride.step();
    const std::size_t end = std::min(at.size(), begin + kRowsPerTask);
    bool good = all_have_surfaces;
    for (std::size_t row = begin; row < end; ++row) {
      const double u = at.parameter(row, 0), v = at.parameter(row, 1);
      good &= (static_cast<std::uint64_t>(at.face(row)) < faces) & (u >= 0) & (u <= 1) & (v >= 0) &
              (v <= 1);
    }
    for (std::size_t row = begin; row < end && !good; ++row) {
      check(at, row);
    }
  }
  LocationBatch result(at);
  result.checked_on_ = this;
  return result;
}

}  // namespace limitsurf
