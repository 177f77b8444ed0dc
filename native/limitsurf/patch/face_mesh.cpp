// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

void FaceMesh::getSharpnessAround(int vertex, SharpnessAround& around) const {
  const VertexFan fan = this->fan(vertex);
  around.vertex = fan.sharpness;
  around.edges.clear();
  FaceCorner last;
  forEachAround(fan, [&](FaceCorner at) {
    around.edges.push_back(sharpness(at));
    last = at;
  });
  if (!fan.closed) {
    around.edges.push_back(sharpness(before(last)));
  }
  if (const std::vector<float>* others = edgesOfOtherFans(vertex)) {
    around.edges.insert(around.edges.end(), others->begin(), others->end());
  }
  around.averaged_edges.clear();
  if (!averaged_edges_.empty()) {
    const auto averaged = averaged_edges_.find(vertex);
    if (averaged != averaged_edges_.end()) {
      around.averaged_edges = averaged->second;
    }
  }
}

}  // namespace limitsurf
