// SPDX-License-Identifier: Apache-2.0
#include "bench/support/ratio_reporter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <regex>

#include "bench/support/median.h"

namespace limitsurf::bench {
namespace {

std::string inColumns(const std::string& row) {
  return std::regex_replace(row, std::regex("/"), " | ");
}

}  // namespace

void countItems(benchmark::State& state, std::size_t items) {
  state.counters[kPerItem] =
      benchmark::Counter(static_cast<double>(items), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

bool RatioReporter::ReportContext(const Context& context) {
  if (!has_context_) PrintBasicContext(&GetErrorStream(), context);
  has_context_ = true;
  return true;
}

void RatioReporter::ReportRuns(const std::vector<Run>& report) {
  std::string name;
  for (const Run& run : report) {
    if (run.run_type != Run::RT_Iteration) continue;
    name = run.run_name.function_name;
    if (run.error_occurred) {
      std::printf("%s: %s\n", name.c_str(), run.error_message.c_str());
      continue;
    }
    nanoseconds_[name].push_back(1e9 * run.counters.at(kPerItem).value);
  }
  const auto found = nanoseconds_.find(name);
  if (found == nanoseconds_.end()) return;
  const std::vector<double>& all = found->second;
  std::printf("%-60s %9.1f ns  (%.1f to %.1f, %zu repetitions)\n", name.c_str(), median(all),
              *std::min_element(all.begin(), all.end()), *std::max_element(all.begin(), all.end()),
              all.size());
  std::fflush(stdout);
}

void RatioReporter::printTable(const std::string& table, const std::string& title,
                               const std::vector<std::string>& field_names,
                               const std::vector<Group>& groups) const {
  bool has_header = false;
  for (const Group& group : groups) {
    if (group.table != table) continue;
    std::vector<double> medians;
    for (const auto& column : group.columns) {
      const auto found = nanoseconds_.find(group.benchmarkName(column));
      medians.push_back(found == nanoseconds_.end() ? NAN : median(found->second));
    }
    if (std::all_of(medians.begin(), medians.end(), [](double m) { return std::isnan(m); }))
      continue;
    if (!has_header) {
      std::printf("\n### %s\n\n|", title.c_str());
      for (const std::string& field : field_names) std::printf(" %s |", field.c_str());
      for (const auto& column : group.columns) std::printf(" %s |", column.name.c_str());
      for (std::size_t i = 1; i < group.columns.size(); ++i) {
        if (group.columns[i].is_peer) std::printf(" %s / ours |", group.columns[i].name.c_str());
      }
      std::printf("\n|");
      for (std::size_t i = 0; i < field_names.size(); ++i) std::printf("---|");
      for (std::size_t i = 0; i < group.columns.size(); ++i) std::printf("---:|");
      for (std::size_t i = 1; i < group.columns.size(); ++i) {
        if (group.columns[i].is_peer) std::printf("---:|");
      }
      std::printf("\n");
      has_header = true;
    }
    std::printf("| %s |", inColumns(group.row).c_str());
    for (const double m : medians) std::printf(m < 99.95 ? " %.1f |" : " %.0f |", m);
    for (std::size_t i = 1; i < medians.size(); ++i) {
      if (group.columns[i].is_peer) std::printf(" %.2f |", medians[i] / medians[0]);
    }
    std::printf("\n");
  }
}

void runGroups(const std::vector<Group>& groups, RatioReporter& reporter) {
  // Google Benchmark can only interleave all registered benchmarks, so groups are registered one by
  // one: benchmarks that are compared then run within the same second or two.
  std::string filter = benchmark::GetBenchmarkFilter();
  if (filter.empty() || filter == "all") filter = ".";
  const bool is_negative = filter[0] == '-';
  const std::regex pattern(is_negative ? filter.substr(1) : filter);
  for (const Group& group : groups) {
    bool is_wanted = false;
    for (const auto& column : group.columns) {
      const std::string name = group.benchmarkName(column);
      is_wanted |= std::regex_search(name, pattern) != is_negative;
      benchmark::RegisterBenchmark(name.c_str(), column.run)->MeasureProcessCPUTime();
    }
    if (is_wanted) benchmark::RunSpecifiedBenchmarks(&reporter);
    benchmark::ClearRegisteredBenchmarks();
  }
}

}  // namespace limitsurf::bench
