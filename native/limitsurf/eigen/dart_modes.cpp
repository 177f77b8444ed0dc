// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/dart_modes.h"

#include <cstdlib>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// Calls visit(point, n) for all points of the ring but the vertex.
template <typename Visit>
void forEachPoint(int faces, const Visit& visit) {
  for (int i = 0; i < faces; ++i) {
    visit(1 + i, std::abs(2 * i - faces));
    visit(1 + faces + i, std::abs(2 * i + 1 - faces));
  }
}

/// Calls visit(n, cos(psi n)) for n = 0, ..., N - 1.
template <typename Visit>
void forEachCosine(const WavePowers<double>& powers, int faces, const Visit& visit) {
  int n = 0;
  for (const auto& high : powers.high()) {
    for (const auto& low : powers.low()) {
      if (n == faces) {
        return;
      }
      visit(n++, high.cos * low.cos - high.sin * low.sin);
    }
  }
}

}  // namespace

double DartModes::lambda(int mode) const {
  return isGiven(mode) ? given_[mode].lambda : wave(mode).lambda;
}

ModeTable DartModes::table(int mode, int face) const {
  if (isGiven(mode)) {
    return given_[mode].tables[face];
  }
  const Wave& w = wave(mode);
  if (face == 0 || face == faces_ - 1) {
    return face == 0 ? w.first : w.last;
  }
  const auto turn = w.powers.at(2 * face + 1 - faces_);
  ModeTable result = w.constant;
  for (int i = 0; i < tile_grid::kOuter; ++i) {
    result.outer[i] += turn.cos * w.cosine.outer[i] - turn.sin * w.sine.outer[i];
  }
  for (int c = 0; c < tile_grid::kSlots; ++c) {
    result.grid[c] += turn.cos * w.cosine.grid[c] - turn.sin * w.sine.grid[c];
  }
  return result;
}

std::vector<double> DartModes::ringVector(int mode) const {
  std::vector<double> ring(1 + 2 * static_cast<std::size_t>(faces_));
  if (isGiven(mode)) {
    ring[0] = given_[mode].vertex;
    forEachPoint(faces_, [&](int point, int n) { ring[point] = given_[mode].right[n]; });
  } else {
    const Wave& w = wave(mode);
    ring[0] = w.right.vertex;
    forEachPoint(
        faces_, [&](int point, int n) { ring[point] = w.right.at(n, faces_, w.powers.at(n).cos); });
  }
  return ring;
}

void DartModes::project(const Eigen::Array4d ring[], int first, Points& coefficients) const {
  Points places = Points::Zero(faces_ + 1, 3);
  forEachPoint(faces_, [&](int point, int n) {
    places.row(n) += ring[point].head<3>().matrix().transpose();
  });
  const auto onPlaces = [&](const std::vector<double>& left) -> Vector3 {
    return places.transpose() * Eigen::Map<const Eigen::VectorXd>(left.data(), faces_ + 1);
  };
  coefficients.row(0) = onPlaces(constant_left_);
  for (std::size_t i = 0; i < given_.size(); ++i) {
    coefficients.row(first + static_cast<int>(i)) = onPlaces(given_[i].left);
  }

  InterruptionStride stride;
  Vector3 sums[2] = {Vector3::Zero(), Vector3::Zero()};  // over spokes, over faces
  for (int n = 0; n < faces_; ++n) {
    sums[(faces_ - n) % 2] += places.row(n).transpose();
  }
  for (int mode = static_cast<int>(given_.size()); mode < count(); ++mode) {
    stride.step();
    const Wave& w = wave(mode);
    Vector3 waves[2] = {Vector3::Zero(), Vector3::Zero()};
    forEachCosine(w.powers, faces_, [&](int n, double cosine) {
      waves[(faces_ - n) % 2] += cosine * places.row(n).transpose();
    });
    coefficients.row(first + mode) = (w.left.edge_constant * sums[0] + w.left.edge_wave * waves[0] +
                                      w.left.face_constant * sums[1] + w.left.face_wave * waves[1])
                                         .transpose() +
                                     w.left.sharp * places.row(faces_);
  }
}

void DartModes::projectTransposed(const Eigen::MatrixXd& mode_weights, int first,
                                  Eigen::MatrixXd& ring) const {
  Eigen::MatrixXd places = Eigen::MatrixXd::Zero(faces_ + 1, mode_weights.cols());
  const auto add = [&](const std::vector<double>& left, int row) {
    places += Eigen::Map<const Eigen::VectorXd>(left.data(), faces_ + 1) * mode_weights.row(row);
  };
  add(constant_left_, 0);
  for (std::size_t i = 0; i < given_.size(); ++i) {
    add(given_[i].left, first + static_cast<int>(i));
  }
  InterruptionStride stride;
  for (int mode = static_cast<int>(given_.size()); mode < count(); ++mode) {
    stride.step();
    const Wave& w = wave(mode);
    const auto weight = mode_weights.row(first + mode);
    forEachCosine(w.powers, faces_, [&](int n, double cosine) {
      places.row(n) += w.left.at(n, faces_, cosine) * weight;
    });
    places.row(faces_) += w.left.sharp * weight;
  }
  // project() takes points, and gives the constant's coefficient, relative to the vertex.
  ring.row(0) += mode_weights.row(0);
  forEachPoint(faces_, [&](int point, int n) {
    ring.row(point) += places.row(n);
    ring.row(0) -= places.row(n);
  });
}

}  // namespace limitsurf
