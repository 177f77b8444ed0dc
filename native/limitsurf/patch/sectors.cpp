// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/sectors.h"

#include <algorithm>

namespace limitsurf {

Sectors::Sectors(const FaceMesh& mesh, bool has_sharpness)
    : mesh_(mesh),
      has_sharpness_(has_sharpness),
      states_(static_cast<std::size_t>(mesh.vertexCount()), State::unknown),
      first_sector_(states_.size()),
      corners_(static_cast<std::size_t>(mesh.cornerCount())) {}

Sectors::State Sectors::classify(int vertex) {
  const VertexFan fan = mesh_.fan(vertex);
  if (!has_sharpness_ || mesh_.isSmooth(vertex)) {
    if (fan.closed && fan.faces == 4 && fan.sharpness == 0 && !mesh_.creaseEnds(vertex)) {
      return State::regular;
    }
    first_sector_.set(vertex, sectorCount());
    gatherCorners(fan);
    addSector(wholeKind(vertex, fan, isSharp(fan.sharpness)), 0, fan.faces);
    return State::settled;
  }
  mesh_.getSharpnessAround(vertex, sharpness_);
  const std::vector<float>& e = sharpness_.edges;
  if (isSemiSharp(sharpness_.vertex) || std::any_of(e.begin(), e.end(), isSemiSharp)) {
    const bool crease = fan.closed && e.size() == 4 && fan.sharpness == 0 && e[0] == e[2] &&
                        e[1] == e[3] && (e[0] == 0 || e[1] == 0);
    return crease ? State::crease : State::unsettled;
  }
  settle(vertex, fan);
  return State::settled;
}

/// The kind of a sector that has all faces of a fan.
RingKind Sectors::wholeKind(int vertex, const VertexFan& fan, bool pinned) const {
  if (pinned) {
    return fan.closed ? RingKind::cone : RingKind::pinned;
  }
  if (mesh_.creaseEnds(vertex)) {
    return fan.closed ? RingKind::tip : RingKind::loop;
  }
  return fan.closed ? RingKind::interior : RingKind::boundary;
}

void Sectors::gatherCorners(const VertexFan& fan) {
  around_.clear();
  mesh_.forEachAround(fan, [&](FaceCorner at) { around_.push_back(at); });
}

/// The vertex has the sharpness `sharpness_`, no semi-sharp one.
void Sectors::settle(int vertex, const VertexFan& fan) {
  gatherCorners(fan);
  first_sector_.set(vertex, sectorCount());
  const std::vector<float>& edges = sharpness_.edges;
  cuts_.clear();
  for (int i = 0; i < fan.edges(); ++i) {
    if (isSharp(edges[i])) {
      cuts_.push_back(i);
    }
  }
  const auto sharp_edges = std::count_if(edges.begin(), edges.end(), isSharp);
  const bool pinned = isSharp(sharpness_.vertex) || sharp_edges > 2;
  if (fan.closed ? cuts_.empty() : cuts_.size() == 2) {
    addSector(wholeKind(vertex, fan, pinned), 0, fan.faces);
  } else if (fan.closed && cuts_.size() == 1) {
    addSector(pinned ? RingKind::pinned : RingKind::dart, cuts_[0], fan.faces);
  } else {
    const RingKind kind = pinned ? RingKind::pinned : RingKind::boundary;
    const std::size_t count = fan.closed ? cuts_.size() : cuts_.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
      const int end = i + 1 < cuts_.size() ? cuts_[i + 1] : cuts_[0] + fan.faces;
      addSector(kind, cuts_[i], end - cuts_[i]);
    }
  }
}

void Sectors::addSector(RingKind kind, int first, int faces) {
  const int count = static_cast<int>(around_.size());
  for (int i = 0, j = first; i < faces; ++i, ++j) {
    corners_.set(mesh_.cornerNumber(around_[j < count ? j : j - count]), {sectorCount(), i});
  }
  sectors_.push_back({Ring{kind, faces}, around_[first]});
}

}  // namespace limitsurf
