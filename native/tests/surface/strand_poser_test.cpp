// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_poser.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/error.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/throws.h"
#include "support/truth/decompositions.h"
#include "support/truth/golden.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

using Frame = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Matrix4d turnedAndMoved() {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.translate(Vector3(0.3, -2, 1)).rotate(Eigen::AngleAxisd(0.8, Vector3(1, 2, -1).normalized()));
  return map.matrix();
}

Eigen::Matrix4d stretched() {
  return turnedAndMoved() * Eigen::Vector4d(1.5, 0.75, 3, 1).asDiagonal();
}

Eigen::Matrix4d mirrored() { return stretched() * Eigen::Vector4d(1, -1, 1, 1).asDiagonal(); }

double condition(const Eigen::Matrix4d& map) {
  const Eigen::Vector3d values = singularValues(Eigen::Matrix3d(map.topLeftCorner<3, 3>()));
  return values[0] / values[2];
}

/// Positions and frames of all locations, carried by the map as the header of StrandPoser says.
struct Roots {
  Roots(const LimitSurface& surface, const std::vector<Location>& at, const Eigen::Matrix4d& map) {
    const Evaluation e = surface.evaluate(at);
    const auto frames = surface.frames(at);
    const Eigen::Matrix3d linear = map.topLeftCorner<3, 3>();
    for (Eigen::Index row = 0; row < e.position.rows(); ++row) {
      const Frame on_surface = Eigen::Map<const Frame>(frames.data() + 9 * row);
      const Vector3 tangent = (linear * on_surface.col(0)).normalized(),
                    normal = (linear.inverse().transpose() * on_surface.col(2)).normalized();
      Frame carried;
      carried << tangent, normal.cross(tangent), normal;
      frame.push_back(carried);
      position.push_back(linear * e.position.row(row).transpose() + map.topRightCorner<3, 1>());
    }
  }
  std::vector<Vector3> position;
  std::vector<Frame> frame;
};

/// Strands of 0 to 4 points with random shapes, roots and rest rotations of random length; every
/// seventh is not bound, and has a location that does not exist.
struct Strands {
  Strands(const std::vector<Location>& locations, std::uint64_t seed) : at(locations) {
    Random random(seed);
    const auto count = static_cast<Eigen::Index>(at.size());
    roots.resize(count, 3);
    rotations.resize(count, 4);
    for (Eigen::Index row = 0; row < count; ++row) {
      roots.row(row) = random.vector(2).cast<float>().transpose();
      const Vector3 axis = random.vector(1);
      rotations.row(row) << static_cast<float>(random.uniform(-1, 1)),
          axis.cast<float>().transpose();
      if (row % 7 == 3) {
        rotations.row(row).setZero();
        roots.row(row).setConstant(std::numeric_limits<float>::quiet_NaN());
        at[static_cast<std::size_t>(row)] = {-1, 2, NAN};
      }
      offsets.push_back(offsets.back() + random.below(5));
    }
    points.resize(static_cast<Eigen::Index>(offsets.back()), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      points.row(i) = random.vector(3).cast<float>().transpose();
    }
  }
  bool isBound(std::size_t row) const { return row % 7 != 3; }
  StrandPoser on(const LimitSurface& surface) const {
    return StrandPoser(surface, at, roots, rotations, offsets);
  }
  Eigen::Matrix3d rest(std::size_t row) const {
    const Eigen::Vector4d q = rotations.row(static_cast<Eigen::Index>(row)).cast<double>();
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }

  std::vector<Location> at;
  FloatPoints roots, points;
  FloatRotations rotations;
  std::vector<std::int64_t> offsets{0};
};

