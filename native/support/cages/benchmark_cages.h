// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/cages/cage.h"

namespace limitsurf::test {

// The meshes of the benchmarks. They are open unless said otherwise. Their heights are random, but
// the same in every call.

/// 1232 quads of every class: a 12x12 grid cut to a plus (four concave, eight convex corners), open
/// fans of boundary valence 4 to 7, closed fans of valence 3, 5 and 6, with 6x6 quads a sector.
Cage everyClassCage();

/// The cross of Lacewell & Burley 2007, figure 1, many times: four boundary EVs on every face.
Cage crossesCage();

/// Alternating triangles and pentagons, without quads.
Cage polygonsCage();

/// A closed torus of quads, all of whose faces are regular.
Cage torusCage();

/// A closed mesh: 120 faces of 540 have one EV, of valence 3 or 5; all others are regular.
Cage interiorEvCage();

/// A torus with square holes: three faces at each concave corner have one EV, of boundary valence
/// 4; all others are regular.
Cage boundaryEvCage();

/// Separate 3x3 grids: four faces of nine have one corner (boundary valence 2).
Cage cornersCage();

/// side x side quads, of which about one in fifty is irregular: single faces are missing (boundary
/// EVs), and single edges are turned (interior EVs of valence 3 and 5).
Cage largeCage(int side);

/// side x side quads. Every edge is semi-sharp, with a random sharpness from 0.5 to 4.
Cage semiSharpCage(int side);

/// largeCage() as a character is modelled: every 40th quad is cut into two triangles, and every
/// 20th row has a semi-sharp edge loop, so that a quarter of the faces is irregular.
Cage characterCage(int side);

/// 2 side^2 triangles with diagonals in random directions and noise, as of a scanner.
Cage scanCage(int side);

}  // namespace limitsurf::test
