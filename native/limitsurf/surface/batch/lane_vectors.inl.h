// SPDX-License-Identifier: Apache-2.0
//
// Lanes, and several vectors at once. To be included as lanes.inl.h is, instead of it.

#include "limitsurf/surface/batch/lanes.inl.h"

/// kCount vectors: a coordinate of all of them in each Lanes.
template <int kCount>
struct LaneVectors {
  Lanes<kCount> axis[3];
};

template <int kCount>
inline LaneVectors<kCount> crossProduct(const LaneVectors<kCount>& a,
                                        const LaneVectors<kCount>& b) {
  return {{a.axis[1] * b.axis[2] - a.axis[2] * b.axis[1],
           a.axis[2] * b.axis[0] - a.axis[0] * b.axis[2],
           a.axis[0] * b.axis[1] - a.axis[1] * b.axis[0]}};
}

/// Products are added from the first axis on.
template <int kCount>
inline Lanes<kCount> dotProduct(const LaneVectors<kCount>& a, const LaneVectors<kCount>& b) {
  return a.axis[0] * b.axis[0] + a.axis[1] * b.axis[1] + a.axis[2] * b.axis[2];
}

template <int kCount>
inline Lanes<kCount> squaredLength(const LaneVectors<kCount>& a) {
  return dotProduct(a, a);
}
