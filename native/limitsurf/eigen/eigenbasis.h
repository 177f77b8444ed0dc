// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "limitsurf/eigen/bspline_window.h"
#include "limitsurf/eigen/dart_modes.h"
#include "limitsurf/eigen/mode_table.h"
#include "limitsurf/eigen/outer_modes.h"
#include "limitsurf/eigen/ring.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Where to evaluate a face's control grid after some subdivision steps, and which derivatives.
struct GridWindow {
  int a, b;  ///< the quarter: window from cell (a - 1, b - 1)
  CubicWeights u, v;
  int order;  ///< 0: value; 1: du and dv as well; 2: duu, duv, dvv as well

  static constexpr int kMaxCount = 6;
  /// How many functionals that makes: 1, 3 or 6.
  int count() const { return order == 0 ? 1 : order == 1 ? 3 : 6; }
};

/// The eigenbasis of one kind of ring: everything that evaluation near an extraordinary vertex
/// needs to know about the vertex, and nothing about a mesh.
///
/// A ring's points are sums of modes, each of which subdivision multiplies by its eigenvalue; a
/// defective mode feeds another one as well (Jordan normal form; paper, section 2). Modes:
///   0          the constant, eigenvalue 1: its coefficient is the limit position;
///   1, 2       interior, cone: the two other rotation-symmetric ones; sector: the curve modes;
///   then       spoke modes, each a sine or cosine around the vertex (spoke_mode.h), of a dart
///   sines
///              about the sharp spoke alone;
///   the rest   of a dart: those symmetric about the sharp spoke (dart_modes.h).
/// Coefficients belong to the vertex and serve all its faces. Because a spoke mode turns with the
/// face, one pair of tables (for the sine and the cosine) serves all faces of the same Sides, so
/// that a basis takes O(faces) memory. Tables are computed in long double and rounded once.
class Eigenbasis {
 public:
  /// Bases are shared: all surfaces in a process use one per kind and number of faces.
  static std::shared_ptr<const Eigenbasis> get(const Ring& ring);

  explicit Eigenbasis(const Ring& ring);

  const Ring& ring() const { return ring_; }
  const RingStep<double>& step() const { return step_; }
  int modeCount() const { return ring_.size(); }
  /// Of the modes of a pair: the mean of their eigenvalues.
  double eigenvalue(int mode) const { return lambda_[mode]; }

  /// Jordan chains: A (mode `from`) = lambda (mode `from`) + rate (mode `to`).
  struct Chain {
    int from = -1, to = -1;
    double rate = 0;
  };
  const std::vector<Chain>& chains() const { return chains_; }
  /// Modes that a step mixes: two of a dart's.
  const std::vector<ModePair>& pairs() const { return pairs_; }
  /// What each mode feeds into outer mode `q` of a face: nothing but at interior valence 2 and in
  /// some darts.
  Eigen::VectorXd chainsToOuter(int face, int q) const {
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(modeCount());
    if (rest_mode_ >= 0) {
      rates[rest_mode_] = rest(face, q);
    }
    return rates;
  }

  /// Coefficients (one row per mode) of the ring's points. O(faces^2).
  void project(const Points& ring_points, Points& coefficients) const;

  /// The transpose of project(): weights on modes (rows) become weights on the ring's points.
  Eigen::MatrixXd projectTransposed(const Eigen::MatrixXd& mode_weights) const;

  /// A mode on the ring: one value per point. The modes are the columns of U0 in the paper, up to
  /// their order and length. O(faces).
  std::vector<double> ringVector(int mode) const;

  Sides sides(int face) const { return ring_.sides(face); }
  const OuterModes<double>& outerModes(int face) const { return tables(sides(face)).outer_modes; }

  using Table = ModeTable;
  Table table(int mode, int face) const;

  /// The face's control points after `steps` >= 1 steps less the constant mode, times 2^(steps - 1)
  /// lest they underflow.
  ///
  /// `coefficients` and `outer_points` (in the order of the outer cells) are relative to the limit
  /// position. Serves positions and first derivatives: second ones, where modes of very different
  /// size meet, keep their digits in weights() alone. Cost: O(faces).
  void controlGrid(int face, int steps, int ring_steps, const Points& coefficients,
                   const Eigen::Array4d outer_points[], Eigen::Array4d grid[]) const;

