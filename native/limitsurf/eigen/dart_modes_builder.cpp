// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "limitsurf/eigen/dart_modes.h"
#include "limitsurf/eigen/dart_places.h"
#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/interruption_point.h"

namespace limitsurf {

using tile_grid::slot;

/// Computes DartModes, in double-doubles.
class DartModes::Builder {
 public:
  explicit Builder(DartModes& modes)
      : modes_(modes), faces_(modes.faces_), ring_{RingKind::dart, modes.faces_} {}

  void build() {
    DartSpectrum spectrum(faces_);
    addConstant();
    addGiven(DecayingWave<Real>(faces_, spectrum.lowest));
    addPair(spectrum.pair);
    if (faces_ == 4) {
      const auto half = closest(spectrum.waves, Real(1) / 2);
      addLinear(*half);
      spectrum.waves.erase(half);
    }
    if (faces_ % 4 == 2 && faces_ > 2) {
      const auto met = closest(spectrum.waves, kMet);
      addMeeting(*met);
      spectrum.waves.erase(met);
    }
    modes_.waves_.reserve(spectrum.waves.size());
    InterruptionStride stride;
    for (const CircleWave<Real>& wave : spectrum.waves) {
      stride.step();
      addWave(wave);
    }
  }

 private:
  using SlotValues = ModeContinuation::SlotValues;
  static constexpr Real kMet = Real(1) / 8;  // an eigenvalue of S12

  static std::vector<CircleWave<Real>>::iterator closest(std::vector<CircleWave<Real>>& waves,
                                                         Real lambda) {
    return std::min_element(waves.begin(), waves.end(), [&](const auto& a, const auto& b) {
      return abs(a.lambda() - lambda) < abs(b.lambda() - lambda);
    });
  }

  using Places = std::vector<Real>;

  /// Without the vertex.
  static std::vector<double> rounded(const Places& places) {
    std::vector<double> result;
    for (int n = 0; n + 1 < static_cast<int>(places.size()); ++n) {
      result.push_back(static_cast<double>(places[n]));
    }
    return result;
  }

  /// The values at a face's slots of what has the value at(n) at the place n; n = N + 1 is the
  /// vertex.
  template <typename At>
  SlotValues ringValuesOf(const At& at, int face) const {
    SlotValues values{};
    forEachRingSlot(ring_, face, [&](int slot, int point) {
      values[slot] =
          at(point == 0              ? faces_ + 1
             : point < ring_.face(0) ? std::abs(2 * (point - ring_.edge(0)) - faces_)
                                     : std::abs(2 * (point - ring_.face(0)) + 1 - faces_));
    });
    return values;
  }
  SlotValues ringValues(const Places& places, int face) const {
    return ringValuesOf([&](int n) { return places[n]; }, face);
  }

  /// The constant mode's left eigenvector, which is the mask of limit positions.
  void addConstant() {
    const DecayingWave<Real> wave(faces_, 1);
    Places left = placesOf(DartVectors(faces_, wave).left, wave, faces_);
    scalePlaces(left, Real(1) / productOfPlaces(left, Places(left.size(), 1)));
    modes_.constant_left_ = rounded(left);
  }

  struct Eigenvectors {
    Places right, left;
  };

  template <typename Wave>
  Eigenvectors eigenvectors(const Wave& wave) const {
    const DartVectors<Wave> vectors(faces_, wave);
    Eigenvectors result{placesOf(vectors.right, wave, faces_),
                        placesOf(vectors.left, wave, faces_)};
    scalePlaces(result.right, 1 / largestOfPlaces(result.right));
    scalePlaces(result.left, 1 / productOfPlaces(result.left, result.right));
    return result;
  }

  void addGiven(Real lambda, const Eigenvectors& vectors) {
    modes_.given_.push_back({static_cast<double>(lambda),
                             static_cast<double>(vectors.right.back()),
                             rounded(vectors.right),
                             rounded(vectors.left),
                             {}});
  }

  template <typename Wave>
  void addGiven(const Wave& wave) {
    const Eigenvectors vectors = eigenvectors(wave);
    addGiven(wave.lambda(), vectors);
    for (int face = 0; face < faces_; ++face) {
      modes_.given_.back().tables.push_back(ModeContinuation::rounded(
          ModeContinuation::of(ring_.sides(face))
              .continued(wave.lambda(), ringValues(vectors.right, face))));
    }
  }

