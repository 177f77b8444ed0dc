// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/eigen/bspline_window.h"
#include "limitsurf/eigen/dart_modes.h"
#include "limitsurf/eigen/derivative_nets.h"
#include "limitsurf/eigen/mode_table.h"
#include "limitsurf/eigen/outer_modes.h"
#include "limitsurf/eigen/ring.h"
#include "limitsurf/eigen/ring_waves.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Where a face's control grid is evaluated after some subdivision steps, and which derivatives.
struct GridWindow {
  int a, b;  ///< the quarter: its window begins at slot (a - 1, b - 1)
  CubicWeights u, v;
  int order;  ///< 0: value; 1: du and dv as well; 2: duu, duv, dvv as well

  static constexpr int kMaxCount = 6;
  /// The number of functionals: 1, 3 or 6.
  int count() const { return order == 0 ? 1 : order == 1 ? 3 : 6; }
};

/// The eigenbasis of one kind of ring: everything that evaluation near an extraordinary vertex has
/// to know about the vertex, and nothing about a mesh.
///
/// The method is that of
///     J. Stam, "Exact evaluation of Catmull-Clark subdivision surfaces at arbitrary parameter
///     values", SIGGRAPH 1998,
/// extended to boundaries by
///     D. Lacewell and B. Burley, "Exact evaluation of Catmull-Clark subdivision surfaces near
///     B-spline boundaries", journal of graphics tools 12 (3), 2007.
/// Comments in this library name them "Stam" and "Lacewell & Burley". The eigenvectors are closed
/// forms here, while Lacewell & Burley (section 3.1) compute them numerically. Pinned corners,
/// cones, darts, tips and loops, which neither paper treats, are additions.
///
/// The points of a ring are sums of modes. A subdivision step multiplies each mode by its
/// eigenvalue; a defective mode also feeds another one (the Jordan normal form of Lacewell &
/// Burley, section 2). The modes are, in this order:
///   0          the constant one, eigenvalue 1: its coefficient is the limit position;
///   1, 2       interior, cone, tip: the two other rotation-symmetric ones; sector: the curve
///              modes (curve_mode.h);
///   3          of a tip: the bend of the crease, eigenvalue 1/4; its function is the paraboloid
///              3/2 (u^2 + v^2) on each face;
///   then       spoke modes, each a sine or cosine around the vertex (spoke_mode.h); a dart has
///              only the sines about its sharp spoke;
///   the rest   of a dart: the modes that are symmetric about the sharp spoke (dart_modes.h).
/// Coefficients belong to the vertex and serve all its faces. Because a spoke mode turns with the
/// face, one pair of tables (for the sine and the cosine) serves all faces of the same Sides, so
/// that a basis takes O(faces) memory. Tables are computed in double-doubles, of 32 digits, and
/// rounded once.
class Eigenbasis {
 public:
  // Construction. Every surface asks get() once for each kind of ring that it has.

  /// The basis of a ring, which all surfaces of a process share. Thread-safe.
  static std::shared_ptr<const Eigenbasis> get(const Ring& ring);

  explicit Eigenbasis(const Ring& ring);

  // The ring and its subdivision.

  const Ring& ring() const { return ring_; }
  const RingStep<double>& step() const { return step_; }

  // The Jordan normal form of the ring matrix S: what a step does to the coefficients. Limits at
  // the vertex itself are read from it.

  int modeCount() const { return ring_.size(); }
  /// The eigenvalue of a mode; for the modes of a pair, the mean of their two eigenvalues.
  double eigenvalue(int mode) const { return lambda_[mode]; }

  /// A Jordan chain: A (mode `from`) = lambda (mode `from`) + rate (mode `to`).
  struct Chain {
    int from = -1, to = -1;
    double rate = 0;
  };
  const std::vector<Chain>& chains() const { return chains_; }
  /// Pairs of modes that a step mixes. Only darts have one.
  const std::vector<ModePair>& pairs() const { return pairs_; }
  /// What each mode feeds into outer mode `q` of a face. Only interior rings of valence 2 and some
  /// darts have a mode that feeds outer modes.
  Eigen::VectorXd chainsToOuter(int face, int q) const {
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(modeCount());
    if (rest_mode_ >= 0) {
      rates[rest_mode_] = rest(face, q);
    }
    return rates;
  }

