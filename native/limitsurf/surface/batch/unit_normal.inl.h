// SPDX-License-Identifier: Apache-2.0
//
// The arithmetic of unit normals, for numbers of any type for which there is a squareRoot(). To be
// included as bspline_formulas.inl.h is.

/// The unit vector along du x dv, and what tells whether it keeps its digits.
template <typename Number>
struct UnitNormal {
  UnitNormal(const Number du[3], const Number dv[3]) {
    const Number x = du[1] * dv[2] - du[2] * dv[1];
    const Number y = du[2] * dv[0] - du[0] * dv[2];
    const Number z = du[0] * dv[1] - du[1] * dv[0];
    square = x * x + y * y + z * z;
    const Number du_square = du[0] * du[0] + du[1] * du[1] + du[2] * du[2];
    const Number dv_square = dv[0] * dv[0] + dv[1] * dv[1] + dv[2] * dv[2];
    lengths = du_square * dv_square;
    squares = du_square + dv_square;
    const Number length = squareRoot(square);
    unit[0] = x / length;
    unit[1] = y / length;
    unit[2] = z / length;
  }

  Number unit[3];
  Number square;   ///< of the length of du x dv
  Number lengths;  ///< the product of the squared lengths of du and dv
  Number squares;  ///< their sum
};

/// Between these neither du x dv nor its square has overflowed or underflowed.
constexpr double kLeastSquare = 0x1p-900, kMostSquare = 0x1p900;

/// Whether neither du x dv nor its square has overflowed or underflowed, the squared sine of the
/// angle between du and dv is `lowest_sine_square` at least, and the rounding of du and dv is small
/// beside du x dv (see NormalLimits).
inline bool normalKeepsDigits(double square, double lengths, double squares,
                              double lowest_sine_square, double least_square) {
  return square >= kLeastSquare && square <= kMostSquare &&
         square >= lowest_sine_square * lengths && square >= least_square * squares;
}
