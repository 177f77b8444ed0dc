// SPDX-License-Identifier: Apache-2.0
#include "support/truth/corner_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/truth/split_mesh.h"

namespace limitsurf::test {
namespace {

CornerPoint vertexPoint(const SplitMesh& split, int f, int corner) {
  const int v = split.faces[f][corner];
  const SplitMesh::Vertex& vertex = split.vertices[v];
  std::vector<float> lasting;
  for (const float sharpness : split.sharpnessAround(v)) {
    if (isInfinitelySharp(sharpness)) lasting.push_back(sharpness);
  }
  const SharpTopology::Sector sector = split.sector(f, v);
  const auto [next, previous] = split.neighbours(f, v);
  CornerPoint point;
  point.rule = vertexRule(isInfinitelySharp(vertex.sharpness) ? vertex.sharpness : 0, lasting);
  point.faces = sector.faces;
  point.closed = sector.closed;
  point.loop = vertex.loop;
  point.vertex = vertex.original;
  point.sharp_next = split.isOpen(v, next);
  point.sharp_previous = split.isOpen(v, previous);
  return point;
}

/// The middle of an edge.
CornerPoint edgePoint(bool sharp) {
  CornerPoint point;
  if (!sharp) return point;
  point.rule = Rule::crease;
  point.faces = 2;
  point.closed = false;
  return point;
}

}  // namespace

bool CornerPoint::regular() const {
  switch (rule) {
    case Rule::smooth:
      return faces == 4;
    case Rule::dart:
      return false;
    case Rule::crease:
      return faces == 2 && !closed && !loop;
    default:
      return faces == 1;
  }
}

bool CornerPoint::hasNormal() const {
  switch (rule) {
    case Rule::smooth:
    case Rule::dart:
      return faces >= 3;
    case Rule::crease:
      return faces <= 3 && !closed && !loop;
    default:
      return faces == 1;
  }
}

bool CornerPoint::hasCurve(bool next) const {
  return rule != Rule::dart && (next ? sharp_next : sharp_previous);
}

CornerPoints::CornerPoints(const Cage& cage) {
  const SplitMesh split(cage);
  for (const PtexFace& ptex : ptexFaces(cage)) {
    const int f = ptex.base_face;
    if (ptex.quad) {
      for (int corner = 0; corner < 4; ++corner) corners_.push_back(vertexPoint(split, f, corner));
      continue;
    }
    const CornerPoint vertex = vertexPoint(split, f, ptex.corner);
    CornerPoint centre, next = edgePoint(vertex.sharp_next),
                        previous = edgePoint(vertex.sharp_previous);
    centre.faces = static_cast<int>(cage.faces[f].size());
    next.sharp_previous = vertex.sharp_next;
    previous.sharp_next = vertex.sharp_previous;
    corners_.insert(corners_.end(), {vertex, next, centre, previous});
  }
}

const CornerPoint* CornerPoints::at(const Location& location) const {
  const int corner = cornerAt(location);
  return corner < 0 ? nullptr : &at(location.face, corner);
}

bool CornerPoints::insideSmoothCorner(const Location& location) const {
  for (int corner = 0; corner < 4; ++corner) {
    const CornerPoint& point = at(location.face, corner);
    const Location there = cornerLocation(location.face, corner);
    const double distance =
        std::max(std::abs(location.u - there.u), std::abs(location.v - there.v));
    if (point.rule == Rule::crease && point.faces == 1 && distance < 0x1p-20) return true;
  }
  return false;
}

int cornerAt(const Location& location) {
  for (int corner = 0; corner < 4; ++corner) {
    const Location there = cornerLocation(location.face, corner);
    if (location.u == there.u && location.v == there.v) return corner;
  }
  return -1;
}

bool isOnBorder(const CornerPoints& corners, const Location& at) {
  const auto within = [](double x) { return x > 0 && x < 1; };
  if (within(at.u) == within(at.v)) return false;
  const int side = at.v == 0 ? 0 : at.u == 1 ? 1 : at.v == 1 ? 2 : 3;
  return corners.at(at.face, side).sharp_next;
}

}  // namespace limitsurf::test
