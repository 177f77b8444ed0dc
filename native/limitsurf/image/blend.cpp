// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/image/blend.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/interruption_point.h"
#include "limitsurf/number_text.h"

namespace limitsurf {
namespace {

void checkShapes(const Colours& below, const Colours& above, const Eigen::VectorXd& weight) {
  for (const Colours* pixels : {&below, &above}) {
    if (pixels->cols() != 4 || pixels->rows() != weight.rows()) {
      throw std::invalid_argument(std::string(pixels == &below ? "below" : "above") + " has " +
                                  std::to_string(pixels->rows()) + " rows of " +
                                  std::to_string(pixels->cols()) + "; expected " +
                                  std::to_string(weight.rows()) + " of 4, as there are weights");
    }
  }
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    if (!(weight[i] >= 0 && weight[i] <= 1)) {
      throw std::invalid_argument("row " + std::to_string(i) + ": the weight " +
                                  numberText(weight[i]) + " is not between 0 and 1");
    }
  }
}

/// The colour that is laid over. `under` is the lower colour times its alpha.
float laidOver(float colour, float under, float under_alpha, BlendMode mode) {
  switch (mode) {
    case BlendMode::add:
      return colour + under;
    case BlendMode::multiply:
      return (1 - under_alpha) * colour + under * colour;
    default:
      return colour;
  }
}

}  // namespace

Colours blendOver(const Colours& below, const Colours& above, const Eigen::VectorXd& weight,
                  BlendMode mode, bool premultiplied) {
  checkShapes(below, above, weight);
  Colours out(below.rows(), 4);
  InterruptionStride stride;
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    stride.step();
    out.row(i) = below.row(i);
    const float alpha = static_cast<float>(weight[i]) * std::clamp(above(i, 3), 0.f, 1.f);
    if (!(alpha > 0)) {
      continue;
    }
    const float under_alpha = below(i, 3);
    const float out_alpha = alpha + under_alpha * (1 - alpha);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const float under = premultiplied ? below(i, c) : below(i, c) * under_alpha;
      const float colour =
          alpha * laidOver(above(i, c), under, under_alpha, mode) + (1 - alpha) * under;
      out(i, c) = premultiplied ? colour : colour / out_alpha;
    }
    out(i, 3) = out_alpha;
  }
  return out;
}

}  // namespace limitsurf
