// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/strand_benchmarks.h"

#include <memory>
#include <numeric>
#include <string>

#include "bench/support/location_samples.h"
#include "bench/support/mesh_arrays.h"
#include "limitsurf/surface/strands/strand_poser.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

constexpr int kPoints = 8;

/// Hair on the mixed mesh, in face order or shuffled, made when it is first needed.
class Hair {
 public:
  Hair(int count, bool is_random) : count_(count), is_random_(is_random) {}

  struct Made {
    Made(int count, bool is_random) : surface(MeshArrays(test::largeCage(100)).controlMesh()) {
      std::vector<int> faces(static_cast<std::size_t>(surface.faceCount()));
      std::iota(faces.begin(), faces.end(), 0);
      at = uniformSamples(faces, count);
      if (is_random) at = shuffled(at);
      const auto rows = static_cast<Eigen::Index>(at.size());
      std::vector<std::int64_t> offsets(at.size() + 1);
      for (std::size_t i = 0; i < offsets.size(); ++i) {
        offsets[i] = kPoints * static_cast<std::int64_t>(i);
      }
      poser = std::make_unique<StrandPoser>(surface, at, FloatPoints::Random(rows, 3),
                                            FloatRotations::Random(rows, 4), offsets);
      rest.setRandom(kPoints * rows, 3);
      posed.setZero(kPoints * rows, 3);
    }
    LimitSurface surface;
    std::vector<Location> at;
    std::unique_ptr<StrandPoser> poser;
    FloatPoints rest, posed;
  };
  Made& made() {
    if (!made_) made_ = std::make_unique<Made>(count_, is_random_);
    return *made_;
  }

 private:
  int count_;
  bool is_random_;
  std::unique_ptr<Made> made_;
};

void pose(benchmark::State& state, Hair::Made& hair) {
  for (auto _ : state) {
    hair.poser->pose(hair.rest, hair.posed, Eigen::Matrix4d::Identity(), 1);
    benchmark::ClobberMemory();
  }
  countItems(state, hair.at.size());
}

void evaluate(benchmark::State& state, Hair::Made& hair) {
  for (auto _ : state) {
    const Evaluation result = hair.surface.evaluate(hair.at, Derivatives::first, false, 1);
    benchmark::DoNotOptimize(result.position.data());
    benchmark::ClobberMemory();
  }
  countItems(state, hair.at.size());
}

void frames(benchmark::State& state, Hair::Made& hair) {
  for (auto _ : state) {
    const auto result = hair.surface.frames(hair.at, 1);
    benchmark::DoNotOptimize(result.data());
    benchmark::ClobberMemory();
  }
  countItems(state, hair.at.size());
}

void fingerprints(benchmark::State& state, Hair::Made& hair) {
  for (auto _ : state) {
    const std::vector<std::int32_t> result = hair.poser->fingerprints(hair.posed, 1);
    benchmark::DoNotOptimize(result.data());
  }
  countItems(state, hair.at.size());
}

}  // namespace

std::vector<Group> strandGroups(int count) {
  std::vector<Group> groups;
  for (const bool is_random : {false, true}) {
    const auto hair = std::make_shared<Hair>(count, is_random);
    Group group{
        kStrandTable, std::string(is_random ? "random/" : "sorted/") + std::to_string(count), {}};
    const auto add = [&](const std::string& name, void (*run)(benchmark::State&, Hair::Made&),
                         bool is_peer) {
      group.columns.push_back(
          {name, [=](benchmark::State& state) { run(state, hair->made()); }, is_peer});
    };
    add("pose", &pose, true);
    add("evaluate P,D1", &evaluate, true);
    add("frames", &frames, true);
    add("fingerprints", &fingerprints, false);
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace limitsurf::bench
