// SPDX-License-Identifier: Apache-2.0
//
// From a ring's points to the coefficients of its modes (U0^-1 of Lacewell & Burley 2007, section
// 3.2), and the transpose of that.
#include <algorithm>

#include "limitsurf/eigen/curve_mode.h"
#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/tip_bend.h"

namespace limitsurf {
namespace {

using Padded = Eigen::Array4d;

struct RingMeans {
  Padded edge, face;
};

/// The means of the spoke points and of the face points of a closed ring, relative to v.
RingMeans meansFrom(const Padded& v, const Ring& ring, const Padded points[]) {
  RingMeans means{Padded::Zero(), Padded::Zero()};
  for (int i = 0; i < ring.faces; ++i) {
    means.edge += (points[ring.edge(i)] - v) / ring.faces;
    means.face += (points[ring.face(i)] - v) / ring.faces;
  }
  return means;
}

/// What projectTransposed() of a cone lacks to be that of a tip.
void addBendTransposed(const Ring& ring, const Eigen::MatrixXd& mode_weights,
                       Eigen::MatrixXd& weights) {
  Eigen::RowVectorXd bend = mode_weights.row(TipBend::kMode) + mode_weights.row(0);
  for (int i = 0; i < ring.faces; ++i) {
    bend -= (TipBend::kEdge - TipBend::kVertex) * weights.row(ring.edge(i)) +
            (TipBend::kFace - TipBend::kVertex) * weights.row(ring.face(i));
  }
  weights.row(ring.creaseMean()) += TipBend::kOfMean * bend;
  weights.row(0) -= TipBend::kOfMean * bend;
}

}  // namespace

void Eigenbasis::project(const Points& ring_points, Points& coefficients) const {
  std::vector<Padded> points;
  for (Eigen::Index i = 0; i < ring_points.rows(); ++i) {
    points.emplace_back(ring_points(i, 0), ring_points(i, 1), ring_points(i, 2), 0);
  }
  projectInPlace(points.data(), coefficients);
}

void Eigenbasis::projectInPlace(Padded ring_points[], Points& coefficients) const {
  const int faces = ring_.faces;
  coefficients.setZero(modeCount(), 3);
  const auto coefficient = [&](int mode) { return coefficients.row(mode).transpose().array(); };
  const Padded v = ring_points[0];
  if (ring_.closed()) {
    Padded limit = v;
    if (ring_.kind == RingKind::tip) {  // without its bend, the vertex stays where it is
      const Padded bend = TipBend::kOfMean * (ring_points[ring_.creaseMean()] - v);
      coefficient(TipBend::kMode) = bend.head<3>();
      limit += bend;
      for (int i = 0; i < faces; ++i) {
        ring_points[ring_.edge(i)] -= (TipBend::kEdge - TipBend::kVertex) * bend;
        ring_points[ring_.face(i)] -= (TipBend::kFace - TipBend::kVertex) * bend;
      }
    }
    if (!dart_) {
      const auto [edge_mean, face_mean] = meansFrom(v, ring_, ring_points);
      Padded constant = limit;
      for (int i = 0; i < 2; ++i) {
        const Padded value = radial_inverse_(i, 0) * edge_mean + radial_inverse_(i, 1) * face_mean;
        coefficient(1 + i) = value.head<3>();
        constant -= radial_vertex_[i] * value;
      }
      coefficient(0) = constant.head<3>();
    }
    for (int i = 0; i < ring_.size(); ++i) {
      ring_points[i] -= v;
    }
    if (dart_) {
      dart_->project(ring_points, firstSymmetric(), coefficients);
      coefficient(0) += v.head<3>();
    }
  } else {
    const auto curve = curveCoefficients<Padded>(ring_.kind, v, ring_points[ring_.edge(0)],
                                                 ring_points[ring_.edge(faces)]);
    coefficient(0) = curve.constant.head<3>();
    coefficient(1) = curve.first.head<3>();
    coefficient(2) = curve.second.head<3>();
    for (int i = 0; i < ring_.size(); ++i) {
      ring_points[i] -=
          curve.constant + curve_ring_[0][i] * curve.first + curve_ring_[1][i] * curve.second;
    }
  }

  const auto at = [&](int point) -> const Padded& { return ring_points[point]; };
  waves_->sums<Padded>(spokeCount(), at, [&](int m, const auto& sums) {
    // 2 / faces normalises sines and cosines, 1 / faces those that alternate.
    const double norm = (alternates(m) ? 1. : 2.) / faces;
    for (const bool plus : {true, false}) {
      const Spoke& spoke = spokes_[pairIndex(m, plus)];
      const double scale = norm * spoke.scale;
      const double e = scale * spoke.edge, f = scale * spoke.face / 4;
      const Padded cosine = e * sums.edge_cos + f * sums.face_cos,
                   sine = e * sums.edge_sin + f * sums.face_sin;
      // On face 0 the parts of the pair are the cosine mode and the sine mode themselves.
      Part part[2];
      const int count = parts(m, plus, 0, part);
      for (int i = 0; i < count; ++i) {
        const Padded& value = part[i].cosine != 0 ? cosine : sine;
        coefficient(part[i].mode) = value.head<3>();
      }
    }
  });
}

void Eigenbasis::addSpokesTransposed(const Eigen::MatrixXd& mode_weights,
                                     Eigen::MatrixXd& ring) const {
  const int faces = ring_.faces, edges = ring_.edges();
  for (int m = 1; m <= spokeCount(); ++m) {
    const double norm = (alternates(m) ? 1. : 2.) / faces;
    for (const bool plus : {true, false}) {
      const Spoke& spoke = spokes_[pairIndex(m, plus)];
      Part part[2];
      const int count = parts(m, plus, 0, part);
      for (int p = 0; p < count; ++p) {
        const std::vector<double>& wave = part[p].cosine != 0 ? cos_ : sin_;
        const auto weight = norm * spoke.scale * mode_weights.row(part[p].mode);
        for (int i = 0; i < edges; ++i) {
          ring.row(ring_.edge(i)) += spoke.edge * wave[edgeAngle(m, i) % period_] * weight;
        }
        for (int j = 0; j < faces; ++j) {
          ring.row(ring_.face(j)) += spoke.face / 4 * wave[faceAngle(m, j) % period_] * weight;
        }
      }
    }
  }
}

void Eigenbasis::transformSpokesTransposed(const Eigen::MatrixXd& mode_weights,
                                           Eigen::MatrixXd& ring) const {
  for (Eigen::Index begin = 0; begin < mode_weights.cols(); begin += 4) {
    const Eigen::Index columns = std::min<Eigen::Index>(4, mode_weights.cols() - begin);
    const auto weightsOf = [&](int m) {
      RingWaves::Sums<Padded> sums{Padded::Zero(), Padded::Zero(), Padded::Zero(), Padded::Zero()};
      const double norm = (alternates(m) ? 1. : 2.) / ring_.faces;
      for (const bool plus : {true, false}) {
        const Spoke& spoke = spokes_[pairIndex(m, plus)];
        Part part[2];
        const int count = parts(m, plus, 0, part);
        for (int p = 0; p < count; ++p) {
          const bool is_cosine = part[p].cosine != 0;
          Padded weight = Padded::Zero();
          weight.head(columns) =
              norm * spoke.scale * mode_weights.row(part[p].mode).segment(begin, columns).array();
          (is_cosine ? sums.edge_cos : sums.edge_sin) += spoke.edge * weight;
          (is_cosine ? sums.face_cos : sums.face_sin) += spoke.face / 4 * weight;
        }
      }
      return sums;
    };
    waves_->transposedSums<Padded>(spokeCount(), weightsOf, [&](int point, const Padded& sum) {
      ring.row(point).segment(begin, columns) += sum.head(columns).matrix().transpose();
    });
  }
}

Eigen::MatrixXd Eigenbasis::projectTransposed(const Eigen::MatrixXd& mode_weights) const {
  const int faces = ring_.faces;
  Eigen::MatrixXd ring = Eigen::MatrixXd::Zero(ring_.size(), mode_weights.cols());
  if (waves_->hasTransform()) {
    transformSpokesTransposed(mode_weights, ring);
  } else {
    addSpokesTransposed(mode_weights, ring);
  }

  if (dart_) {
    dart_->projectTransposed(mode_weights, firstSymmetric(), ring);
    return ring;
  }
  if (ring_.closed()) {
    // project() gives e - v and f - v to the spoke modes, but the sum of v over each wave is 0.
    const auto constant = mode_weights.row(0);
    Eigen::MatrixXd means(2, mode_weights.cols());
    for (int i = 0; i < 2; ++i) {
      means.row(i).setZero();
      for (int mode = 0; mode < 2; ++mode) {
        means.row(i) += radial_inverse_(mode, i) *
                        (mode_weights.row(1 + mode) - radial_vertex_[mode] * constant);
      }
    }
    for (int i = 0; i < faces; ++i) {
      ring.row(ring_.edge(i)) += means.row(0) / faces;
      ring.row(ring_.face(i)) += means.row(1) / faces;
    }
    ring.row(0) += constant - means.row(0) - means.row(1);
    if (ring_.kind == RingKind::tip) {
      addBendTransposed(ring_, mode_weights, ring);
    }
    return ring;
  }

  // project() gives the spoke modes what the curve modes have left over.
  Eigen::MatrixXd curve = mode_weights.topRows(3);
  for (int i = 0; i < ring_.size(); ++i) {
    curve.row(0) -= ring.row(i);
    curve.row(1) -= curve_ring_[0][i] * ring.row(i);
    curve.row(2) -= curve_ring_[1][i] * ring.row(i);
  }
  for (int i = 0; i < 3; ++i) {
    const Vector3 unit = Vector3::Unit(i);
    const auto c = curveCoefficients<double>(ring_.kind, unit[0], unit[1], unit[2]);
    ring.row(i == 0 ? 0 : ring_.edge(i == 1 ? 0 : faces)) +=
        c.constant * curve.row(0) + c.first * curve.row(1) + c.second * curve.row(2);
  }
  return ring;
}

}  // namespace limitsurf
