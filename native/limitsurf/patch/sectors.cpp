// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/sectors.h"

#include <algorithm>

namespace limitsurf {

Sectors::Sectors(const FaceMesh& mesh, bool has_sharpness)
    : mesh_(mesh),
      has_sharpness_(has_sharpness),
      states_(static_cast<std::size_t>(mesh.vertexCount()), State::unknown),
      first_sector_(states_.size(), -1),
      corners_(static_cast<std::size_t>(mesh.cornerCount())) {}

Sectors::State Sectors::state(int vertex) {
  State& state = states_[vertex];
  if (state == State::unknown) {
    state = classify(vertex);
  }
  return state;
}

Sectors::State Sectors::classify(int vertex) {
  const VertexFan fan = mesh_.fan(vertex);
  SharpnessAround around;
  around.vertex = fan.sharpness;
  if (has_sharpness_) {
    around = mesh_.sharpnessAround(vertex);
    if (isSemiSharp(around.vertex) ||
        std::any_of(around.edges.begin(), around.edges.end(), isSemiSharp)) {
      const std::vector<float>& e = around.edges;
      const bool crease = fan.closed && e.size() == 4 && fan.sharpness == 0 && e[0] == e[2] &&
                          e[1] == e[3] && (e[0] == 0 || e[1] == 0);
      return crease ? State::crease : State::unsettled;
    }
  } else {
    around.edges.assign(fan.edges(), 0);
    if (!fan.closed) {
      around.edges.front() = around.edges.back() = kInfinitelySharp;
    }
  }
  settle(vertex, fan, around);
  return State::settled;
}

void Sectors::settle(int vertex, const VertexFan& fan, const SharpnessAround& around) {
  around_.clear();
  mesh_.forEachAround(fan, [&](FaceCorner at) { around_.push_back(at); });
  first_sector_[vertex] = sectorCount();

  std::vector<int> cuts;
  for (int i = 0; i < fan.edges(); ++i) {
    if (isSharp(around.edges[i])) {
      cuts.push_back(i);
    }
  }
  const auto sharp_edges = std::count_if(around.edges.begin(), around.edges.end(), isSharp);
  const bool pinned = isSharp(around.vertex) || sharp_edges > 2;
  if (fan.closed && cuts.empty()) {
    addSector(pinned ? RingKind::cone : RingKind::interior, 0, fan.faces);
  } else if (fan.closed && cuts.size() == 1) {
    addSector(pinned ? RingKind::pinned : RingKind::dart, cuts[0], fan.faces);
  } else {
    const RingKind kind = pinned ? RingKind::pinned : RingKind::boundary;
    const std::size_t count = fan.closed ? cuts.size() : cuts.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
      const int end = i + 1 < cuts.size() ? cuts[i + 1] : cuts[0] + fan.faces;
      addSector(kind, cuts[i], end - cuts[i]);
    }
  }
}

void Sectors::addSector(RingKind kind, int first, int faces) {
  const auto at = [&](int i) {
    return around_[static_cast<std::size_t>(first + i) % around_.size()];
  };
  for (int i = 0; i < faces; ++i) {
    corners_[mesh_.cornerNumber(at(i))] = {sectorCount(), i};
  }
  sectors_.push_back({Ring{kind, faces}, at(0)});
}

}  // namespace limitsurf
