// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ratio_reporter.h"

namespace limitsurf::bench {

constexpr char kEvaluationTable[] = "evaluate";

/// Batches of about `sample_count` locations, by face class, order and derivatives.
std::vector<Group> evaluationGroups(int sample_count);

}  // namespace limitsurf::bench
