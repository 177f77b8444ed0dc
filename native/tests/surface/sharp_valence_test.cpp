// SPDX-License-Identifier: Apache-2.0
//
// Vertices of every valence to 100 that are sharp or have sharp edges, against recursive
// subdivision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <ostream>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// The spokes that are sharp edges around a vertex with `faces` faces.
using Spokes = std::vector<int> (*)(int faces);

struct Kind {
  const char* name;
  bool closed;
  bool sharp_vertex;
  Spokes spokes;
  int least_faces;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

std::vector<int> none(int) { return {}; }
std::vector<int> one(int) { return {0}; }
std::vector<int> neighbours(int) { return {0, 1}; }
std::vector<int> nextButOne(int) { return {0, 2}; }
std::vector<int> opposite(int faces) { return {0, faces / 2}; }
std::vector<int> three(int faces) { return {0, 1, (faces + 1) / 2}; }
std::vector<int> all(int faces) {
  std::vector<int> spokes(faces);
  std::iota(spokes.begin(), spokes.end(), 0);
  return spokes;
}
std::vector<int> inside(int faces) { return {faces / 2}; }
std::vector<int> twoInside(int faces) { return {1, faces - 1}; }

constexpr Kind kDart = {"dart", true, false, one, 2};
constexpr Kind kCone = {"cone", true, true, none, 2};
constexpr Kind kConeWithEdge = {"sharp vertex with a sharp edge", true, true, one, 2};
constexpr Kind kNarrowCrease = {"crease beside one face", true, false, neighbours, 3};
constexpr Kind kBentCrease = {"crease beside two faces", true, false, nextButOne, 4};
constexpr Kind kStraightCrease = {"straight crease", true, false, opposite, 2};
constexpr Kind kThree = {"three creases", true, false, three, 3};
constexpr Kind kAll = {"all edges sharp", true, false, all, 3};
constexpr Kind kBoundary = {"boundary with a sharp edge", false, false, inside, 2};
constexpr Kind kBoundaryTwice = {"boundary with two sharp edges", false, false, twoInside, 3};
constexpr Kind kSharpBoundary = {"sharp boundary vertex", false, true, none, 1};

Cage sharpFan(const Kind& kind, int faces, double sharpness) {
  Cage cage = fan(faces, kind.closed, 1000 + faces);
  const int vertex = cage.faces[0][0];
  for (int spoke : kind.spokes(faces)) {
    // Each crease has two edges, so that the end of the first one is no dart.
    const int middle = cage.faces[4 * spoke][1], end = cage.faces[4 * spoke + 1][1];
    sharpenEdge(cage, vertex, middle, sharpness);
    sharpenEdge(cage, middle, end, sharpness);
  }
  if (kind.sharp_vertex) sharpenVertex(cage, vertex, sharpness);
  return cage;
}

void compareSharpFan(const Kind& kind, int faces, double sharpness, const std::vector<int>& levels,
                     int random_locations, Accuracy& accuracy) {
  Cage cage = sharpFan(kind, faces, sharpness);
  cage.options.creasing = faces % 2 == 0 ? Creasing::uniform : Creasing::chaikin;
  Random random(faces);
  const std::vector<Location> at = aroundFan(faces, levels, random_locations, random);
  compareWithSubdivision(std::string(kind.name) + " of " + std::to_string(sharpness) + ", faces " +
                             std::to_string(faces),
                         cage, at, accuracy);
}

class SharpValence : public testing::TestWithParam<Kind> {};
class SlowSharpValence : public testing::TestWithParam<Kind> {};

TEST_P(SharpValence, AgreesWithSubdivision) {
  Accuracy all("fans", 1);
  for (int faces : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 33, 64, 100}) {
    if (faces < GetParam().least_faces) continue;
    compareSharpFan(GetParam(), faces, INFINITY, {1, 3, 10, 40}, 2, all);
  }
  std::printf("%s", all.details().c_str());
}

TEST_P(SharpValence, AgreesWithSubdivisionWhereSemiSharp) {
  Accuracy all("fans", 1);
  for (int faces : {1, 2, 3, 4, 5, 6, 9, 16, 40}) {
    if (faces < GetParam().least_faces) continue;
    compareSharpFan(GetParam(), faces, 0.3 * (1 + faces % 11), {1, 3, 20, 40}, 1, all);
  }
  std::printf("%s", all.details().c_str());
}

TEST_P(SlowSharpValence, AgreesWithSubdivision) {
  const std::vector<int> levels = {1, 2, 3, 4, 6, 8, 11, 14, 18, 22, 26, 30, 35, 40};
  Accuracy all("fans", 1);
  for (int faces = GetParam().least_faces; faces <= 100; ++faces) {
    compareSharpFan(GetParam(), faces, INFINITY, levels, 10, all);
  }
  std::printf("%s", all.details().c_str());
}

TEST_P(SlowSharpValence, AgreesWithSubdivisionWhereSemiSharp) {
  Accuracy all("fans", 1);
  for (int faces = GetParam().least_faces; faces <= 100; ++faces) {
    compareSharpFan(GetParam(), faces, 0.3 * (1 + faces % 33), {1, 2, 3, 5, 7, 12, 20, 40}, 4, all);
  }
  std::printf("%s", all.details().c_str());
}

const auto kKinds =
    testing::Values(kDart, kCone, kConeWithEdge, kNarrowCrease, kBentCrease, kStraightCrease,
                    kThree, kAll, kBoundary, kBoundaryTwice, kSharpBoundary);

std::string kindName(const testing::TestParamInfo<Kind>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Of, SharpValence, kKinds, kindName);
INSTANTIATE_TEST_SUITE_P(SlowOf, SlowSharpValence, kKinds, kindName);

TEST(SlowSharpSectors, CreasesSplitTheFacesAnyWay) {
  Accuracy all("creases", 1);
  for (int faces = 3; faces <= 14; ++faces) {
    for (int second = 1; second < faces; ++second) {
      for (const double vertex_sharpness : {0.0, 10.0}) {
        Cage cage = sharpFan(kDart, faces, INFINITY);
        const int vertex = cage.faces[0][0];
        sharpenEdge(cage, vertex, cage.faces[4 * second][1], 10);
        if (vertex_sharpness > 0) sharpenVertex(cage, vertex, vertex_sharpness);
        std::vector<Location> at;
        for (int face = 0; face < faces; ++face) {
          at.push_back({4 * face, 0, 0});
          at += shells(4 * face, 0, {1, 4, 15, 40});
        }
        compareWithSubdivision(std::to_string(faces) + " faces split at " + std::to_string(second),
                               cage, at, all);
      }
    }
  }
  std::printf("%s", all.details().c_str());
}

}  // namespace
}  // namespace limitsurf::test
