// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/support/ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kEvaluationTable[] = "evaluate";

/// Benchmarks of batches of about `sample_count` locations, by class of face, order of the
/// locations and order of derivatives.
std::vector<Group> evaluationGroups(int sample_count);

/// Writes the meshes and the locations of all these rows as numpy's files into an existing folder:
/// besides the mesh (MeshArrays::save()) ROW.sorted.face.npy and ROW.sorted.uv.npy, and the same
/// with "random".
void saveEvaluation(const std::string& folder, int sample_count);

constexpr char kDepthTable[] = "depth";

/// The same at distances of 1/2 to 2^-40 from extraordinary vertices, in face order.
std::vector<Group> depthGroups(int sample_count);

}  // namespace limitsurf::bench
