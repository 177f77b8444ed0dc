// SPDX-License-Identifier: Apache-2.0
//
// The kernel of GridStep, included once for each instruction set.

/// The rules for a cubic B-spline's new control points at an old one and between two.
inline Point atVertex(const Point& before, const Point& here, const Point& after) {
  return (before + 6 * here + after) * 0.125;
}
inline Point betweenVertices(const Point& a, const Point& b) { return (a + b) * 0.5; }

inline Point read(const double* grid, int slot) {
  return *reinterpret_cast<const Point*>(grid + 4 * slot);
}
inline void write(double* grid, int slot, const Point& value) {
  *reinterpret_cast<Point*>(grid + 4 * slot) = value;
}

/// The new points along one line of a strip, from -1 on and `step` slots apart, from the points of
/// the coarser line from -1 to `last`. Where the line begins at a boundary there is nothing at -1,
/// and the point at 0 follows the curve.
inline void stepLine(bool from_boundary, const Point line[4], int last, double* grid, int slot,
                     int step) {
  if (from_boundary) {
    write(grid, slot + step, line[1]);
  } else {
    write(grid, slot, betweenVertices(line[0], line[1]));
    write(grid, slot + step, atVertex(line[0], line[1], line[2]));
  }
  write(grid, slot + 2 * step, betweenVertices(line[1], line[2]));
  if (last > 1) {
    write(grid, slot + 3 * step, atVertex(line[1], line[2], line[3]));
    write(grid, slot + 4 * step, betweenVertices(line[2], line[3]));
  }
}

/// Two lines of the finer grid, `across` slots apart: at 2 and 3 across the strip, from the points
/// at 0 to 2. `first` is the slot at 0, and -1 along the strip.
inline void stepStrip(bool from_boundary, int last, int first, int along, int across,
                      const double* before, double* after) {
  Point vertices[4], edges[4];
  for (int i = from_boundary ? 1 : 0; i <= last + 1; ++i) {
    const int slot = first + i * along;
    const Point a = read(before, slot), b = read(before, slot + across),
                c = read(before, slot + 2 * across);
    vertices[i] = atVertex(a, b, c);
    edges[i] = betweenVertices(b, c);
  }
  stepLine(from_boundary, vertices, last, after, first + 2 * across, along);
  stepLine(from_boundary, edges, last, after, first + 3 * across, along);
}

/// The slots with x or y above 1. Around them all is regular, so that a step is a product of the
/// rule of a cubic B-spline along u and the same along v.
inline void stepOutsideRing(bool left, bool right, const double* before, double* after) {
  using tile_grid::slot;
  constexpr int kAlongU = slot(1, 0) - slot(0, 0), kAlongV = slot(0, 1) - slot(0, 0);
  stepStrip(left, 2, slot(0, -1), kAlongV, kAlongU, before, after);
  stepStrip(right, 1, slot(-1, 0), kAlongU, kAlongV, before, after);
}
