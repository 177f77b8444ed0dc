// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/opening_cost.h"

#include <opensubdiv/far/patchTableFactory.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "bench/support/bfr_peer.h"
#include "bench/support/face_classes.h"
#include "bench/support/mesh_arrays.h"
#include "bench/support/process_cost.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

/// What evaluation with Far needs: adaptively refined faces, and their patches.
struct FarAdaptive {
  std::shared_ptr<OpenSubdiv::Far::TopologyRefiner> topology;
  std::shared_ptr<const OpenSubdiv::Far::PatchTable> patches;
};

FarAdaptive openFarAdaptive(const MeshArrays& cage, bool with_patches = false) {
  namespace Far = OpenSubdiv::Far;
  constexpr int kLevel = 6;
  FarAdaptive result;
  result.topology = farTopology(cage);
  Far::PatchTableFactory::Options options(kLevel);
  options.useInfSharpPatch = true;
  options.useSingleCreasePatch = true;
  options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
  result.topology->RefineAdaptive(options.GetRefineAdaptiveOptions());
  if (with_patches) {
    result.patches.reset(Far::PatchTableFactory::Create(*result.topology, options));
  }
  return result;
}

/// Prints a row for each library.
int measureOpening(const MeshArrays& cage) {
  struct Row {
    const char* name;
    Opening open;
    std::vector<Cost> costs;
  };
  struct BfrWithTopology {
    TopologyPointer topology;
    BfrPeer bfr;
  };
  const auto open_bfr = [&](int level) {
    TopologyPointer topology = farTopology(cage);
    BfrPeer bfr(cage, *topology, level);
    return std::make_shared<BfrWithTopology>(BfrWithTopology{std::move(topology), std::move(bfr)});
  };
  std::vector<Row> rows = {
      {"Far topology alone", [&] { return std::shared_ptr<void>(farTopology(cage)); }, {}},
      {"limitsurf ControlMesh",
       [&] { return std::make_shared<ControlMesh>(cage.controlMesh()); },
       {}},
      {"limitsurf ControlMesh + LimitSurface",
       [&] { return std::make_shared<LimitSurface>(cage.controlMesh()); },
       {}},
      {"Far adaptive refinement, level 6", [&] { return openFarAdaptive(cage).topology; }, {}},
      {"the same with its patch table",
       [&] { return std::make_shared<FarAdaptive>(openFarAdaptive(cage, true)); },
       {}},
      {"Far topology + Bfr 2 surfaces", [&] { return open_bfr(2); }, {}},
      {"Far topology + Bfr 10 surfaces", [&] { return open_bfr(10); }, {}},
  };
  for (int repetition = 0; repetition < 3; ++repetition) {
    for (Row& row : rows) {
      Cost cost;
      if (!measureApart(row.open, cost)) {
        std::fprintf(stderr, "%s failed\n", row.name);
        return 1;
      }
      row.costs.push_back(cost);
    }
  }
  std::printf("| | s | CPU s | peak MiB | kept MiB |\n|---|---:|---:|---:|---:|\n");
  for (Row& row : rows) {
    std::sort(row.costs.begin(), row.costs.end(),
              [](const Cost& a, const Cost& b) { return a.seconds < b.seconds; });
    const Cost& middle = row.costs[1];
    std::printf("| %s | %.3f | %.3f | %.0f | %.0f |\n", row.name, middle.seconds,
                middle.cpu_seconds, middle.peak_mib, middle.kept_mib);
  }
  return 0;
}

}  // namespace

int measureLargeMesh(int side) {
  const MeshArrays cage = test::largeCage(side);
  const std::vector<ClassifiedFace> classified = classifyFaces(cage);
  const std::size_t regular = facesOf(classified, FaceClass::regular).size();
  std::printf("%d quads, %.2f %% of them irregular; all threads; median of 3\n\n", cage.faceCount(),
              100.0 * (1 - static_cast<double>(regular) / cage.faceCount()));
  return measureOpening(cage);
}

int measureSemiSharpMesh(int side) {
  const MeshArrays cage = test::semiSharpCage(side);
  std::printf("%d quads, every edge of sharpness 0.5 to 4; all threads; median of 3\n\n",
              cage.faceCount());
  return measureOpening(cage);
}

}  // namespace limitsurf::bench
