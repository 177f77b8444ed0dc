// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace limitsurf::bench {

/// Counter that holds CPU seconds per sample or face, of all threads together.
constexpr char kPerItem[] = "per_item";

/// To be called after the loop of a benchmark whose every iteration handles `items`.
void countItems(benchmark::State& state, std::size_t items);

/// Benchmarks that are compared with each other: one row of a table, a column each.
struct Group {
  std::string table;  ///< first part of the benchmarks' names
  std::string row;    ///< its fields, separated by '/'
  struct Column {
    std::string name;
    std::function<void(benchmark::State&)> run;
    bool is_peer = true;  ///< whether it does the same as ours, so that a ratio makes sense
  };
  std::vector<Column> columns;  ///< ours first

  std::string benchmarkName(const Column& column) const {
    return table + "/" + row + "/" + column.name;
  }
};

/// Collects every repetition, prints one line per benchmark, and at the end the tables of medians
/// and ratios.
class RatioReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& report) override;

  /// Markdown: a row per group, medians in nanoseconds, and how many times as long as ours each
  /// peer takes.
  void printTable(const std::string& table, const std::string& title,
                  const std::vector<std::string>& field_names,
                  const std::vector<Group>& groups) const;

 private:
  bool has_context_ = false;
  std::map<std::string, std::vector<double>> nanoseconds_;  ///< by benchmark, all repetitions
};

/// Runs each group's benchmarks with their repetitions interleaved.
void runGroups(const std::vector<Group>& groups, RatioReporter& reporter);

}  // namespace limitsurf::bench