  /// Valence 4, lambda = 1/2: a mode that is linear on every face, cos(pi/2 (i - 2)) at e_i. Second
  /// derivatives of other modes are bounded, while these would be multiplied by 2^n: they have to
  /// be exactly 0.
  void addLinear(const CircleWave<Real>& wave) {
    Eigenvectors vectors = eigenvectors(wave);
    for (Real& value : vectors.right) {
      value = std::round(value.high());
    }
    scalePlaces(vectors.left, 1 / productOfPlaces(vectors.left, vectors.right));
    addGiven(Real(1) / 2, vectors);
    for (int face = 0; face < faces_; ++face) {
      const SlotValues values = ringValues(vectors.right, face);
      modes_.given_.back().tables.push_back(ModeContinuation::rounded(
          ModeContinuation::of(ring_.sides(face)).linear(values[slot(1, 0)], values[slot(0, 1)])));
    }
  }

  /// A mode whose eigenvalue is too close to one of S12 to be told from it.
  void addMeeting(const CircleWave<Real>& wave) {
    const Eigenvectors vectors = eigenvectors(wave);
    addGiven(wave.lambda(), vectors);
    for (int face = 0; face < faces_; ++face) {
      const auto wide = ModeContinuation::of(ring_.sides(face))
                            .continuedBeside(wave.lambda(), kMet, ringValues(vectors.right, face));
      modes_.given_.back().tables.push_back(ModeContinuation::rounded(wide));
      modes_.rest_.push_back({});
      for (Eigen::Index q = 0; q < wide.rest.size(); ++q) {
        modes_.rest_.back()[q] = static_cast<double>(wide.rest[q]);
      }
    }
  }

  /// For eigenvectors w1 and w2 to mean +- d the pair is a = (w1 + w2) / 2 and b = (w1 - w2) / (2
  /// d), which both have a limit at d = 0. So have their coefficients c1 + c2 and (c1 - c2) d.
  void addPair(const std::vector<CircleWave<Complex>>& waves) {
    const Complex lambda[2] = {waves[0].lambda(), waves[1].lambda()};
    const Complex half = (lambda[0] - lambda[1]) / Real(2);
    std::vector<Complex> right[2], left[2];
    for (int i = 0; i < 2; ++i) {
      const DartVectors<CircleWave<Complex>> vectors(faces_, waves[i]);
      right[i] = placesOf(vectors.right, waves[i], faces_);
      left[i] = placesOf(vectors.left, waves[i], faces_);
      scalePlaces(left[i], Real(1) / productOfPlaces(left[i], right[i]));
    }
    Eigenvectors vectors[2];
    for (std::size_t n = 0; n < right[0].size(); ++n) {
      vectors[0].right.push_back((right[0][n] + right[1][n]).real() / 2);
      vectors[1].right.push_back(((right[0][n] - right[1][n]) / (Real(2) * half)).real());
      vectors[0].left.push_back((left[0][n] + left[1][n]).real());
      vectors[1].left.push_back(((left[0][n] - left[1][n]) * half).real());
    }
    Real size[2];
    for (int i = 0; i < 2; ++i) {
      size[i] = largestOfPlaces(vectors[i].right);
      scalePlaces(vectors[i].right, 1 / size[i]);
      scalePlaces(vectors[i].left, size[i]);
    }
    const Real mean = (lambda[0] + lambda[1]).real() / 2, back = size[0] / size[1];
    const Real forth = (half * half).real() / back;
    modes_.pair_ = {kPair, kPair + 1, static_cast<double>(mean), static_cast<double>(forth),
                    static_cast<double>(back)};
    addGiven(mean, vectors[0]);
    addGiven(mean, vectors[1]);
    for (int face = 0; face < faces_; ++face) {
      const auto wide = ModeContinuation::of(ring_.sides(face))
                            .continuedPair(mean, forth, back,
                                           {ringValues(vectors[0].right, face),
                                            ringValues(vectors[1].right, face)});
      for (int i = 0; i < 2; ++i) {
        modes_.given_[kPair + i].tables.push_back(ModeContinuation::rounded(wide[i]));
      }
    }
  }

  static DartVector<double> rounded(const DartVector<Real>& v) {
    return {static_cast<double>(v.vertex),        static_cast<double>(v.sharp),
            static_cast<double>(v.edge_constant), static_cast<double>(v.edge_wave),
            static_cast<double>(v.face_constant), static_cast<double>(v.face_wave)};
  }

  /// Calls visit(slot, n) for the ring's slots, without the vertex's, of a face at place 0.
  template <typename Visit>
  static void forEachPlace(const Visit& visit) {
    visit(slot(0, -1), -3);
    visit(slot(1, -1), -2);
    visit(slot(1, 0), -1);
    visit(slot(1, 1), 0);
    visit(slot(0, 1), 1);
    visit(slot(-1, 1), 2);
    visit(slot(-1, 0), 3);
  }