  /// Weights of the functionals after `steps` >= 1 steps, on the ring's modes and the outer points.
  ///
  /// Derivatives count in the face's own (u, v), so that first derivatives carry 2^steps and second
  /// ones 4^steps, of which 2^(steps - 1) is left to the caller (it may overflow).
  /// `ring_steps`: how many steps the ring's coefficients are older than the outer points.
  /// `mode_weights` gets one row per functional and one column per mode.
  /// Cost: O(faces).
  void weights(int face, int steps, int ring_steps, const GridWindow& window,
               Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& outer_weights) const;

 private:
  struct FaceTables {  // of the faces with the same Sides
    explicit FaceTables(const OuterModes<long double>& modes) : outer_modes(modes) {}
    OuterModes<double> outer_modes;
    std::vector<Table> outer;   // one per outer mode
    std::vector<Table> cosine;  // per spoke pair: 2 i for lambda+, 2 i + 1 for lambda-
    std::vector<Table> sine;
  };
  struct Fixed {  // modes 1 and 2 on one face
    Table tables[2];
  };
  struct Spoke {
    double edge, face;  // (x_e, x_f)
    double scale;       // the dual vector is (x_e, x_f / 4) times this
  };

  class Builder;
  friend class Builder;

  const FaceTables& tables(Sides sides) const { return *face_tables_[static_cast<int>(sides)]; }
  /// Spoke mode m (>= 1), lambda+ or lambda-: index into tables, and its first mode's number.
  int pairIndex(int m, bool plus) const { return 2 * (m - 1) + (plus ? 0 : 1); }
  int spokeCount() const { return ring_.closed() ? ring_.faces / 2 : ring_.faces; }
  /// Whether every turn by a face leaves the ring as it is, so that cosines are modes as well.
  bool rotates() const { return ring_.closed() && ring_.kind != RingKind::dart; }
  /// Spokes alternate in mode m, or faces do.
  bool alternates(int m) const { return ring_.closed() ? 2 * m == ring_.faces : m == ring_.faces; }
  /// The modes 1, 2 that are no spoke modes.
  int fixedCount() const { return ring_.kind == RingKind::dart ? 0 : 2; }
  /// The mode from which on a dart's are symmetric.
  int firstSymmetric() const { return ring_.faces; }
  double cosAt(long i) const { return cos_[static_cast<std::size_t>(i % period_)]; }
  double sinAt(long i) const { return sin_[static_cast<std::size_t>(i % period_)]; }
  const Fixed& fixed(int face) const { return fixed_[ring_.closed() ? 0 : face]; }
  double rest(int face, int q) const { return dart_ ? dart_->rest(face, q) : rest_[q]; }

  /// How the tables of pair (m, plus) combine into its modes on a face: each mode's number, and the
  /// factors of the cosine and the sine table.
  struct Part {
    int mode;
    double cosine, sine;
  };
  int parts(int m, bool plus, int face, Part out[2]) const;
  int firstMode(int m) const { return 1 + fixedCount() + (rotates() ? 4 : 2) * (m - 1); }
  int spokeOf(int mode) const { return 1 + (mode - 1 - fixedCount()) / (rotates() ? 4 : 2); }
  /// Calls body(table, lambda, coefficient) for all modes but the constant and pairs on one face.
  template <typename Body>
  void forEachTable(int face, const Points& coefficients, const Body& body) const;

  Ring ring_;
  RingStep<double> step_;
  long period_;  // of the trigonometric tables
  std::vector<double> cos_, sin_;
  std::vector<double> lambda_;
  std::vector<Spoke> spokes_;  // by pairIndex
  std::vector<Chain> chains_;
  std::vector<ModePair> pairs_;
  std::vector<double> rest_;  // interior valence 2: what mode 1 or 2 feeds into outer modes
  int rest_mode_ = -1;
  std::vector<Fixed> fixed_;                 // one for a closed ring, one per face of a sector
  std::vector<double> curve_ring_[2];        // sectors: modes 1 and 2 on the ring
  Eigen::Matrix2d radial_, radial_inverse_;  // closed: modes 1 and 2 from mean e - v, f - v
  double radial_vertex_[2] = {0, 0};
  std::unique_ptr<FaceTables> face_tables_[4];
  std::unique_ptr<const DartModes> dart_;
};

}  // namespace limitsurf
