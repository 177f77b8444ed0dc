// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "limitsurf/eigen/dart_spectrum.h"
#include "limitsurf/eigen/dart_vectors.h"
#include "limitsurf/eigen/mode_continuation.h"
#include "limitsurf/eigen/mode_table.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Two modes a and b that a step mixes: A a = mean a + forth b, A b = mean b + back a. Their
/// eigenvalues are mean +- sqrt(forth back), real or conjugate. Unlike eigenvectors, the two modes
/// stay linearly independent where the eigenvalues become equal.
struct ModePair {
  int a = -1, b = -1;
  double mean = 0, forth = 0, back = 0;
};

/// The modes of a dart that are symmetric about its sharp spoke.
///
/// For N faces there are N + 1 of them besides the constant one. Some are given point by point: the
/// one with the lowest eigenvalue, the pair, and one that has the eigenvalue of an outer mode or is
/// linear. The others are waves around the vertex, whose tables serve all inner faces. All of them
/// together take O(N^1.5) memory.
class DartModes {
 public:
  explicit DartModes(int faces);

  int count() const { return static_cast<int>(given_.size() + waves_.size()); }
  /// The eigenvalue of a mode; for the modes of the pair, the mean of their eigenvalues.
  double lambda(int mode) const;
  const ModePair& pair() const { return pair_; }

  /// The mode that feeds outer modes because its eigenvalue is too close to theirs, 1/8; -1 if
  /// there is none. There is one for N = 6, 10, 14, ..., where a pole of the spectrum
  /// (dart_spectrum.h) is at 1/8.
  int restMode() const { return rest_.empty() ? -1 : kRestMode; }
  /// What that mode feeds into outer mode q of a face.
  double rest(int face, int q) const { return rest_[face][q]; }

  ModeTable table(int mode, int face) const;
  /// The mode on the ring: one value per point.
  std::vector<double> ringVector(int mode) const;

  /// Coefficients of the ring's points, which are relative to the vertex: row 0 gets the
  /// constant's, the rows from `first` on get those of the modes.
  void project(const Eigen::Array4d ring[], int first, Points& coefficients) const;
  /// Adds the transpose of project() to `ring`.
  void projectTransposed(const Eigen::MatrixXd& mode_weights, int first,
                         Eigen::MatrixXd& ring) const;

 private:
  using Real = DoubleDouble;
  class Builder;

  // A mode by its values at the places n = 0, ..., N (dart_wave.h) and at the vertex.
  struct Given {
    double lambda;
    double vertex;
    std::vector<double> right, left;
    std::vector<ModeTable> tables;  // one per face
  };
  struct Wave {
    double lambda;
    DartVector<double> right, left;
    WavePowers<double> powers;
    ModeTable constant, cosine, sine;  // on inner faces, with the wave's origin in their middle
    ModeTable first, last;             // on the faces beside the sharp spoke
  };
  // Numbers among given_: the lowest eigenvalue's mode is 0, the pair 1 and 2.
  static constexpr int kPair = 1, kRestMode = 3;

  const Wave& wave(int mode) const { return waves_[mode - static_cast<int>(given_.size())]; }
  bool isGiven(int mode) const { return mode < static_cast<int>(given_.size()); }

  int faces_;
  ModePair pair_;
  std::vector<double> constant_left_;
  std::vector<Given> given_;
  std::vector<Wave> waves_;
  std::vector<std::array<double, tile_grid::kOuter>> rest_;  // by face
};

}  // namespace limitsurf
