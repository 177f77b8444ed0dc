// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/setup_benchmarks.h"

#include <array>
#include <memory>
#include <string>

#include "bench/support/bfr_peer.h"
#include "bench/support/face_classes.h"
#include "bench/support/mesh_arrays.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

struct SetupCage {
  explicit SetupCage(MeshArrays made) : cage(std::move(made)) {
    const std::vector<ClassifiedFace> classified = classifyFaces(cage);
    std::size_t ptex_face = 0;
    for (int face = 0; face < cage.faceCount(); ++face) {
      const bool is_quad = cage.face_sizes[face] == 4;
      if (classified[ptex_face].face_class != FaceClass::regular) {
        irregular_base_faces.push_back(face);
        irregular_count += is_quad ? 1 : cage.face_sizes[face];
      }
      ptex_face += is_quad ? 1 : cage.face_sizes[face];
    }
    other_positions = cage.positions;
    other_positions.col(2) *= 1.25;
  }
  MeshArrays cage;
  std::vector<int> irregular_base_faces;
  std::size_t irregular_count = 0;  ///< the number of irregular Ptex faces
  Points other_positions;
};

void openOurs(benchmark::State& state, const SetupCage& setup) {
  for (auto _ : state) {
    LimitSurface surface(setup.cage.controlMesh());
    benchmark::DoNotOptimize(surface);
  }
  countItems(state, setup.cage.ptexFaceCount());
}

void openFar(benchmark::State& state, const SetupCage& setup) {
  for (auto _ : state) {
    const TopologyPointer topology = farTopology(setup.cage);
    benchmark::DoNotOptimize(topology.get());
  }
  countItems(state, setup.cage.ptexFaceCount());
}

void openBfr(benchmark::State& state, const SetupCage& setup, int level, BfrPeer::Cache* cache) {
  for (auto _ : state) {
    const TopologyPointer topology = farTopology(setup.cage);
    const BfrPeer bfr(setup.cage, *topology, level, cache);
    benchmark::DoNotOptimize(bfr);
  }
  countItems(state, setup.cage.ptexFaceCount());
}

void poseOurs(benchmark::State& state, const SetupCage& setup) {
  LimitSurface surface(setup.cage.controlMesh());
  bool is_other = false;
  for (auto _ : state) {
    is_other = !is_other;
    surface.setPositions(is_other ? setup.other_positions : setup.cage.positions, 1);
    benchmark::ClobberMemory();
  }
  countItems(state, setup.irregular_count);
}

/// Bfr's regular faces are left out, although their control points would have to be gathered as
/// well.
void poseBfr(benchmark::State& state, const SetupCage& setup, int level) {
  const TopologyPointer topology = farTopology(setup.cage);
  BfrPeer bfr(setup.cage, *topology, level);
  bool is_other = false;
  for (auto _ : state) {
    is_other = !is_other;
    bfr.prepare(is_other ? setup.other_positions : setup.cage.positions,
                setup.irregular_base_faces);
    benchmark::ClobberMemory();
  }
  countItems(state, setup.irregular_count);
}

}  // namespace

std::vector<Group> setupGroups() {
  const std::pair<std::string, MeshArrays> cages[] = {
      {"regular", test::torusCage()},           {"interior-EV", test::interiorEvCage()},
      {"boundary-EV", test::boundaryEvCage()},  {"corner", test::cornersCage()},
      {"multi-EV", test::crossesCage()},        {"non-quad", test::polygonsCage()},
      {"mixed-20k-faces", test::largeCage(144)}};
  std::vector<Group> groups;
  for (const auto& [name, cage] : cages) {
    const auto setup = std::make_shared<const SetupCage>(cage);
    const int percent = static_cast<int>(0.5 + 100.0 * static_cast<double>(setup->irregular_count) /
                                                   cage.ptexFaceCount());
    const std::string row =
        name + "/" + std::to_string(cage.ptexFaceCount()) + "/" + std::to_string(percent) + "%";

    Group opening{kOpeningTable, row, {}};
    opening.columns.push_back(
        {"limitsurf", [=](benchmark::State& state) { openOurs(state, *setup); }});
    opening.columns.push_back(
        {"Far alone", [=](benchmark::State& state) { openFar(state, *setup); }, false});
    for (const int level : kBfrLevels) {
      opening.columns.push_back(
          {"Bfr " + std::to_string(level) + " cold",
           [=](benchmark::State& state) { openBfr(state, *setup, level, nullptr); }});
    }
    for (const int level : kBfrLevels) {
      const auto cache = std::make_shared<BfrPeer::Cache>();
      opening.columns.push_back(
          {"Bfr " + std::to_string(level) + " warm", [=](benchmark::State& state) {
             BfrPeer(setup->cage, *farTopology(setup->cage), level, cache.get());
             openBfr(state, *setup, level, cache.get());
           }});
    }
    groups.push_back(std::move(opening));

    if (setup->irregular_count == 0) continue;
    Group posing{kPosingTable, row, {}};
    posing.columns.push_back(
        {"limitsurf", [=](benchmark::State& state) { poseOurs(state, *setup); }});
    for (const int level : kBfrLevels) {
      posing.columns.push_back({"Bfr " + std::to_string(level),
                                [=](benchmark::State& state) { poseBfr(state, *setup, level); }});
    }
    groups.push_back(std::move(posing));
  }
  return groups;
}

}  // namespace limitsurf::bench
