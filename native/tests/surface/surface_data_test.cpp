// SPDX-License-Identifier: Apache-2.0
//
// Data on the surface are those of the limit surfaces of derived control meshes, and linear where
// they should be.
#include "limitsurf/surface/surface_data.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "limitsurf/mesh/face_varying_mesh.h"
#include "limitsurf/parallel.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/throws.h"
#include "support/truth/channels.h"
#include "support/truth/deep_subdivision.h"
#include "support/truth/far_limit.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

NamedCages someCages() {
  return {{"grid", grid(4, 3)},      {"bow-tie", gridWithHoles(5, 5, {7, 13})},
          {"cross", cross()},        {"cube", cube()},
          {"prism", prism(5, true)}, {"closed fan", fan(5, true, 1)},
          {"hexagon", ngon(6, 1)},   {"mixture 1", mixture(1)},
          {"mixture 2", mixture(2)}};
}

/// A few locations on every face, including corners and edges.
std::vector<Location> everywhere(const LimitSurface& surface, std::uint64_t seed) {
  Random random(seed);
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(surface.baseFace()[face]) != 0) continue;
    at += anywhere(face, 6, random);
    at.push_back({face, 0, 0});
    at.push_back({face, 1, 0.25});
    at.push_back({face, 0x1p-9, 0x1p-11});
  }
  return at;
}

/// The control mesh whose positions are the values of a channel.
Cage channelCage(const Cage& cage, const Channel& channel, const DataRows& values,
                 Interpolation interpolation) {
  const ControlMesh mesh = controlMesh(cage);
  const FaceVaryingMesh derived =
      faceVaryingMesh(mesh, Topology(mesh), channel.indices, channel.value_count, interpolation);
  Cage result;
  result.options = derived.mesh.options();
  result.positions.resize(derived.mesh.vertexCount(), 3);
  for (int v = 0; v < derived.mesh.vertexCount(); ++v) {
    result.positions.row(v) = values.row(derived.values[v]);
  }
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const Span<int> vertices = derived.mesh.faceVertices(face);
    result.faces.emplace_back(vertices.begin(), vertices.end());
  }
  return result;
}

Points valuesOf(const DataRows& rows) { return rows; }

/// The bilinear function of the values at (0,0), (1,0), (1,1), (0,1), with its derivatives.
DataEvaluation bilinear(const std::array<Eigen::RowVectorXd, 4>& corners, const Location& at) {
  const double u = at.u, v = at.v;
  DataEvaluation result;
  result.value = (1 - u) * (1 - v) * corners[0] + u * (1 - v) * corners[1] + u * v * corners[2] +
                 (1 - u) * v * corners[3];
  result.du = (1 - v) * (corners[1] - corners[0]) + v * (corners[2] - corners[3]);
  result.dv = (1 - u) * (corners[3] - corners[0]) + u * (corners[2] - corners[1]);
  result.duv = corners[0] - corners[1] + corners[2] - corners[3];
  result.duu = result.dvv = 0 * result.duv;
  return result;
}

/// The values at a Ptex face's corners, linear between those of its face's corners.
std::array<Eigen::RowVectorXd, 4> ptexCorners(const PtexFace& face,
                                              const std::vector<Eigen::RowVectorXd>& corners) {
  if (face.quad) return {corners[0], corners[1], corners[2], corners[3]};
  const int n = static_cast<int>(corners.size()), i = face.corner;
  Eigen::RowVectorXd centre = corners[0];
  for (int j = 1; j < n; ++j) centre += corners[j];
  return {corners[i], (corners[i] + corners[(i + 1) % n]) / 2, centre / n,
          (corners[i] + corners[(i + n - 1) % n]) / 2};
}

/// `corner_rows`: the row of `values` at each corner of the cage's faces.
void expectBilinear(const std::string& name, const Cage& cage, const SurfaceData& data,
                    const DataRows& values, const std::vector<std::int64_t>& corner_rows) {
  constexpr double kRounding = 1e-14;
  std::vector<std::size_t> first = {0};
  for (const std::vector<int>& face : cage.faces) first.push_back(first.back() + face.size());
  const std::vector<PtexFace> ptex = ptexFaces(cage);
  const std::vector<Location> at = everywhere(limitSurface(cage), 5);
  const DataEvaluation got = data.evaluate(at, Derivatives::second);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const PtexFace& face = ptex[at[i].face];
    std::vector<Eigen::RowVectorXd> corners;
    for (std::size_t c = first[face.base_face]; c < first[face.base_face + 1]; ++c) {
      corners.push_back(values.row(corner_rows[c]));
    }
    const DataEvaluation truth = bilinear(ptexCorners(face, corners), at[i]);
    const auto row = static_cast<Eigen::Index>(i);
    const auto expectNear = [&](const DataRows& a, const DataRows& b, const char* what) {
      EXPECT_LE((a.row(row) - b.row(0)).cwiseAbs().maxCoeff(), kRounding)
          << name << ", " << what << " at " << describe(at[i]);
    };
    expectNear(got.value, truth.value, "value");
    expectNear(got.du, truth.du, "du");
    expectNear(got.dv, truth.dv, "dv");
    expectNear(got.duu, truth.duu, "duu");
    expectNear(got.duv, truth.duv, "duv");
    expectNear(got.dvv, truth.dvv, "dvv");
  }
}

