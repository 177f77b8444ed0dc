// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/image/filtered_image.h"

namespace limitsurf {

/// How colours come together where both the upper and the lower pixel cover.
enum class BlendMode { mix, add, multiply };

/// Pixels `above` laid over pixels `below`: red, green, blue, alpha a row. The alpha of `above` is
/// straight, and multiplied by `weight`. `premultiplied`: below, and the result, have colours
/// multiplied by alpha.
///
/// mix: alpha over (Porter & Duff, "Compositing Digital Images", 1984). The other modes: what is
/// laid over is (1 - alpha of below) above + (alpha of below) (below + above, or below times
/// above), as in W3C's "Compositing and Blending Level 1".
///
/// Properties:
///   (1) where the weight or above's alpha is 0 the result is below, to the last bit;
///   (2) where both are 1 mix gives above.
///
/// Throws std::invalid_argument for other shapes and naming the first weight that is not in [0, 1].
Colours blendOver(const Colours& below, const Colours& above, const Eigen::VectorXd& weight,
                  BlendMode mode = BlendMode::mix, bool premultiplied = false);

}  // namespace limitsurf
