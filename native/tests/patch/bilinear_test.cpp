// SPDX-License-Identifier: Apache-2.0
//
// The bilinear scheme: quads and the sub-faces of n-gons are bilinear patches of their corners.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/tessellate/tessellation.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/throws.h"
#include "support/truth/far_limit.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

Cage bilinear(Cage cage) {
  cage.options.scheme = Scheme::bilinear;
  return cage;
}

/// The four corners of each Ptex face.
std::vector<std::array<Vector3, 4>> patches(const Cage& cage) {
  std::vector<std::array<Vector3, 4>> result;
  for (const PtexFace& ptex : ptexFaces(cage)) {
    const std::vector<int>& face = cage.faces[ptex.base_face];
    const int n = static_cast<int>(face.size());
    const auto at = [&](int corner) -> Vector3 { return cage.positions.row(face[corner % n]); };
    if (ptex.quad) {
      result.push_back({at(0), at(1), at(2), at(3)});
      continue;
    }
    Vector3 centre = Vector3::Zero();
    for (int corner = 0; corner < n; ++corner) centre += at(corner) / n;
    const Vector3 here = at(ptex.corner), next = at(ptex.corner + 1),
                  previous = at(ptex.corner + n - 1);
    result.push_back({here, (here + next) / 2, centre, (previous + here) / 2});
  }
  return result;
}

Truth patchAt(const std::array<Vector3, 4>& p, double u, double v) {
  const Vector3 du = (1 - v) * (p[1] - p[0]) + v * (p[2] - p[3]);
  const Vector3 dv = (1 - u) * (p[3] - p[0]) + u * (p[2] - p[1]);
  const Vector3 position = (1 - v) * ((1 - u) * p[0] + u * p[1]) + v * ((1 - u) * p[3] + u * p[2]);
  const Vector3 duv = p[0] - p[1] + p[2] - p[3], zero = Vector3::Zero();
  return {{position, du, dv, zero, duv, zero, du.cross(dv).normalized()}};
}

/// Errors of second derivatives that are 0 are relative to the size of the patch.
void expectPatches(const std::string& name, const Cage& cage, const std::vector<Location>& at) {
  const LimitSurface surface = limitSurface(cage);
  const std::vector<std::array<Vector3, 4>> patch = patches(cage);
  const double size = diagonal(cage.positions);
  for (const Derivatives order : kOrders) {
    const Evaluation evaluation = surface.evaluate(at, order, order != Derivatives::none);
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      const Truth truth = upTo(order, patchAt(patch[at[i].face], at[i].u, at[i].v));
      const Truth got = rowOf(evaluation, i);
      for (int q = 0; q < kNormal; ++q) {
        if (truth[q].hasNaN()) continue;
        EXPECT_LE((got[q] - truth[q]).norm(), 4e-15 * size)
            << name << ", " << describe(at[i]) << ": " << kQuantityNames[q];
      }
      if (order != Derivatives::none) {
        EXPECT_LE(angle(got[kNormal], truth[kNormal]), 1e-13) << name << ", " << describe(at[i]);
      }
    }
  }
}

TEST(Bilinear, FacesArePatchesOfTheirCorners) {
  Random random(1);
  for (const Cage& plain :
       {cross(), perturbed(cube(), 0.2, 1), perturbed(tetrahedron(), 0.2, 2), fan(7, true, 3),
        fan(5, false, 4), perturbed(valenceTwo(), 0.1, 5), ngon(9, 6), mixture(1), mixture(2)}) {
    Cage cage = bilinear(plain);
    expectPatches("plain", cage, everywhere(cage, {1, 9, 40}, 4, random));
    cage.options.boundary = Boundary::corners;
    cage.options.triangles = Triangles::smooth;
    sharpenAtRandom(cage, random, 2, 2, {0.5, 3, 10});
    expectPatches("with options that do not matter", cage, everywhere(cage, {1, 40}, 2, random));
  }
}

