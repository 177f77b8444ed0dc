// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

SharpnessAround FaceMesh::sharpnessAround(int vertex) const {
  const VertexFan around = fan(vertex);
  SharpnessAround result;
  result.vertex = around.sharpness;
  FaceCorner last;
  forEachAround(around, [&](FaceCorner at) {
    result.edges.push_back(sharpness(at));
    last = at;
  });
  if (!around.closed) {
    result.edges.push_back(sharpness(before(last)));
  }
  const std::vector<float> others = edgesOfOtherFans(vertex);
  result.edges.insert(result.edges.end(), others.begin(), others.end());
  return result;
}

}  // namespace limitsurf