void expectSame(const DataRows& a, const DataRows& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (std::isnan(a.data()[i]) && std::isnan(b.data()[i])) continue;
    ASSERT_EQ(a.data()[i], b.data()[i]) << "row " << i / a.cols();
  }
}

void expectSame(const DataEvaluation& a, const DataEvaluation& b) {
  expectSame(a.value, b.value);
  expectSame(a.du, b.du);
  expectSame(a.dv, b.dv);
  expectSame(a.duu, b.duu);
  expectSame(a.duv, b.duv);
  expectSame(a.dvv, b.dvv);
}

TEST(SurfaceData, FaceVaryingLimitsAreOpenSubdivs) {
  double worst = 0;
  for (auto& [name, cage] : someCages()) {
    Random random(name.size());
    const Channel channel = randomChannel(cage, random);
    const DataRows values = randomRows(channel.value_count, 3, random.bits());
    const LimitSurface surface = limitSurface(cage);
    for (const auto& [rule, interpolation] : kInterpolations) {
      const FarLimit far = farLimit(channelCage(cage, channel, values, interpolation), 3);
      const SurfaceData data = surface.faceVarying(values, channel.indices, interpolation);
      const DataRows got = data.evaluate(far.at).value;
      const double error = (valuesOf(got) - far.position).cwiseAbs().maxCoeff();
      worst = std::max(worst, error);
      EXPECT_LE(error, kPositionError) << name << ", " << rule;
    }
  }
  std::printf("  worst value %.2e\n", worst);
}

TEST(SurfaceData, FaceVaryingBesideSharpEdgesAgreesWithSubdivision) {
  Accuracy all("all channels", 1);
  for (auto& [name, cage] : someCages()) {
    Random random(name.size() + 7);
    sharpenAtRandom(cage, random, 5, 20, {0.7, 1, 2.5, 12});
    const Channel channel = randomChannel(cage, random);
    const DataRows values = randomRows(channel.value_count, 3, random.bits());
    const LimitSurface surface = limitSurface(cage);
    for (const auto& [rule, interpolation] : kInterpolations) {
      if (interpolation == Interpolation::all)
        continue;  // bilinear, which the witness does not support
      const Cage derived = channelCage(cage, channel, values, interpolation);
      std::vector<Location> at;
      for (int i = 0; i < 4; ++i) at += anywhere(random.below(surface.faceCount()), 3, random);
      compareWithSubdivision(name + ", " + rule, derived, at, all);
      const SurfaceData data = surface.faceVarying(values, channel.indices, interpolation);
      const LimitSurface derived_surface = limitSurface(derived);
      const Evaluation truth = derived_surface.evaluate(at, Derivatives::second);
      expectSame(data.evaluate(at, Derivatives::second),
                 {truth.position, truth.du, truth.dv, truth.duu, truth.duv, truth.dvv});
    }
  }
  std::printf("%s\n", all.summary().c_str());
}

TEST(SurfaceData, VertexDataAreEvaluatedAsPositionsAre) {
  for (auto& [name, cage] : someCages()) {
    Random random(1);
    sharpenAtRandom(cage, random, 6, 20, {0.7, 2.5, 12});
    const LimitSurface surface = limitSurface(cage);
    const SurfaceData data = surface.vertexData(cage.positions);
    const std::vector<Location> at = everywhere(surface, 1);
    for (Derivatives order : kOrders) {
      const Evaluation e = surface.evaluate(at, order);
      const auto like = [](const Points& points) {
        return points.rows() == 0 ? DataRows() : DataRows(points);
      };
      expectSame(data.evaluate(at, order),
                 {like(e.position), like(e.du), like(e.dv), like(e.duu), like(e.duv), like(e.dvv)});
    }
  }
}