TEST(Bilinear, AgreesWithOpenSubdiv) {
  for (const auto& [name, plain] : nonManifoldCages()) {
    const Cage cage = bilinear(plain);
    const FarLimit far = farLimit(cage, 3);
    const LimitSurface surface = limitSurface(cage);
    EXPECT_TRUE(surface.refused().empty()) << name;
    const Points position = surface.evaluate(far.at).position;
    EXPECT_LE((position - far.position).rowwise().norm().maxCoeff(),
              1e-14 * diagonal(cage.positions))
        << name;
  }
}

TEST(Bilinear, HolesHaveNoSurface) {
  Cage cage = bilinear(mixture(3));
  cage.options.holes = {1, 4};
  const LimitSurface surface = limitSurface(cage);
  EXPECT_EQ(surface.refused().size(), 2u);
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) {
    const std::vector<Location> one = {{face, 0.25, 0.5}};
    if (surface.refused().count(surface.baseFace()[face]) == 0) {
      at.push_back(one[0]);
    } else {
      expectThrow<MeshError>([&] { surface.evaluate(one); }, {std::to_string(face)});
    }
  }
  expectPatches("holes", cage, at);
}

TEST(Bilinear, EverythingElseWorksOnIt) {
  Cage cage = bilinear(perturbed(grid(3, 2), 0.1, 1));
  cage.faces.back() = {cage.faces.back()[0], cage.faces.back()[1], cage.faces.back()[2]};
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> vertices = surface.vertexLocations();
  const Points at_vertices = surface.evaluate(vertices).position;
  EXPECT_LE((at_vertices - cage.positions).rowwise().norm().maxCoeff(), 1e-14);

  double area = 0;  // of fine quads
  const int n = 300;
  for (const auto& p : patches(cage)) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Truth t = patchAt(p, (i + 0.5) / n, (j + 0.5) / n);
        area += t[kDu].cross(t[kDv]).norm() / (n * n);
      }
    }
  }
  EXPECT_NEAR(surfaceArea(surface) / area, 1, 1e-5);
  const auto bounds = surface.bounds();
  Points corners(0, 3);
  for (const auto& p : patches(cage)) {
    for (const Vector3& corner : p) {
      corners.conservativeResize(corners.rows() + 1, 3);
      corners.bottomRows(1) = corner.transpose();
    }
  }
  EXPECT_LE((bounds.row(0) - corners.colwise().minCoeff()).norm(), 1e-13);
  EXPECT_LE((bounds.row(1) - corners.colwise().maxCoeff()).norm(), 1e-13);

  Random random(2);
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) at += anywhere(face, 5, random);
  const Evaluation e = surface.evaluate(at, Derivatives::first, true);
  const Stencils stencils = surface.stencils(at, true);
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    Vector3 position = Vector3::Zero(), du = Vector3::Zero(), dv = Vector3::Zero();
    for (auto k = stencils.offsets[i]; k < stencils.offsets[i + 1]; ++k) {
      const Vector3 p = cage.positions.row(stencils.indices[k]);
      position += stencils.weights[k] * p;
      du += stencils.du_weights[k] * p;
      dv += stencils.dv_weights[k] * p;
    }
    EXPECT_LE((position - Vector3(e.position.row(i))).norm(), 1e-14);
    EXPECT_LE((du - Vector3(e.du.row(i))).norm(), 1e-13);
    EXPECT_LE((dv - Vector3(e.dv.row(i))).norm(), 1e-13);
  }
  EXPECT_EQ(scatterJittered(surface, 2, 1).size(), 4u * surface.faceCount());
  EXPECT_TRUE(tessellate(surface, 2).positions.allFinite());
  EXPECT_TRUE(surface.frames(at).allFinite());
  EXPECT_TRUE(surface.curvature(at).gaussian.allFinite());
}

}  // namespace
}  // namespace limitsurf::test
