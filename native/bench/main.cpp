// SPDX-License-Identifier: Apache-2.0
//
// Benchmarks of limitsurf beside OpenSubdiv's Bfr, in one process and one run.
//
//   limitsurf_bench                       all tables
//   limitsurf_bench --benchmark_filter=boundary-EV
//   limitsurf_bench --samples=20000       the number of locations in a batch (default 100000)
//   limitsurf_bench --fresh-memory        results in memory newly allocated by the system
//   limitsurf_bench --save=FOLDER         writes the meshes and locations of the table of
//                                         evaluation
//   limitsurf_bench --large[=1000]        time and memory for opening a grid of 1000 x 1000 quads
//   limitsurf_bench --semi-sharp[=100]    the same for 100 x 100 quads whose edges are semi-sharp
//   limitsurf_bench --queries[=1000000]   closest points and rays beside Embree, and random points
//   limitsurf_bench --interpolate[=100000]  evaluation beside Embree's rtcInterpolateN
//   limitsurf_bench --uv[=4096]           UV maps inverted, for an image with so many texels a side
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <opensubdiv/version.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "bench/support/agreement.h"
#include "bench/surface/evaluation_benchmarks.h"
#include "bench/surface/fixed_benchmarks.h"
#include "bench/surface/opening_cost.h"
#include "bench/uv/uv_benchmarks.h"
#ifdef LIMITSURF_BENCH_EMBREE
#include "bench/search/search_benchmarks.h"
#include "bench/surface/interpolation_benchmarks.h"
#endif
#include "bench/sample/sampling_benchmarks.h"
#include "bench/support/ratio_reporter.h"
#include "bench/surface/setup_benchmarks.h"
#include "bench/surface/strand_benchmarks.h"

namespace {

/// The number after `flag` and "=", the default if there is no number, 0 if `argument` is another
/// flag.
int valueOf(const char* argument, const char* flag, int default_value) {
  const std::size_t length = std::strlen(flag);
  if (std::strncmp(argument, flag, length) != 0) return 0;
  if (argument[length] == '\0') return default_value;
  return argument[length] == '=' ? std::atoi(argument + length + 1) : 0;
}

/// Makes the allocator keep freed memory. By default it returns the result arrays of a batch to the
/// system, and the page faults of the next batch cost more than evaluations on regular faces.
void recycleMemory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // glibc's maximum
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

int runTables(int argc, char** argv, int sample_count) {
  using namespace limitsurf::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

  std::vector<Group> groups = evaluationGroups(sample_count);
  for (Group& group : depthGroups(sample_count)) groups.push_back(std::move(group));
  for (Group& group : fixedGroups()) groups.push_back(std::move(group));
  for (Group& group : setupGroups()) groups.push_back(std::move(group));
  for (Group& group : strandGroups(sample_count)) groups.push_back(std::move(group));
  for (Group& group : samplingGroups(sample_count)) groups.push_back(std::move(group));
  RatioReporter reporter;
  runGroups(groups, reporter);

  std::printf(
      "\nOpenSubdiv %d.%d.%d, Bfr<double> levels 2 (default) and 10; smooth boundaries; one "
      "thread; medians of CPU time.\n",
      OPENSUBDIV_VERSION_MAJOR, OPENSUBDIV_VERSION_MINOR, OPENSUBDIV_VERSION_PATCH);
  reporter.printTable(kEvaluationTable, "Evaluation, ns per sample", {"face", "order", "result"},
                      groups);
  reporter.printTable(kDepthTable, "By distance from an extraordinary vertex, ns per sample",
                      {"face", "distance", "result"}, groups);
  reporter.printTable(kFixedTable, "Samples that stay while the mesh deforms, ns per sample",
                      {"mesh", "samples a Ptex face", "result"}, groups);
  reporter.printTable(kOpeningTable, "Opening a mesh, ns per face", {"mesh", "faces", "irregular"},
                      groups);
  reporter.printTable(kPosingTable, "New positions, ns per irregular face",
                      {"mesh", "faces", "irregular"}, groups);
  reporter.printTable(kStrandTable, "Posing strands of 8 points, ns per strand",
                      {"roots", "strands"}, groups);
  reporter.printTable(kSamplerSetupTable, "Preparing to scatter, ns per face", {"mesh", "faces"},
                      groups);
  reporter.printTable(kUniformTable, "Uniform points, ns each", {"mesh", "faces"}, groups);
  reporter.printTable(kBlueNoiseTable, "Blue noise, ns per point", {"mesh", "faces"}, groups);
  return allAgreed() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  // These arguments come first, so that those of the caller override them.
  static char interleave[] = "--benchmark_enable_random_interleaving=true";
  static char repetitions[] = "--benchmark_repetitions=9";
  static char time[] = "--benchmark_min_time=0.03";
  std::vector<char*> arguments = {argv[0], interleave, repetitions, time};
  int sample_count = 100000;
  int large_side = 0, semi_sharp_side = 0, query_count = 0, interpolation_count = 0, uv_side = 0;
  bool is_memory_fresh = false;
  std::string saved_to;
  for (int i = 1; i < argc; ++i) {
    if (const int count = valueOf(argv[i], "--samples", 0)) {
      sample_count = count;
    } else if (const int side = valueOf(argv[i], "--large", 1000)) {
      large_side = side;
    } else if (const int sharp_side = valueOf(argv[i], "--semi-sharp", 100)) {
      semi_sharp_side = sharp_side;
    } else if (const int queries = valueOf(argv[i], "--queries", 1000000)) {
      query_count = queries;
    } else if (const int interpolations = valueOf(argv[i], "--interpolate", 100000)) {
      interpolation_count = interpolations;
    } else if (const int texels = valueOf(argv[i], "--uv", 4096)) {
      uv_side = texels;
    } else if (std::strncmp(argv[i], "--save=", 7) == 0) {
      saved_to = argv[i] + 7;
    } else if (std::strcmp(argv[i], "--fresh-memory") == 0) {
      is_memory_fresh = true;
    } else {
      arguments.push_back(argv[i]);
    }
  }
  try {
    if (!saved_to.empty() && query_count == 0) {
      limitsurf::bench::saveEvaluation(saved_to, sample_count);
      return 0;
    }
    if (large_side > 0) return limitsurf::bench::measureLargeMesh(large_side);
    if (semi_sharp_side > 0) return limitsurf::bench::measureSemiSharpMesh(semi_sharp_side);
    if (uv_side > 0) return limitsurf::bench::measureUvMaps(uv_side);
    if (query_count > 0 || interpolation_count > 0) {
#ifdef LIMITSURF_BENCH_EMBREE
      if (interpolation_count > 0) {
        recycleMemory();
        return limitsurf::bench::measureInterpolation(interpolation_count);
      }
      if (saved_to.empty()) return limitsurf::bench::measureSearches(query_count);
      limitsurf::bench::saveSearches(saved_to, query_count);
      return 0;
#else
      std::fprintf(stderr, "built without Embree\n");
      return 2;
#endif
    }
    if (!is_memory_fresh) recycleMemory();
    return runTables(static_cast<int>(arguments.size()), arguments.data(), sample_count);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
