// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "support/truth/sharpness.h"

namespace limitsurf::test {

/// An edge of some sharpness at a vertex.
struct Spoke {
  int to;  ///< the other end; -1 where it is not part of the same mesh
  float sharpness;
  /// If not -1: the edge is the same as the one to `again`, in a fan of faces that begins and ends
  /// at it. Such spokes follow all others of their vertex.
  int again = -1;
};

/// Faces that are manifold and oriented, with sharp edges.
struct SharpTopology {
  std::vector<std::vector<int>> faces;
  std::vector<std::vector<Spoke>> sharp;  ///< the sharp edges of each vertex

  // Adjacency, by connect().
  std::map<std::pair<int, int>, int> face_of_directed_edge;
  std::vector<std::vector<int>> faces_of_vertex;
  void connect();

  /// The face that has the directed edge, or -1.
  int faceAt(int a, int b) const;
  /// The vertices after and before `v` in a face.
  std::pair<int, int> neighbours(int face, int v) const;

  float sharpness(int a, int b) const;
  /// Infinitely sharp, so that what lies beyond does not matter.
  bool isOpen(int a, int b) const { return isInfinitelySharp(sharpness(a, b)); }
  /// Each edge once.
  std::vector<float> sharpnessAround(int v) const;

  /// The faces around a vertex, or those of them between two infinitely sharp edges.
  struct Sector {
    int faces;
    bool closed;  ///< not bounded by any
  };
  /// The sector of `v` that the face belongs to.
  Sector sector(int face, int v) const;
};

}  // namespace limitsurf::test