/// The largest error in units of what is allowed.
double worstError(const LimitSurface& surface, const std::vector<Location>& everywhere,
                  const Strands& strands, const FloatPoints& posed, const Eigen::Matrix4d& map) {
  const Roots now(surface, everywhere, map);
  const Eigen::Matrix3d linear = map.topLeftCorner<3, 3>();
  const double size = diagonal(Points(surface.positions() * linear.transpose()));
  double worst = 0;
  for (std::size_t row = 0; row < everywhere.size(); ++row) {
    for (std::int64_t i = strands.offsets[row]; i < strands.offsets[row + 1]; ++i) {
      if (!strands.isBound(row)) {
        worst = std::max(worst, posed.row(i) == strands.points.row(i) ? 0. : HUGE_VAL);
        continue;
      }
      const Vector3 offset = (strands.points.row(i).cast<double>() -
                              strands.roots.row(static_cast<Eigen::Index>(row)).cast<double>())
                                 .transpose();
      const Vector3 expected =
          now.position[row] + now.frame[row] * strands.rest(row).transpose() * offset;
      const double allowed = kStrandError * condition(map) * (size + offset.norm()) +
                             0x1p-24 * expected.cwiseAbs().maxCoeff();
      const Vector3 got = posed.row(i).cast<double>().transpose();
      worst = std::max(worst, (got - expected).cwiseAbs().maxCoeff() / allowed);
    }
  }
  return worst;
}

class StrandPoserOn : public testing::TestWithParam<std::string> {};

TEST_P(StrandPoserOn, GivesWhatPositionsAndFramesGive) {
  const Golden golden = readGolden(GetParam());
  LimitSurface surface = limitSurface(golden.cage);
  const Strands strands(golden.at, 1);
  LimitSurface elsewhere = limitSurface(golden.cage);
  elsewhere.setPositions((golden.cage.positions.array() * 3 + 1).matrix());
  const StrandPoser poser = strands.on(surface), unposed = strands.on(elsewhere);
  FloatPoints posed(strands.points.rows(), 3);
  const Points bent = perturbed(golden.cage, 0.05 * diagonal(golden.cage.positions), 2).positions;
  for (const Points& positions : {golden.cage.positions, bent}) {
    surface.setPositions(positions);
    const RowsIn<Points> control_points = positions;
    for (const Eigen::Matrix4d& map : {Eigen::Matrix4d(Eigen::Matrix4d::Identity()),
                                       turnedAndMoved(), stretched(), mirrored()}) {
      poser.pose(strands.points, posed, map);
      EXPECT_LE(worstError(surface, golden.at, strands, posed, map), 1);
      posed.setZero();
      unposed.pose(strands.points, posed, map, 0, &control_points);
      EXPECT_LE(worstError(surface, golden.at, strands, posed, map), 1);
    }
  }
}

std::string testName(const testing::TestParamInfo<std::string>& golden) {
  std::string name = golden.param;
  std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Golden, StrandPoserOn, testing::ValuesIn(goldenNames()), testName);

std::vector<Location> locationsOn(const Cage& cage, std::uint64_t seed) {
  Random random(seed);
  return everywhere(cage, {3, 10, 30}, 5, random);
}