  // From the ring's points to coefficients of the modes: once for each vertex and pose.

  /// Coefficients (one row per mode) of the ring's points. O(faces log faces), or O(faces^2) for
  /// a dart.
  void project(const Points& ring_points, Points& coefficients) const;
  /// The same. The fourth numbers of the points are 0; `ring_points` is working memory afterwards.
  void projectInPlace(Eigen::Array4d ring_points[], Points& coefficients) const;

  /// The transpose of project(): weights on modes (rows) become weights on the ring's points.
  /// O(faces log faces) for each column, or O(faces^2) for a dart.
  Eigen::MatrixXd projectTransposed(const Eigen::MatrixXd& mode_weights) const;

  /// A mode on the ring: one value per point. The modes are the columns of U0 (Lacewell & Burley,
  /// section 3.1), up to their order and length. O(faces).
  std::vector<double> ringVector(int mode) const;

  // The faces of the ring, and the modes' values on them.

  Sides sides(int face) const { return ring_.sides(face); }
  const OuterModes<double>& outerModes(int face) const { return tables(sides(face)).outer_modes; }

  using Table = ModeTable;
  Table table(int mode, int face) const;

  // Evaluation after any number of steps: controlGrid() gives control points from which positions
  // and first derivatives keep their digits; derivativeNets() serves second derivatives, and
  // weights() stencils.

  /// The face's control points after `steps` >= 1 steps less the constant mode, times 2^(steps - 1)
  /// so that they do not underflow.
  ///
  /// `coefficients` and `outer_points` (in the order of the outer slots) are relative to the limit
  /// position. Second derivatives, where modes of very different size meet, lose digits in the
  /// sum: take derivativeNets() for them. Cost: O(faces).
  void controlGrid(int face, int steps, int ring_steps, const Points& coefficients,
                   const Eigen::Array4d outer_points[], Eigen::Array4d grid[]) const;

  /// The control points in the same scale with their differences (derivative_nets.h), from which
  /// second derivatives keep their digits, too. Only what is selected is computed. Cost: O(faces),
  /// about four times that of controlGrid().
  void derivativeNets(int face, int steps, int ring_steps, const Points& coefficients,
                      const Eigen::Array4d outer_points[],
                      const derivative_nets::Selection& selection, Eigen::Array4d nets[]) const;

  /// The weights of the ring's modes and of the outer points in the functionals of `window` (values
  /// and derivatives), after `steps` >= 1 steps. `mode_weights` gets a row for each functional and
  /// a column for each mode, `outer_weights` a column for each outer point.
  ///
  /// Derivatives are with respect to the face's own (u, v). Each step halves (u, v), so that first
  /// derivatives have the factor 2^steps and second ones 4^steps. The weights of second derivatives
  /// have only the factor 2^(steps + 1): the caller multiplies by the remaining 2^(steps - 1),
  /// which may overflow.
  ///
  /// The ring's coefficients belong to the level `ring_steps` subdivisions before that of the outer
  /// points.
  /// Cost: O(faces).
  void weights(int face, int steps, int ring_steps, const GridWindow& window,
               Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& outer_weights) const;

 private:
  struct FaceTables {  // of all faces with the same Sides
    explicit FaceTables(const OuterModes<DoubleDouble>& modes) : outer_modes(modes) {}
    OuterModes<double> outer_modes;
    std::vector<Table> outer;   // one per outer mode
    std::vector<Table> cosine;  // per spoke pair: 2 i for lambda+, 2 i + 1 for lambda-
    std::vector<Table> sine;
  };
  struct Fixed {  // modes 1 and 2 on one face; of a tip, mode 3 as well
    Table tables[3];
  };
  struct Spoke {
    double edge, face;  // (x_e, x_f)
    double scale;       // the dual vector is (x_e, x_f / 4) times this
  };