TEST(SurfaceData, ColumnsHaveNothingToDoWithEachOther) {
  const Cage cage = mixture(3);
  Random random(2);
  const Channel channel = randomChannel(cage, random);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = everywhere(surface, 2);
  for (Eigen::Index columns : {1, 2, 3, 4, 5, 7}) {
    const DataRows values = randomRows(channel.value_count, columns, 3);
    const SurfaceData data =
        surface.faceVarying(values, channel.indices, Interpolation::corners_plus1);
    EXPECT_EQ(data.columns(), columns);
    EXPECT_EQ(data.rows(), channel.value_count);
    const DataEvaluation all = data.evaluate(at, Derivatives::first);
    for (Eigen::Index c = 0; c < columns; ++c) {
      const DataEvaluation one =
          surface.faceVarying(values.col(c), channel.indices, Interpolation::corners_plus1)
              .evaluate(at, Derivatives::first);
      expectSame(one.value, all.value.col(c));
      expectSame(one.du, all.du.col(c));
      expectSame(one.dv, all.dv.col(c));
    }
  }
}

TEST(SurfaceData, VaryingIsBilinear) {
  NamedCages cages = someCages();
  cages.emplace_back("pole", pole(7));
  for (const auto& cage : nonManifoldCages()) cages.push_back(cage);
  for (auto& [name, cage] : cages) {
    Random random(1);
    sharpenAtRandom(cage, random, 4, 10, {0.7, 12});
    const DataRows values = randomRows(cage.vertexCount(), 4, 1);
    std::vector<std::int64_t> corners;
    for (const std::vector<int>& face : cage.faces) {
      corners.insert(corners.end(), face.begin(), face.end());
    }
    expectBilinear(name, cage, limitSurface(cage).varying(values), values, corners);
    cage.options.scheme = Scheme::bilinear;
    expectBilinear(name, cage, limitSurface(cage).vertexData(values), values, corners);
  }
}

TEST(SurfaceData, LinearFaceVaryingIsBilinear) {
  NamedCages cages = someCages();
  for (const auto& cage : nonManifoldCages()) cages.push_back(cage);
  for (auto& [name, cage] : cages) {
    Random random(name.size());
    sharpenAtRandom(cage, random, 4, 10, {0.7, 12});
    cage.options.creasing = Creasing::chaikin;  // no edge is semi-sharp here
    const Channel channel = randomChannel(cage, random);
    const DataRows values = randomRows(channel.value_count, 2, 1);
    expectBilinear(name, cage,
                   limitSurface(cage).faceVarying(values, channel.indices, Interpolation::all),
                   values, channel.indices);
  }
}

TEST(SurfaceData, ConstantsStayConstant) {
  for (auto& [name, cage] : someCages()) {
    Random random(4);
    sharpenAtRandom(cage, random, 4, 10, {0.7, 2.5, 12});
    const LimitSurface surface = limitSurface(cage);
    const Channel channel = randomChannel(cage, random);
    const DataRows values = DataRows::Constant(channel.value_count, 2, 0.1);
    const std::vector<Location> at = everywhere(surface, 3);
    for (const auto& [rule, interpolation] : kInterpolations) {
      const DataRows got =
          surface.faceVarying(values, channel.indices, interpolation).evaluate(at).value;
      EXPECT_LE((got.array() - 0.1).abs().maxCoeff(), 1e-16) << name << ", " << rule;
    }
  }
}

TEST(SurfaceData, FacesWithoutASurfaceHaveNoData) {
  Cage cage = gridWithFace({0, 1, 2, 1});
  cage.options.holes = {0};
  const LimitSurface surface = limitSurface(cage);
  ASSERT_EQ(surface.refused().size(), 2u);
  Random random(1);
  const Channel channel = chartChannel(cage, 2, random);
  std::vector<SurfaceData> all;
  for (const auto& [rule, interpolation] : kInterpolations) {
    all.push_back(
        surface.faceVarying(randomRows(channel.value_count, 2, 1), channel.indices, interpolation));
  }
  all.push_back(surface.vertexData(cage.positions));
  all.push_back(surface.varying(cage.positions));
  for (const SurfaceData& data : all) {
    for (const auto& [face, reason] : surface.refused()) {
      const std::vector<Location> at = {{3, 0.5, 0.5}, {face, 0.5, 0.5}};
      expectThrow<MeshError>([&] { data.evaluate(at); },
                             {"row 1", "face " + std::to_string(face), reason});
      expectThrow<MeshError>([&] { data.checkLocations(at); }, {"row 1"});
    }
    EXPECT_TRUE(data.evaluate(everywhere(surface, 4)).value.allFinite());
  }
}

