// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/image/filtered_image.h"

namespace limitsurf {

/// How colours are combined where both the upper and the lower pixel cover.
enum class BlendMode { mix, add, multiply };

/// Pixels `above` composited over pixels `below`; a row holds red, green, blue and alpha. `above`
/// has straight alpha, which is multiplied by `weight`. With `premultiplied`, `below` and the
/// result have colours multiplied by alpha, otherwise they have straight alpha.
///
/// mix is the operator "over" (Porter & Duff: "Compositing Digital Images", 1984). In the other
/// modes the colour that is laid over is (1 - alpha of below) above + (alpha of below) B, where B
/// is below + above for add and below * above for multiply, as in W3C's "Compositing and Blending
/// Level 1".
///
/// Properties:
///   (1) where the weight or the alpha of `above` is 0 the result is `below`, to the last bit;
///   (2) where both are 1 the result of mix is `above`.
///
/// Throws std::invalid_argument for arrays of other shapes, and naming the first weight that is not
/// in [0, 1].
Colours blendOver(const Colours& below, const Colours& above, const Eigen::VectorXd& weight,
                  BlendMode mode = BlendMode::mix, bool premultiplied = false);

}  // namespace limitsurf
