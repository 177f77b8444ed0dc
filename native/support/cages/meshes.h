// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "support/cages/cage.h"

namespace limitsurf::test {

/// Faces around a vertex (number 0), each the inner corner of a sector of 2x2 quads, so that the
/// vertex is the only irregular one of its faces, which are the Ptex faces 0, 4, 8, ... with the
/// vertex at (0, 0). Positions are perturbed at random.
///
/// With `closed` the vertex is an interior one of valence `faces`, otherwise a boundary vertex of
/// valence `faces` + 1.
Cage fan(int faces, bool closed, std::uint64_t seed);

/// A closed disc of triangles around vertex 0.
Cage pole(int triangles);

/// An n-gon with a quad beyond each side. It is irregular at the n-gon's centre and, if n != 4, at
/// all its vertices.
Cage ngon(int sides, std::uint64_t seed);

/// columns x rows unit squares in the plane z = 0. Vertices are numbered in the order in which the
/// faces use them.
Cage grid(int columns, int rows);
/// The grid without some of its squares, given by column + columns * row.
Cage gridWithHoles(int columns, int rows, const std::vector<int>& holes);
/// The same squares with vertex i + (columns + 1) * j at (i, j, 0).
Cage fullGrid(int columns, int rows);
/// The cross of Lacewell & Burley's figure 1: five quads, twelve extraordinary boundary vertices.
Cage cross();
Cage cube();
Cage tetrahedron();
/// A prism over a regular polygon, with or without its bottom and top.
Cage prism(int sides, bool closed);
/// A closed torus of quads; all its vertices are regular.
Cage torus(int around, int across);
/// Two quads that share two neighbouring edges, so that the vertex between these is an interior one
/// of valence 2, in the middle of a grid.
Cage valenceTwo();

/// A random mixture of triangles, quads, pentagons and hexagons with boundaries and holes.
Cage mixture(std::uint64_t seed);

/// Moves every vertex at random by at most `size` along each axis.
Cage perturbed(Cage cage, double size, std::uint64_t seed);

/// The cage with all coordinates multiplied by `factor` and moved by `offset`.
Cage placed(Cage cage, double factor, const Vector3& offset = Vector3::Zero());

/// The cage without the vertices that no face uses. The others are numbered in the order in which
/// the faces use them. Must not have sharp edges or vertices.
Cage compacted(const Cage& cage);

/// The same surface with every face's vertices in the opposite order.
Cage reversed(Cage cage);

/// Each of its quads cut into two triangles.
Cage inTriangles(Cage cage);

}  // namespace limitsurf::test
