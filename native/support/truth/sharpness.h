// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf::test {

// What finite sharpness does in one subdivision, written out from the documentation of OpenSubdiv's
// Sdc (its code is not used). As there, all arithmetic on sharpness is float32's.

enum class Rule { smooth, dart, crease, corner };

constexpr float kInfinitelySharp = 10;
constexpr bool isInfinitelySharp(float sharpness) { return sharpness >= kInfinitelySharp; }

/// As the mesh keeps it: a float32, and never above infinitely sharp.
float enteredSharpness(double value);

/// What remains after one subdivision: one less, unless infinite.
float decayed(float sharpness);

/// What remains of the edges around a vertex, each at that vertex' end: decayed; under Chaikin's
/// rule after mixing each with a quarter of the mean of the other semi-sharp ones, added in the
/// order of their values.
std::vector<float> childSharpness(const std::vector<float>& edges, Creasing creasing);

/// By a vertex' own sharpness and that of the sharp edges around it.
Rule vertexRule(float vertex, const std::vector<float>& edges);

/// How much of the parent's rule there is in the new vertex where the child's is another one: the
/// mean of all sharpness that decays to 0 in this step, at most 1. The vertex' own is added first,
/// then the edges' in the order of their values.
float parentsShare(float vertex, const std::vector<float>& edges,
                   const std::vector<float>& child_edges, Creasing creasing);

}  // namespace limitsurf::test
