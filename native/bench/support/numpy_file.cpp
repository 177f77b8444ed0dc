// SPDX-License-Identifier: Apache-2.0
#include "bench/support/numpy_file.h"

#include <fstream>
#include <stdexcept>

namespace limitsurf::bench {
namespace {

// The header's length, with the ten bytes before it, is a multiple of 64. Files are read on the
// machine that wrote them, which is little-endian wherever the benchmarks run.
void write(const std::string& path, const std::string& type, const std::string& shape,
           const void* data, std::size_t bytes) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::ofstream file(path, std::ios::binary);
  file.write("\x93NUMPY\x01\x00", 8);
  const char length[] = {static_cast<char>(header.size() & 255),
                         static_cast<char>(header.size() >> 8)};
  file.write(length, 2);
  file.write(header.data(), static_cast<std::streamsize>(header.size()));
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace

void writeNumpy(
    const std::string& path,
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>&
        values) {
  write(path, "<f8", std::to_string(values.rows()) + ", " + std::to_string(values.cols()),
        values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
}

void writeNumpy(const std::string& path, const std::vector<std::int64_t>& values) {
  write(path, "<i8", std::to_string(values.size()) + ",", values.data(),
        sizeof(std::int64_t) * values.size());
}

}  // namespace limitsurf::bench
