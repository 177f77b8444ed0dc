// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/chirp_transform.h"

#include "limitsurf/eigen/circle.h"

namespace limitsurf {

ChirpTransform::ChirpTransform(const std::vector<double>& cos, const std::vector<double>& sin) {
  const std::size_t period = cos.size(), n = period / 2;
  std::size_t size = 2;
  while (size < 2 * n - 1) {
    size *= 2;
  }
  const auto count = static_cast<std::int64_t>(size);
  for (const auto& root : Circle<DoubleDouble>(count).first(count / 2)) {
    roots_.push_back({static_cast<double>(root.cos), static_cast<double>(root.sin)});
  }
  std::vector<double> re(size, 0.), im(size, 0.);
  std::size_t square = 0;  // i^2 modulo the period
  for (std::size_t i = 0; i < n; ++i) {
    chirp_.push_back({cos[square], sin[square]});
    re[i] = re[(size - i) % size] = cos[square];
    im[i] = im[(size - i) % size] = sin[square];
    square = (square + 2 * i + 1) % period;
  }
  forward(re.data(), im.data(), size, 1);
  const double scale = 1 / static_cast<double>(size);
  for (std::size_t i = 0; i < size; ++i) {
    kernel_.push_back({scale * re[i], scale * im[i]});
  }
}

}  // namespace limitsurf
