// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// The mode of a tip (RingKind::tip) in which its crease moves the vertex: the eigenvector with the
/// eigenvalue 1/4 that the curve of the crease has, continued to the faces.
///
/// All spokes have the same value, and so have all face points, so that one step maps (v, e, f) to
/// (., 3/8 v + e/2 + f/8, v/4 + e/2 + f/4). With v = -1 the eigenvalue 1/4 asks for 2 e + f = 3 and
/// e = 1/2. That are the control points of the paraboloid 3/2 (u^2 + v^2), which is the mode's
/// function on each face, whatever their number. Nothing else of the ring has the eigenvalue 1/4
/// and the same symmetry, so that this mode is in no Jordan chain.
struct TipBend {
  static constexpr int kMode = 3;
  static constexpr double kEigenvalue = 0.25;
  static constexpr double kVertex = -1, kEdge = 0.5, kFace = 2;
  static constexpr double kMean = 2;  ///< at the crease's far ends
  /// The coefficient is this times the mean of the crease's far ends less the vertex.
  static constexpr double kOfMean = 1. / 3;
};

}  // namespace limitsurf
