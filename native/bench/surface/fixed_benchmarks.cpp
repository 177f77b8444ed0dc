// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/fixed_benchmarks.h"

#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "bench/support/agreement.h"
#include "bench/support/limit_stencil_peer.h"
#include "bench/support/location_samples.h"
#include "bench/support/mesh_arrays.h"
#include "limitsurf/surface/fixed/fixed_samples.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

/// A mesh with its samples, made when it is first needed.
class Scene {
 public:
  struct Made {
    Made(const test::Cage& input, int samples_per_face) : cage(input), surface(cage.controlMesh()) {
      std::vector<int> faces(static_cast<std::size_t>(surface.faceCount()));
      std::iota(faces.begin(), faces.end(), 0);
      at = uniformSamples(faces, samples_per_face * surface.faceCount());
      const auto rows = static_cast<Eigen::Index>(at.size());
      for (Points* points : {&out.position, &out.du, &out.dv}) points->setZero(rows, 3);
    }

    /// What the peer and we prepare, made anew where derivatives are wanted or no longer wanted.
    const LimitStencilPeer& stencils(bool with_derivatives) {
      prepare(with_derivatives);
      return *stencils_;
    }
    const FixedSamples& samples(bool with_derivatives) {
      prepare(with_derivatives);
      return *samples_;
    }
    EvaluationArrays<double> arrays(bool with_derivatives) {
      const auto rows = [&](Points& p) {
        return EvaluationArrays<double>::Rows{p.data(), at.size()};
      };
      EvaluationArrays<double> result;
      result.position = rows(out.position);
      if (with_derivatives) {
        result.du = rows(out.du);
        result.dv = rows(out.dv);
      }
      return result;
    }

    MeshArrays cage;
    LimitSurface surface;
    std::vector<Location> at;
    Evaluation out;

   private:
    void prepare(bool with_derivatives) {
      if (stencils_ && with_derivatives == has_derivatives_) return;
      stencils_.reset();
      samples_.reset();
      stencils_ = std::make_unique<LimitStencilPeer>(cage, at, with_derivatives);
      samples_ = std::make_unique<FixedSamples>(surface, at, orderOf(with_derivatives), 1);
      has_derivatives_ = with_derivatives;
      const auto each = [&](std::size_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(at.size());
      };
      std::printf("%zu samples%s: LimitStencilTable %.0f bytes for each, FixedSamples %.0f\n",
                  at.size(), with_derivatives ? " with derivatives" : "", each(stencils_->bytes()),
                  each(samples_->bytes()));
    }

    std::unique_ptr<LimitStencilPeer> stencils_;
    std::unique_ptr<FixedSamples> samples_;
    bool has_derivatives_ = false;
  };

  Scene(std::function<test::Cage()> cage, int samples_per_face)
      : cage_(std::move(cage)), samples_per_face_(samples_per_face) {}
  Made& made() {
    if (!made_) made_ = std::make_unique<Made>(cage_(), samples_per_face_);
    return *made_;
  }

  static Derivatives orderOf(bool with_derivatives) {
    return with_derivatives ? Derivatives::first : Derivatives::none;
  }

 private:
  std::function<test::Cage()> cage_;
  int samples_per_face_;
  std::unique_ptr<Made> made_;
};

void runSamples(benchmark::State& state, Scene::Made& scene, bool with_derivatives) {
  const FixedSamples& samples = scene.samples(with_derivatives);
  for (auto _ : state) {
    samples.evaluate(scene.cage.positions, scene.arrays(with_derivatives), 1);
    benchmark::ClobberMemory();
  }
  countItems(state, scene.at.size());
}

void runSurface(benchmark::State& state, Scene::Made& scene, bool with_derivatives) {
  const LocationBatch at = scene.surface.checkLocations(scene.at);
  for (auto _ : state) {
    scene.surface.setPositions(scene.cage.positions, 1);
    scene.surface.evaluate(at, Scene::orderOf(with_derivatives), scene.arrays(with_derivatives), 1);
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

std::vector<Group> fixedGroups() {
  struct Mesh {
    const char* name;
    std::function<test::Cage()> cage;
  };
  const Mesh meshes[] = {{"mostly quads", [] { return test::largeCage(100); }},
                         {"character", [] { return test::characterCage(100); }},
                         {"scan", [] { return test::scanCage(71); }}};
  std::vector<Group> groups;
  for (const Mesh& mesh : meshes) {
    for (const int per_face : {1, 10}) {
      const auto scene = std::make_shared<Scene>(mesh.cage, per_face);
      for (const bool with_derivatives : {false, true}) {
        const auto on = [=](auto run) {
          return [=](benchmark::State& state) { run(state, scene->made(), with_derivatives); };
        };
        groups.push_back({kFixedTable,
                          std::string(mesh.name) + "/" + std::to_string(per_face) + "/" +
                              (with_derivatives ? "P,D1" : "P"),
                          {{"limitsurf", on(runSamples)},
                           {"LimitStencilTable", on(runStencils)},
                           {"posed surface", on(runSurface)}}});
      }
    }
  }
  return groups;
}

}  // namespace limitsurf::bench
