// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/curve_cubic.h"
#include "limitsurf/curves/edge_chains.h"
#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/curves/edge_place.h"
#include "limitsurf/curves/side_cubics.h"

namespace limitsurf {

/// A part of a cubic on which quadrature has converged.
struct CurveLeaf {
  int cubic;
  double from, to;  ///< the cubic's parameters
  double arc;       ///< where it begins, from the curve's start
};

struct EdgeCurves::Data {
  Data(const LimitSurface& surface, EdgeChains found, int threads);

  /// The cubics and leaves of one edge, with arcs from the edge's start.
  struct EdgeParts {
    std::vector<CurveCubic> cubics;
    std::vector<CurveLeaf> leaves;
    double length = 0;
  };

  EdgeChains chains;
  std::vector<double> edge_lengths, lengths;
  std::vector<CurveCubic> cubics;
  std::vector<CurveLeaf> leaves;
  std::vector<std::size_t> first_leaf;   ///< per curve, and the end
  std::vector<std::int64_t> cubic_edge;  ///< for each cubic, its edge
  std::vector<EdgeSides> left, right;    ///< per edge, where a face is there

 private:
  EdgeParts parts(const LimitSurface& surface, const SurfacePatches& patches,
                  const FaceTiles& tiles, const std::vector<int>& first_ptex,
                  const EdgeChains::Edge& edge) const;
};

}  // namespace limitsurf
