// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiled_surface.h"

#include <atomic>
#include <cstdint>
#include <sstream>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// Rows that one task checks: some nanoseconds each.
constexpr std::size_t kRowsPerCheck = std::size_t{1} << 14;

}  // namespace

TiledSurface::TiledSurface(const ControlMesh& mesh, const Topology& topology)
    : ptex(mesh), refused(topology.refused()), table(buildTileTable(mesh, topology, ptex)) {}

void TiledSurface::check(const LocationBatch& at, int threads) const {
  checkThreads(threads);
  checked(at, threads);
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
    message << at.face_word_ << " " << face << " is not among the " << table.faces.size()
            << " Ptex faces";
    throw LocationError(message.str());
  }
  checkParameters(location, row, at.uv_word_);
  const int base = ptex.base_face[location.face];
  message << "Ptex face " << face << " belongs to face " << base
          << ", which has no limit surface: " << refused.at(base);
  throw MeshError(message.str());
}

LocationBatch TiledSurface::checked(const LocationBatch& at, int threads) const {
  if (at.checked_on_ == this) {
    return at;
  }
  // A quick pass, and another one only if that found something.
  const std::uint64_t faces = table.faces.size();
  const bool all_have_surfaces = refused.empty();
  std::atomic<bool> all_good{true};
  parallelFor(at.size(), kRowsPerCheck, threads, [&](std::size_t begin, std::size_t end) {
    bool good = true;
    for (std::size_t row = begin; row < end; ++row) {
      const double u = at.parameter(row, 0), v = at.parameter(row, 1);
      const auto face = static_cast<std::uint64_t>(at.face(row));
      good &= (face < faces) & (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1);  // without branches
      if (!all_have_surfaces) {
        good &= face < faces && table.faces[face].kind != TileRef::kNone;
      }
    }
    if (!good) {
      all_good.store(false, std::memory_order_relaxed);
    }
  });
  InterruptionStride stride;
  for (std::size_t row = 0; row < at.size() && !all_good; ++row) {
    stride.step();
    check(at, row);
  }
  LocationBatch result(at);
  result.checked_on_ = this;
  return result;
}

}  // namespace limitsurf