TEST(StrandPoser, AtRestNothingMoves) {
  const Cage cage = mixture(3);
  const LimitSurface surface = limitSurface(cage);
  Strands strands(locationsOn(cage, 1), 2);
  const Roots rest(surface, locationsOn(cage, 1), mirrored());
  for (std::size_t row = 0; row < strands.at.size(); ++row) {
    if (strands.isBound(row)) {
      const auto r = static_cast<Eigen::Index>(row);
      const Eigen::Quaterniond q{Eigen::Matrix3d(rest.frame[row])};
      strands.roots.row(r) = rest.position[row].cast<float>().transpose();
      strands.rotations.row(r) = Eigen::RowVector4d(q.w(), q.x(), q.y(), q.z()).cast<float>();
    }
  }
  FloatPoints posed = strands.points;
  strands.on(surface).pose(posed, posed, mirrored());
  EXPECT_LE((posed - strands.points).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(StrandPoser, ReposingIsPosingInPlace) {
  const Cage cage = cross();
  const LimitSurface surface = limitSurface(cage);
  const Strands strands(locationsOn(cage, 1), 8);
  const StrandPoser poser = strands.on(surface);
  const Eigen::Matrix4d map = stretched();
  FloatPoints posed(strands.points.rows(), 3), points = strands.points;
  poser.pose(strands.points, posed, map);
  for (const bool is_first : {true, false}) {
    const StrandPoser::Reposed reposed = poser.repose(strands.points, points, map);
    EXPECT_EQ(reposed.has_changed, is_first);
    EXPECT_EQ(points, posed);
    EXPECT_EQ(reposed.fingerprints, poser.fingerprints(posed));
  }

  // One bit of a bound strand is a change, and so is one of a strand that is not bound.
  int edited[2] = {0, 0};
  for (std::size_t row = 0; row < strands.at.size(); ++row) {
    const std::int64_t last = strands.offsets[row + 1] - 1;
    if (strands.offsets[row] > last) continue;
    points(last, 1) = std::nextafter(points(last, 1), 100.F);
    EXPECT_TRUE(poser.repose(strands.points, points, map, 1).has_changed) << "strand " << row;
    EXPECT_EQ(points, posed) << "strand " << row;
    ++edited[strands.isBound(row)];
  }
  EXPECT_GT(std::min(edited[0], edited[1]), 3);
}

TEST(StrandPoser, UnposeIsTheInverse) {
  const Cage cage = mixture(4);
  const LimitSurface surface = limitSurface(cage);
  const Strands strands(locationsOn(cage, 1), 3);
  const StrandPoser poser = strands.on(surface);
  FloatPoints posed(strands.points.rows(), 3), back(strands.points.rows(), 3);
  poser.pose(strands.points, posed, stretched());
  poser.unpose(posed, back, stretched());
  const float size = posed.cwiseAbs().maxCoeff() + strands.points.cwiseAbs().maxCoeff();
  EXPECT_LE((back - strands.points).cwiseAbs().maxCoeff(), 4 * size * 0x1p-24F);
}

TEST(StrandPoser, UnposesOnlyTheStrandsThatAreAskedFor) {
  const Cage cage = cross();
  const LimitSurface surface = limitSurface(cage);
  const Strands strands(locationsOn(cage, 1), 4);
  const StrandPoser poser = strands.on(surface);
  std::vector<char> only(strands.at.size());
  for (std::size_t row = 0; row < only.size(); row += 3) only[row] = 1;
  const FloatPoints before = FloatPoints::Constant(strands.points.rows(), 3, 7);
  FloatPoints all(before.rows(), 3), some = before;
  poser.unpose(strands.points, all);
  poser.unpose(strands.points, some, Eigen::Matrix4d::Identity(), only);
  for (std::size_t row = 0; row < only.size(); ++row) {
    const FloatPoints& expected = only[row] ? all : before;
    for (std::int64_t i = strands.offsets[row]; i < strands.offsets[row + 1]; ++i) {
      EXPECT_EQ(some.row(i), expected.row(i)) << "strand " << row;
    }
  }
}

TEST(StrandPoser, VectorsAndRotationsTurnWithTheStrand) {
  const Cage cage = cube();
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = locationsOn(cage, 5);
  const auto count = static_cast<Eigen::Index>(at.size());
  const Strands bound(at, 5);
  const StrandPoser poser(surface, bound.at, bound.roots, bound.rotations);
  EXPECT_EQ(poser.pointCount(), count);
  FloatPoints vectors(count, 3), turned(count, 3);
  FloatRotations rotations(count, 4), posed(count, 4);
  Random random(6);
  for (Eigen::Index row = 0; row < count; ++row) {
    vectors.row(row) = random.vector(1).cast<float>().transpose();
    rotations.row(row) << static_cast<float>(random.uniform(-1, 1)),
        random.vector(1).cast<float>().transpose();
  }
  rotations.row(0).setZero();
  poser.poseVectors(vectors, turned, mirrored());
  poser.poseRotations(rotations, posed, mirrored());
  const Roots now(surface, at, mirrored());
  const auto matrix = [](const Eigen::RowVector4f& row) -> Eigen::Matrix3d {
    const Eigen::Vector4d q = row.cast<double>().transpose();
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  };
  EXPECT_TRUE(posed.row(0).isZero(0));
  for (Eigen::Index row = 1; row < count; ++row) {
    const auto r = static_cast<std::size_t>(row);
    if (!bound.isBound(r)) {
      EXPECT_EQ(turned.row(row), vectors.row(row));
      EXPECT_EQ(posed.row(row), rotations.row(row));
      continue;
    }
    const Eigen::Matrix3d turn = now.frame[r] * bound.rest(r).transpose();
    const Vector3 vector = turn * vectors.row(row).cast<double>().transpose();
    EXPECT_LE((turned.row(row).cast<double>().transpose() - vector).norm(), 1e-6);
    EXPECT_LE((matrix(posed.row(row)) - turn * matrix(rotations.row(row))).norm(), 1e-6);
    EXPECT_NEAR(posed.row(row).norm(), 1, 1e-6);
    EXPECT_GE(posed(row, 0), 0);
  }
}

TEST(StrandPoser, TheFrameIsARotationWhereTheMatrixFlattensTheSurface) {
  const Cage cage = grid(3, 3);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = locationsOn(cage, 7);
  const auto count = static_cast<Eigen::Index>(at.size());
  const StrandPoser poser(surface, at, FloatPoints::Zero(count, 3),
                          Eigen::RowVector4f(1, 0, 0, 0).replicate(count, 1));
  FloatPoints axes[3];
  for (int axis = 0; axis < 3; ++axis) {
    axes[axis].resize(count, 3);
    const Eigen::RowVector3f unit = Eigen::RowVector3f::Unit(axis);
    poser.poseVectors(unit.replicate(count, 1), axes[axis],
                      Eigen::Vector4d(1, 0, 1, 1).asDiagonal().toDenseMatrix());
  }
  for (Eigen::Index row = 0; row < count; ++row) {
    Eigen::Matrix3f frame;
    frame << axes[0].row(row).transpose(), axes[1].row(row).transpose(),
        axes[2].row(row).transpose();
    EXPECT_LE((frame.transpose() * frame - Eigen::Matrix3f::Identity()).norm(), 1e-6F);
    EXPECT_NEAR(frame.determinant(), 1, 1e-6);
  }
}

TEST(StrandPoser, BitsDependOnNothingElseInTheBatch) {
  const Cage cage = perturbed(gridWithHoles(12, 12, {40, 77}), 0.2, 1);
  const LimitSurface surface = limitSurface(cage);
  std::vector<Location> at;
  Random random(8);
  for (int round = 0; round < 40; ++round) at += locationsOn(cage, 100 + round);
  const Strands strands(at, 9);
  const StrandPoser poser = strands.on(surface);
  FloatPoints expected(strands.points.rows(), 3), posed(strands.points.rows(), 3);
  poser.pose(strands.points, expected, stretched());
  for (const int threads : {1, 2, 3}) {
    posed.setZero();
    poser.pose(strands.points, posed, stretched(), threads);
    EXPECT_TRUE(posed == expected) << threads << " threads";
  }
  FloatPoints in_place = strands.points;
  poser.pose(in_place, in_place, stretched());
  EXPECT_TRUE(in_place == expected);
  for (int round = 0; round < 20; ++round) {
    const auto row = static_cast<std::size_t>(random.below(static_cast<int>(at.size())));
    const auto r = static_cast<Eigen::Index>(row);
    const std::int64_t first = strands.offsets[row], count = strands.offsets[row + 1] - first;
    const StrandPoser one(surface, Span<Location>(&strands.at[row], 1), strands.roots.row(r),
                          strands.rotations.row(r), {0, count});
    FloatPoints alone(count, 3);
    one.pose(strands.points.middleRows(first, count), alone, stretched());
    EXPECT_TRUE(alone == expected.middleRows(first, count)) << "strand " << row;
  }
}

/// What all calls give for one pose: with control points, or for the surface in its pose.
struct AllCalls {
  AllCalls(const StrandPoser& poser, const Strands& strands, const Eigen::Matrix4d& map,
           int threads, const RowsIn<Points>* control_points)
      : points(strands.points), posed(points), unposed(points), vectors(points) {
    poser.pose(points, posed, map, threads, control_points);
    reposed = poser.repose(strands.points, points, map, threads, control_points);
    poser.unpose(strands.points, unposed, map, {}, threads, control_points);
    poser.poseVectors(strands.points, vectors, map, threads, control_points);
    FloatRotations rest = FloatRotations::Ones(points.rows(), 4);
    rest.leftCols<3>() = strands.points;
    rotations = rest;
    poser.poseRotations(rest, rotations, map, threads, control_points);
  }
  bool operator==(const AllCalls& other) const {
    return points == other.points && posed == other.posed && unposed == other.unposed &&
           vectors == other.vectors && rotations == other.rotations &&
           reposed.fingerprints == other.reposed.fingerprints;
  }

  FloatPoints points, posed, unposed, vectors;
  FloatRotations rotations;
  StrandPoser::Reposed reposed;
};

TEST(StrandPoser, ControlPointsGiveWhatASurfaceInThatPoseGives) {
  const Cage cage = perturbed(gridWithHoles(12, 12, {40, 77}), 0.2, 1);
  LimitSurface surface = limitSurface(cage);
  std::vector<Location> at;
  for (int round = 0; round < 40; ++round) at += locationsOn(cage, 100 + round);
  const Strands strands(at, 9);
  const StrandPoser poser = strands.on(surface);
  const Points positions = perturbed(cage, 0.3, 5).positions;
  const RowsIn<Points> control_points = positions;
  const AllCalls found(poser, strands, mirrored(), 1, &control_points);
  for (const int threads : {2, 3}) {
    EXPECT_TRUE(AllCalls(poser, strands, mirrored(), threads, &control_points) == found) << threads;
  }
  EXPECT_TRUE(found.reposed.has_changed);
  FloatPoints again = found.points;
  EXPECT_FALSE(poser.repose(strands.points, again, mirrored(), 0, &control_points).has_changed);
  EXPECT_EQ(found.points, found.posed);
  EXPECT_EQ(found.reposed.fingerprints, poser.fingerprints(found.posed));

  surface.setPositions(positions);
  const AllCalls expected(poser, strands, mirrored(), 0, nullptr);
  EXPECT_LE((found.posed - expected.posed).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_LE((found.unposed - expected.unposed).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_LE((found.vectors - expected.vectors).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_LE((found.rotations - expected.rotations).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_GT((found.unposed - strands.points).cwiseAbs().maxCoeff(), 0.1);
}

// Where derivatives vanish or are parallel, frames are completed as those of a surface are.
TEST(StrandPoser, ControlPointsMayBeFlattened) {
  const Cage cage = mixture(5);
  LimitSurface surface = limitSurface(cage);
  const Strands strands(locationsOn(cage, 1), 2);
  const StrandPoser poser = strands.on(surface);
  const Points& before = cage.positions;
  const Vector3 line(0.3, 0.7, 0.11);
  for (const Points& positions :
       {Points(before.col(0) * line.transpose()), Points(Points::Ones(before.rows(), 3)),
        Points(before * Eigen::Vector3d(1, 1, 1e-9).asDiagonal())}) {
    const RowsIn<Points> control_points = positions;
    const AllCalls found(poser, strands, stretched(), 0, &control_points);
    LimitSurface posed = limitSurface(cage);
    posed.setPositions(positions);
    const StrandPoser on_posed = strands.on(posed);
    const AllCalls expected(on_posed, strands, stretched(), 0, nullptr);
    EXPECT_LE((found.posed - expected.posed).cwiseAbs().maxCoeff(), 4e-6);
    EXPECT_LE((found.vectors - expected.vectors).cwiseAbs().maxCoeff(), 4e-6);
  }
}

TEST(StrandPoser, ControlPointsAreChecked) {
  const Cage cage = cross();
  const LimitSurface surface = limitSurface(cage);
  const Strands strands(locationsOn(cage, 1), 2);
  const StrandPoser poser = strands.on(surface);
  FloatPoints posed = strands.points;
  Points positions = cage.positions;
  positions(3, 1) = NAN;
  const auto refuses = [&](const Points& rows, const std::string& part) {
    const RowsIn<Points> control_points = rows;
    try {
      poser.pose(strands.points, posed, Eigen::Matrix4d::Identity(), 0, &control_points);
      ADD_FAILURE() << "not refused";
    } catch (const MeshError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refuses(positions, "3");
  refuses(cage.positions.topRows(4), "4");
  EXPECT_EQ(posed, strands.points);
}

TEST(StrandPoser, EmptyBatches) {
  const LimitSurface surface = limitSurface(cross());
  const StrandPoser nothing(surface, {}, FloatPoints(0, 3), FloatRotations(0, 4));
  FloatPoints none(0, 3);
  nothing.pose(none, none);
  const RowsIn<Points> control_points = surface.positions();
  nothing.pose(none, none, Eigen::Matrix4d::Identity(), 0, &control_points);
  EXPECT_EQ(nothing.size(), 0U);
  EXPECT_TRUE(nothing.fingerprints(none).empty());

  const std::vector<Location> at = {{0, 0.5, 0.5}, {-5, 0, 0}};
  const StrandPoser pointless(surface, at, FloatPoints::Zero(2, 3), FloatRotations::Zero(2, 4),
                              {0, 0, 0});
  pointless.pose(none, none);
  EXPECT_EQ(pointless.size(), 2U);
  EXPECT_EQ(pointless.boundCount(), 0U);
  EXPECT_EQ(pointless.pointCount(), 0);
}

TEST(StrandPoser, FingerprintsTellWhichStrandsWereEdited) {
  const Cage cage = cross();
  const LimitSurface surface = limitSurface(cage);
  Strands strands(locationsOn(cage, 1), 10);
  const StrandPoser poser = strands.on(surface);
  const std::vector<std::int32_t> before = poser.fingerprints(strands.points);
  EXPECT_EQ(poser.fingerprints(strands.points, 1), before);
  EXPECT_EQ(std::count(before.begin(), before.end(), 0), 0);
  std::set<std::int32_t> different;
  std::size_t with_points = 0;
  for (std::size_t row = 0; row < strands.at.size(); ++row) {
    if (strands.offsets[row] < strands.offsets[row + 1]) {
      different.insert(before[row]);
      ++with_points;
    }
  }
  EXPECT_EQ(different.size(), with_points);
  for (std::size_t row = 0; row < strands.at.size(); row += 5) {
    if (strands.offsets[row] == strands.offsets[row + 1]) continue;
    float& edited = strands.points(strands.offsets[row + 1] - 1, 2);
    edited = std::nextafter(edited, 10.F);
    std::vector<std::int32_t> after = poser.fingerprints(strands.points);
    EXPECT_NE(after[row], before[row]) << "strand " << row;
    after[row] = before[row];
    EXPECT_EQ(after, before);
    edited = std::nextafter(edited, -10.F);
  }
}

TEST(StrandPoser, BadInputIsNamed) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = {{0, 0.5, 0.5}, {1, 0.25, 0.5}, {2, 0, 0}};
  FloatPoints roots = FloatPoints::Zero(3, 3);
  FloatRotations rotations = Eigen::RowVector4f(1, 0, 0, 0).replicate(3, 1);
  const auto make = [&](const std::vector<Location>& locations,
                        const std::vector<std::int64_t>& offsets = {}, int threads = 0) {
    return StrandPoser(surface, locations, roots, rotations, offsets, threads);
  };
  using Invalid = std::invalid_argument;
  expectThrow<LocationError>([&] { make({at[0], {99, 0, 0}, at[2]}); }, {"row 1", "99"});
  expectThrow<LocationError>([&] { make({at[0], at[1], {0, 1.5, 0}}); }, {"row 2", "1.5"});
  expectThrow<Invalid>([&] { make({at[0], at[1]}); }, {"rest_roots", "3 rows", "2"});
  expectThrow<Invalid>([&] { make(at, {0, 1, 2}); }, {"3 offsets", "3 strands", "4"});
  expectThrow<Invalid>([&] { make(at, {1, 2, 3, 4}); }, {"offsets[0] is 1"});
  expectThrow<Invalid>([&] { make(at, {0, 5, 4, 6}); }, {"offsets[2] is 4", "5"});
  expectThrow<Invalid>([&] { make(at, {}, -1); }, {"threads is -1"});
  roots(1, 2) = INFINITY;
  expectThrow<Invalid>([&] { make(at); }, {"row 1", "rest_roots", "inf"});
  roots.setZero();
  rotations(2, 0) = NAN;
  expectThrow<Invalid>([&] { make(at); }, {"row 2", "rest_rotations", "nan"});

  rotations.row(2).setZero();
  const StrandPoser poser = make(at, {0, 1, 3, 3});
  FloatPoints three = FloatPoints::Zero(3, 3), two = FloatPoints::Zero(2, 3);
  expectThrow<Invalid>([&] { poser.pose(two, three); }, {"rest_points", "2 rows", "3"});
  expectThrow<Invalid>([&] { poser.pose(three, two); }, {"posed", "2 rows", "3"});
  expectThrow<Invalid>([&] { poser.unpose(two, three); }, {"points", "2 rows", "3"});
  expectThrow<Invalid>([&] { poser.fingerprints(two); }, {"points", "2 rows", "3"});
  expectThrow<Invalid>([&] { poser.repose(two, three); }, {"rest_points", "2 rows", "3"});
  expectThrow<Invalid>([&] { poser.repose(three, two); }, {"points", "2 rows", "3"});
  expectThrow<Invalid>([&] { poser.unpose(three, three, Eigen::Matrix4d::Identity(), {1, 0}); },
                       {"only", "2 rows", "3"});
  Eigen::Matrix4d map = Eigen::Matrix4d::Identity();
  map(1, 3) = NAN;
  expectThrow<Invalid>([&] { poser.pose(three, three, map); }, {"nan", "row 1, column 3"});
  map = Eigen::Matrix4d::Identity();
  map(3, 0) = 0.5;
  expectThrow<Invalid>([&] { poser.pose(three, three, map); }, {"0.5", "row 3, column 0"});
}

TEST(StrandPoser, RefusedFacesAreNamedUnlessTheStrandIsNotBound) {
  Cage cage = grid(2, 1);
  cage.options.holes = {1};
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = {{0, 0.5, 0.5}, {1, 0.5, 0.5}};
  FloatRotations rotations = Eigen::RowVector4f(1, 0, 0, 0).replicate(2, 1);
  expectThrow<MeshError>([&] { StrandPoser(surface, at, FloatPoints::Zero(2, 3), rotations); },
                         {"row 1", "face 1"});
  rotations.row(1).setZero();
  EXPECT_EQ(StrandPoser(surface, at, FloatPoints::Zero(2, 3), rotations).boundCount(), 1U);
}

}  // namespace
}  // namespace limitsurf::test