TEST(SurfaceData, LocationsOutsideAreErrors) {
  const LimitSurface surface = limitSurface(cross());
  const SurfaceData data = surface.varying(cross().positions);
  EXPECT_EQ(data.faceCount(), 5);
  const auto evaluate = [&](const Location& bad) {
    data.evaluate(std::vector<Location>{{0, 0, 0}, bad});
  };
  expectThrow<LocationError>([&] { evaluate({5, 0, 0}); }, {"row 1", "face 5", "5 Ptex faces"});
  expectThrow<LocationError>([&] { evaluate({0, -0.25, 0}); }, {"row 1", "-0.25"});
  expectThrow<LocationError>([&] { evaluate({0, std::nan(""), 0}); }, {"row 1", "nan"});
  EXPECT_THROW(data.evaluate({}, Derivatives::none, -1), std::invalid_argument);
  EXPECT_EQ(data.evaluate({}).value.rows(), 0);
  EXPECT_EQ(data.evaluate({}).value.cols(), 3);
}

TEST(SurfaceData, ValuesAreChecked) {
  const Cage cage = cross();
  const LimitSurface surface = limitSurface(cage);
  DataRows values = randomRows(12, 2, 1);
  values(7, 1) = std::numeric_limits<double>::infinity();
  const auto make = [&](int how) {
    if (how == 0) surface.vertexData(values);
    if (how == 1) surface.varying(values);
    if (how == 2) {
      std::vector<std::int64_t> corners(20, 3);
      surface.faceVarying(values, corners, Interpolation::none);
    }
  };
  for (int how = 0; how < 3; ++how) {
    expectThrow<MeshError>([&] { make(how); }, {"row 7", "inf", "column 1"});
  }
  values(7, 1) = -1.7e308;  // sums with other values would overflow
  for (int how = 0; how < 3; ++how) {
    expectThrow<MeshError>([&] { make(how); }, {"row 7", "-1.7e+308", "at most 2.58"});
  }
  values(7, 1) = -kLargestCoordinate;
  for (int how = 0; how < 3; ++how) make(how);
  values.resize(12, 0);
  for (int how = 0; how < 3; ++how) expectThrow<MeshError>([&] { make(how); }, {"no columns"});
  values = randomRows(11, 2, 1);
  for (int how = 0; how < 2; ++how) {
    expectThrow<MeshError>([&] { make(how); }, {"11 rows", "12 vertices"});
  }
  EXPECT_THROW(surface.vertexData(cage.positions, -1), std::invalid_argument);
}

TEST(SurfaceData, ValuesCanBeSetAgain) {
  const Cage cage = mixture(4);
  Random random(6);
  const Channel channel = randomChannel(cage, random);
  const DataRows before = randomRows(channel.value_count, 4, 1),
                 after = randomRows(channel.value_count, 4, 2);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = everywhere(surface, 5);
  SurfaceData data = surface.faceVarying(before, channel.indices, Interpolation::none);
  const SurfaceData truth = surface.faceVarying(after, channel.indices, Interpolation::none);
  DataRows bad = after;
  bad(2, 3) = std::nan("");
  const DataEvaluation first = data.evaluate(at, Derivatives::second);
  expectThrow<MeshError>([&] { data.setValues(bad); }, {"row 2", "nan"});
  expectThrow<MeshError>([&] { data.setValues(after.leftCols(3)); }, {", 3)", ", 4)"});
  expectSame(data.evaluate(at, Derivatives::second), first);
  data.setValues(after);
  expectSame(data.evaluate(at, Derivatives::second), truth.evaluate(at, Derivatives::second));
}

TEST(SurfaceData, OutlivesTheSurface) {
  const Cage cage = cube();
  std::vector<Location> at = {{2, 0.3, 0.4}, {5, 0, 0}};
  DataRows truth;
  const auto make = [&] {
    const LimitSurface surface = limitSurface(cage);
    truth = surface.evaluate(at).position;
    return surface.vertexData(cage.positions);
  };
  const SurfaceData data = make();
  expectSame(data.evaluate(at).value, truth);
}

TEST(SurfaceData, ThreadsDoNotMatter) {
  const Cage cage = mixture(5);
  const LimitSurface surface = limitSurface(cage);
  const SurfaceData data = surface.vertexData(randomRows(cage.vertexCount(), 5, 1));
  Random random(1);
  std::vector<Location> at;
  while (at.size() < 40000) at += anywhere(random.below(surface.faceCount()), 10, random);
  const DataEvaluation one = data.evaluate(at, Derivatives::second, 1);
  for (int threads : {0, 2, 3}) {
    expectSame(data.evaluate(at, Derivatives::second, threads), one);
  }
}

TEST(SurfaceData, EvaluationsCanBeInterrupted) {
  const LimitSurface surface = limitSurface(cube());
  const SurfaceData data = surface.varying(cube().positions);
  const std::vector<Location> at(100000, Location{1, 0.5, 0.5});
  struct Interrupted {};
  const InterruptionPoint point([] { throw Interrupted(); });
  EXPECT_THROW(data.evaluate(at), Interrupted);
}

}  // namespace
}  // namespace limitsurf::test