  void addWave(const CircleWave<Real>& wave) {
    const WavePowers<Real> powers(wave, faces_);
    DartVectors<CircleWave<Real>> vectors(faces_, wave);
    normalize(wave, powers, vectors);
    Wave result{static_cast<double>(wave.lambda()),
                rounded(vectors.right),
                rounded(vectors.left),
                WavePowers<double>(powers),
                {},
                {},
                {},
                {},
                {}};
    if (faces_ > 2) {
      continueOnInnerFaces(wave.lambda(), powers, vectors.right, result);
    }
    continueBesideSharpSpoke(wave.lambda(), powers, vectors.right, result);
    modes_.waves_.push_back(std::move(result));
  }

  /// Scales both vectors so that the right one's largest value is 1 and their product is 1. From
  /// here on the wave is a cosine at faces as well.
  void normalize(const CircleWave<Real>& wave, const WavePowers<Real>& powers,
                 DartVectors<CircleWave<Real>>& vectors) const {
    for (DartVector<Real>* vector : {&vectors.right, &vectors.left}) {
      vector->face_wave /= wave.root();
    }
    DartVector<Real>&right = vectors.right, &left = vectors.left;
    const Real size = largest(powers, right);
    right.scale(1 / size);
    left.scale(1 / product(powers, left, right));
  }

  /// The largest value of a vector, in double.
  double largest(const WavePowers<Real>& powers, const DartVector<Real>& vector) const {
    const DartVector<double> v = rounded(vector);
    double result = std::max(std::abs(v.vertex), std::abs(v.sharp));
    const WavePowers<double> waves(powers);
    for (int n = 0; n < faces_; ++n) {
      result = std::max(result, std::abs(v.at(n, faces_, waves.at(n).cos)));
    }
    return result;
  }

  /// The product of a left and a right vector, as a sum over all points of the ring.
  Real product(const WavePowers<Real>& powers, const DartVector<Real>& left,
               const DartVector<Real>& right) const {
    const CosineSums<Real> sums(powers, faces_);
    const int spoke = faces_ % 2, face = 1 - spoke;  // the parity of their places
    const Real spokes = faces_ - 1, faces = faces_;
    return right.vertex * left.vertex + right.sharp * left.sharp +
           right.edge_constant * left.edge_constant * spokes +
           (right.edge_constant * left.edge_wave + right.edge_wave * left.edge_constant) *
               sums.first[spoke] +
           right.edge_wave * left.edge_wave * sums.square[spoke] +
           right.face_constant * left.face_constant * faces +
           (right.face_constant * left.face_wave + right.face_wave * left.face_constant) *
               sums.first[face] +
           right.face_wave * left.face_wave * sums.square[face];
  }

  ModeTable continued(Sides sides, Real lambda, const SlotValues& values) {
    return ModeContinuation::rounded(ModeContinuation::of(sides).continued(lambda, values));
  }

  /// The tables from which the mode is put together on each inner face.
  void continueOnInnerFaces(Real lambda, const WavePowers<Real>& powers,
                            const DartVector<Real>& right, Wave& result) {
    SlotValues constant{}, cosine{}, sine{};
    constant[slot(0, 0)] = right.vertex;
    forEachPlace([&](int slot, int n) {
      const bool on_spoke = n % 2 != 0;
      const auto power = powers.at(n);
      constant[slot] = on_spoke ? right.edge_constant : right.face_constant;
      cosine[slot] = (on_spoke ? right.edge_wave : right.face_wave) * power.cos;
      sine[slot] = (on_spoke ? right.edge_wave : right.face_wave) * power.sin;
    });
    result.constant = continued(Sides::inner, lambda, constant);
    result.cosine = continued(Sides::inner, lambda, cosine);
    result.sine = continued(Sides::inner, lambda, sine);
  }

  /// The tables of the first and the last face.
  void continueBesideSharpSpoke(Real lambda, const WavePowers<Real>& powers,
                                const DartVector<Real>& right, Wave& result) {
    for (const int face : {0, faces_ - 1}) {
      const auto at = [&](int n) {
        return n > faces_ ? right.vertex : right.at(n, faces_, powers.at(n).cos);
      };
      (face == 0 ? result.first : result.last) =
          continued(ring_.sides(face), lambda, ringValuesOf(at, face));
    }
  }

  DartModes& modes_;
  const int faces_;
  const Ring ring_;
};

DartModes::DartModes(int faces) : faces_(faces) { Builder(*this).build(); }

}  // namespace limitsurf
