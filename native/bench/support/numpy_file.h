// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace limitsurf::bench {

/// Write an array as a file in numpy's format (NPY 1.0). They throw std::runtime_error if the file
/// cannot be written.
void writeNumpy(
    const std::string& path,
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>&
        values);
void writeNumpy(const std::string& path, const std::vector<std::int64_t>& values);

}  // namespace limitsurf::bench
