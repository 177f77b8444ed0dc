// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/eigenbasis.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "limitsurf/eigen/eigenbasis_builder.h"
#include "limitsurf/eigen/tip_bend.h"

namespace limitsurf {

std::shared_ptr<const Eigenbasis> Eigenbasis::get(const Ring& ring) {
  static std::mutex mutex;
  static std::map<Ring, std::weak_ptr<const Eigenbasis>> bases;
  // Small ones stay, because most surfaces have the same ones. Together they take less than 1 MB.
  constexpr int kFewFaces = 16;
  static std::vector<std::shared_ptr<const Eigenbasis>> kept;
  const auto find = [&]() -> std::weak_ptr<const Eigenbasis>& { return bases[ring]; };
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (std::shared_ptr<const Eigenbasis> known = find().lock()) {
      return known;
    }
  }
  // Large ones take seconds. The mutex is not held meanwhile: what interrupts the work may open a
  // surface itself.
  auto made = std::make_shared<const Eigenbasis>(ring);
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<const Eigenbasis> known = find().lock();
  if (!known) {
    find() = known = std::move(made);
    if (ring.faces <= kFewFaces) {
      kept.push_back(known);
    }
  }
  return known;
}

Eigenbasis::Eigenbasis(const Ring& ring) : ring_(ring), step_(ring) { Builder(*this).build(); }

int Eigenbasis::parts(int m, bool plus, int face, Part out[2]) const {
  const int first = firstMode(m);
  const std::int64_t turn = edgeAngle(m, face);
  if (rotates()) {
    if (alternates(m)) {
      out[0] = plus ? Part{first, cosAt(turn), 0} : Part{first + 1, 0, cosAt(turn)};
      return 1;
    }
    const int mode = first + (plus ? 0 : 2);
    out[0] = {mode, cosAt(turn), -sinAt(turn)};
    out[1] = {mode + 1, sinAt(turn), cosAt(turn)};
    return 2;
  }
  if (alternates(m) && plus) {
    return 0;  // all its spokes are 0
  }
  const int mode = alternates(m) || plus ? first : first + 1;
  switch (sides(face)) {
    case Sides::inner:
      out[0] = {mode, sinAt(turn), cosAt(turn)};
      break;
    case Sides::right:
      out[0] = {mode, 0, !ring_.closed() && m % 2 ? 1. : -1.};
      break;
    default:
      out[0] = {mode, 0, 1};
  }
  return 1;
}

std::vector<double> Eigenbasis::ringVector(int mode) const {
  std::vector<double> ring(ring_.size(), 1.);
  if (mode == 0) {
    return ring;
  }
  if (dart_ && mode >= firstSymmetric()) {
    return dart_->ringVector(mode - firstSymmetric());
  }
  if (mode <= fixedCount() && !ring_.closed()) {
    return curve_ring_[mode - 1];
  }
  if (ring_.kind == RingKind::tip) {
    if (mode == TipBend::kMode) {
      for (int i = 0; i < ring_.faces; ++i) {
        ring[ring_.edge(i)] = TipBend::kEdge;
        ring[ring_.face(i)] = TipBend::kFace;
      }
      ring[0] = TipBend::kVertex;
      ring[ring_.creaseMean()] = TipBend::kMean;
      return ring;
    }
    ring[ring_.creaseMean()] = 0;
  }
  if (mode <= fixedCount()) {
    const double v = radial_vertex_[mode - 1];
    ring[0] = v;
    for (int i = 0; i < ring_.faces; ++i) {
      ring[ring_.edge(i)] = v + radial_(0, mode - 1);
      ring[ring_.face(i)] = v + radial_(1, mode - 1);
    }
    return ring;
  }
  ring[0] = 0;
  const int m = spokeOf(mode);
  for (const bool plus : {true, false}) {
    Part part[2];
    const int count = parts(m, plus, 0, part);
    for (int p = 0; p < count; ++p) {
      if (part[p].mode != mode) {
        continue;
      }
      const std::vector<double>& wave = part[p].cosine != 0 ? cos_ : sin_;
      const Spoke& spoke = spokes_[pairIndex(m, plus)];
      for (int i = 0; i < ring_.edges(); ++i) {
        ring[ring_.edge(i)] = spoke.edge * wave[edgeAngle(m, i) % period_];
      }
      for (int j = 0; j < ring_.faces; ++j) {
        ring[ring_.face(j)] = spoke.face * wave[faceAngle(m, j) % period_];
      }
    }
  }
  return ring;
}

Eigenbasis::Table Eigenbasis::table(int mode, int face) const {
  Table result;
  if (mode == 0) {
    for (int c = 0; c < tile_grid::kSlots; ++c) {
      result.grid[c] = tile_grid::exists(sides(face), c) ? 1 : 0;
    }
    std::fill_n(result.outer, outerModes(face).count(), 1.);
    return result;
  }
  if (dart_ && mode >= firstSymmetric()) {
    return dart_->table(mode - firstSymmetric(), face);
  }
  if (mode <= fixedCount()) {
    return fixed(face).tables[mode - 1];
  }
  const FaceTables& t = tables(sides(face));
  const int m = spokeOf(mode);
  for (const bool plus : {true, false}) {
    Part part[2];
    const int count = parts(m, plus, face, part);
    for (int p = 0; p < count; ++p) {
      if (part[p].mode != mode) {
        continue;
      }
      const auto add = [&](double factor, const std::vector<Table>& from) {
        if (factor == 0) {
          return;
        }
        const Table& source = from[pairIndex(m, plus)];
        for (int i = 0; i < tile_grid::kOuter; ++i) {
          result.outer[i] += factor * source.outer[i];
        }
        for (int c = 0; c < tile_grid::kSlots; ++c) {
          result.grid[c] += factor * source.grid[c];
        }
      };
      add(part[p].cosine, t.cosine);
      add(part[p].sine, t.sine);
    }
  }
  return result;
}

}  // namespace limitsurf
