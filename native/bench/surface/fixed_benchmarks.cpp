// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/fixed_benchmarks.h"

#include <cstdio>
#include <memory>
#include <numeric>
#include <string>

#include "bench/support/agreement.h"
#include "bench/support/limit_stencil_peer.h"
#include "bench/support/location_samples.h"
#include "bench/support/mesh_arrays.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

/// The mixed mesh with its samples, made when it is first needed.
class Scene {
 public:
  explicit Scene(int count) : count_(count) {}

  struct Made {
    explicit Made(int count) : cage(test::largeCage(100)), surface(cage.controlMesh()) {
      std::vector<int> faces(static_cast<std::size_t>(surface.faceCount()));
      std::iota(faces.begin(), faces.end(), 0);
      at = uniformSamples(faces, count);
      const auto rows = static_cast<Eigen::Index>(at.size());
      for (Points* points : {&out.position, &out.du, &out.dv}) points->setZero(rows, 3);
    }
    /// The table of weights, which is made anew where derivatives are wanted or no longer wanted.
    const LimitStencilPeer& stencils(bool with_derivatives) {
      if (!stencils_ || with_derivatives != has_derivatives_) {
        stencils_.reset();
        stencils_ = std::make_unique<LimitStencilPeer>(cage, at, with_derivatives);
        has_derivatives_ = with_derivatives;
        std::printf("LimitStencilTable%s: %.0f bytes for each sample, limitsurf %zu\n",
                    with_derivatives ? " with derivatives" : "",
                    static_cast<double>(stencils_->bytes()) / static_cast<double>(at.size()),
                    sizeof(Location));
      }
      return *stencils_;
    }
    MeshArrays cage;
    LimitSurface surface;
    std::vector<Location> at;
    Evaluation out;

   private:
    std::unique_ptr<LimitStencilPeer> stencils_;
    bool has_derivatives_ = false;
  };
  Made& made() {
    if (!made_) made_ = std::make_unique<Made>(count_);
    return *made_;
  }

 private:
  int count_;
  std::unique_ptr<Made> made_;
};

void runOurs(benchmark::State& state, Scene::Made& scene, bool with_derivatives) {
  const auto rows = [&](Points& p) {
    return EvaluationArrays<double>::Rows{p.data(), scene.at.size()};
  };
  const EvaluationArrays<double> arrays{rows(scene.out.position), rows(scene.out.du),
                                        rows(scene.out.dv)};
  const LocationBatch at = scene.surface.checkLocations(scene.at);
  for (auto _ : state) {
    scene.surface.setPositions(scene.cage.positions, 1);
    scene.surface.evaluate(at, with_derivatives ? Derivatives::first : Derivatives::none, arrays,
                           1);
    benchmark::ClobberMemory();
  }
  countItems(state, scene.at.size());
}

void runStencils(benchmark::State& state, Scene::Made& scene, bool with_derivatives) {
  const LimitStencilPeer& stencils = scene.stencils(with_derivatives);
  for (auto _ : state) {
    stencils.evaluate(scene.cage.positions, scene.out);
    benchmark::ClobberMemory();
  }
  countItems(state, scene.at.size());
}

}  // namespace

std::vector<Group> fixedGroups(int sample_count) {
  std::vector<Group> groups;
  for (const int per_face : {1, 10}) {
    const int count = per_face == 10 ? sample_count : sample_count / 10;
    const auto scene = std::make_shared<Scene>(count);
    for (const bool with_derivatives : {false, true}) {
      const auto on = [=](auto run) {
        return [=](benchmark::State& state) { run(state, scene->made(), with_derivatives); };
      };
      groups.push_back({kFixedTable,
                        std::to_string(count) + "/" + (with_derivatives ? "P,D1" : "P"),
                        {{"limitsurf", on(runOurs)}, {"LimitStencilTable", on(runStencils)}}});
    }
  }
  return groups;
}

}  // namespace limitsurf::bench