  class Builder;
  class GridSum;        // controlGrid(), derivativeNets()
  class WindowWeights;  // weights()

  const FaceTables& tables(Sides sides) const { return *face_tables_[static_cast<int>(sides)]; }
  /// The index of spoke mode m (>= 1), to lambda+ or lambda-, among the tables of a face.
  int pairIndex(int m, bool plus) const { return 2 * (m - 1) + (plus ? 0 : 1); }
  int spokeCount() const { return ring_.closed() ? ring_.faces / 2 : ring_.faces; }
  /// Whether a turn by one face maps the ring onto itself, so that cosines are modes as well.
  bool rotates() const { return ring_.closed() && ring_.kind != RingKind::dart; }
  /// Whether the values of mode m change their sign from one spoke or face to the next.
  bool alternates(int m) const { return ring_.closed() ? 2 * m == ring_.faces : m == ring_.faces; }
  /// How many of the modes 1 to 3 are neither spoke modes nor symmetric ones of a dart.
  int fixedCount() const {
    return ring_.kind == RingKind::dart ? 0 : ring_.kind == RingKind::tip ? 3 : 2;
  }
  /// The first of a dart's symmetric modes.
  int firstSymmetric() const { return ring_.faces; }
  /// Where spoke e_i and face point f_j of mode m stand in the tables cos_ and sin_, before they
  /// are taken modulo period_. A product of two valences may exceed 32 bits.
  static std::int64_t edgeAngle(int m, int i) { return 2 * std::int64_t{m} * i; }
  static std::int64_t faceAngle(int m, int j) {
    return std::int64_t{m} * (2 * std::int64_t{j} + 1);
  }
  double cosAt(std::int64_t i) const { return cos_[static_cast<std::size_t>(i % period_)]; }
  double sinAt(std::int64_t i) const { return sin_[static_cast<std::size_t>(i % period_)]; }
  const Fixed& fixed(int face) const { return fixed_[ring_.closed() ? 0 : face]; }
  double rest(int face, int q) const { return dart_ ? dart_->rest(face, q) : rest_[q]; }

  /// How the tables of pair (m, plus) combine into the modes of that pair on a face: the number of
  /// a mode, and its factors of the cosine and of the sine table. parts() returns how many there
  /// are.
  struct Part {
    int mode;
    double cosine, sine;
  };
  int parts(int m, bool plus, int face, Part out[2]) const;
  /// Add the share of the spoke modes to projectTransposed(): sum by sum, and by the transform of
  /// rings with many faces.
  void addSpokesTransposed(const Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& ring) const;
  void transformSpokesTransposed(const Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& ring) const;
  int firstMode(int m) const { return 1 + fixedCount() + (rotates() ? 4 : 2) * (m - 1); }
  int spokeOf(int mode) const { return 1 + (mode - 1 - fixedCount()) / (rotates() ? 4 : 2); }

  Ring ring_;
  RingStep<double> step_;
  std::int64_t period_;  // of the tables cos_ and sin_
  std::vector<double> cos_, sin_;
  std::unique_ptr<const RingWaves> waves_;
  std::vector<double> lambda_;
  std::vector<Spoke> spokes_;  // by pairIndex
  std::vector<Chain> chains_;
  std::vector<ModePair> pairs_;
  std::vector<double> rest_;  // interior valence 2: what mode rest_mode_ feeds into outer modes
  int rest_mode_ = -1;
  std::vector<Fixed> fixed_;                 // one for a closed ring, one per face of a sector
  std::vector<double> curve_ring_[2];        // sectors: modes 1 and 2 on the ring
  Eigen::Matrix2d radial_, radial_inverse_;  // closed: modes 1 and 2 from mean e - v, f - v
  double radial_vertex_[2] = {0, 0};
  std::unique_ptr<FaceTables> face_tables_[4];
  std::unique_ptr<const DartModes> dart_;
};

}  // namespace limitsurf
