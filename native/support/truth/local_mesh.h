// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <vector>

#include "limitsurf/types.h"
#include "support/truth/sharp_topology.h"

namespace limitsurf::test {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                           boost::multiprecision::et_off>;

struct Point {
  Real x = 0, y = 0, z = 0;

  Point& operator+=(const Point& p) {
    x += p.x, y += p.y, z += p.z;
    return *this;
  }
};
inline Point operator+(Point a, const Point& b) { return a += b; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(const Real& s, const Point& p) { return {s * p.x, s * p.y, s * p.z}; }

Vector3 rounded(const Point& p);

/// A face (the first) and all faces that share a vertex with it.
///
/// The neighbourhoods of the first face's vertices are complete; elsewhere the mesh is cut off, but
/// every vertex knows the sharpness around it.
struct LocalMesh : SharpTopology {
  struct Vertex {
    Point point;  ///< relative to the origin
    int faces;    ///< of its fan in the whole mesh
    float sharpness;
    bool loop = false;  ///< as in SplitMesh
  };
  Point origin;
  std::vector<Vertex> vertices;

  int add(Vertex vertex);
  Rule rule(int v) const { return vertexRule(vertices[v].sharpness, sharpnessAround(v)); }

  /// Whether all sharpness at the first face's vertices is infinite.
  bool settled() const;
  /// Whether the first face is a bicubic B-spline patch, all its infinitely sharp edges being sides
  /// beyond which the control points continue linearly.
  bool regular() const;
};

}  // namespace limitsurf::test
