// SPDX-License-Identifier: Apache-2.0
#include "bench/support/limit_stencil_peer.h"

#include <opensubdiv/far/stencilTableFactory.h>

#include <stdexcept>

namespace limitsurf::bench {
namespace {

namespace Far = OpenSubdiv::Far;

/// A row of Points, as Far's tables combine them.
struct Row {
  double xyz[3];
  void Clear() { xyz[0] = xyz[1] = xyz[2] = 0; }
  void AddWithWeight(const Row& other, double weight) {
    for (int c = 0; c < 3; ++c) xyz[c] += weight * other.xyz[c];
  }
};

const Row* rows(const Points& points) { return reinterpret_cast<const Row*>(points.data()); }
Row* rows(Points& points) { return reinterpret_cast<Row*>(points.data()); }

}  // namespace

LimitStencilPeer::LimitStencilPeer(const MeshArrays& cage, const std::vector<Location>& at,
                                   bool with_derivatives)
    : with_derivatives_(with_derivatives) {
  using Factory = Far::LimitStencilTableFactoryReal<double>;
  std::vector<double> s, t;
  for (const Location& location : at) {
    s.push_back(location.u);
    t.push_back(location.v);
  }
  std::vector<Factory::LocationArray> faces;
  for (std::size_t first = 0, end; first < at.size(); first = end) {
    for (end = first; end < at.size() && at[end].face == at[first].face;) ++end;
    Factory::LocationArray face;
    face.ptexIdx = at[first].face;
    face.numLocations = static_cast<int>(end - first);
    face.s = &s[first];
    face.t = &t[first];
    faces.push_back(face);
  }
  const TopologyPointer topology = farTopology(cage);
  topology->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(kLevel));
  Factory::Options options;
  options.generate1stDerivatives = with_derivatives;
  table_.reset(Factory::Create(*topology, faces, nullptr, nullptr, options));
  if (!table_ || table_->GetNumStencils() != static_cast<int>(at.size())) {
    throw std::runtime_error("OpenSubdiv makes no table of these locations");
  }
}

void LimitStencilPeer::evaluate(const Points& positions, Evaluation& out) const {
  table_->UpdateValues(rows(positions), rows(out.position));
  if (with_derivatives_) {
    Row *const du = rows(out.du), *const dv = rows(out.dv);
    table_->UpdateDerivs(rows(positions), du, dv);
  }
}

std::size_t LimitStencilPeer::bytes() const {
  const auto of = [](const auto& values) { return values.size() * sizeof(values[0]); };
  return of(table_->GetSizes()) + of(table_->GetOffsets()) + of(table_->GetControlIndices()) +
         of(table_->GetWeights()) + of(table_->GetDuWeights()) + of(table_->GetDvWeights());
}

}  // namespace limitsurf::bench
