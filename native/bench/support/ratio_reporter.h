// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace limitsurf::bench {

/// The name of the counter that holds the CPU seconds of all threads for each sample or face.
constexpr char kPerItem[] = "per_item";

/// Sets the counter. It must be called after the loop of a benchmark, each iteration of which
/// handles `items`.
void countItems(benchmark::State& state, std::size_t items);

/// Benchmarks that are compared with each other: the columns of one row of a table.
struct Group {
  std::string table;  ///< the first part of the benchmarks' names
  std::string row;    ///< the fields of the row, separated by '/'
  struct Column {
    std::string name;
    std::function<void(benchmark::State&)> run;
    bool is_peer = true;  ///< it does the same as limitsurf, so that a ratio is meaningful
  };
  std::vector<Column> columns;  ///< limitsurf's comes first

  std::string benchmarkName(const Column& column) const {
    return table + "/" + row + "/" + column.name;
  }
};

/// Collects all repetitions. Prints a line for each benchmark and, at the end, tables of medians
/// and ratios.
class RatioReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& report) override;

  /// Prints a table in Markdown: a row for each group, with medians in nanoseconds and, for each
  /// peer, the ratio of its time to limitsurf's.
  void printTable(const std::string& table, const std::string& title,
                  const std::vector<std::string>& field_names,
                  const std::vector<Group>& groups) const;

 private:
  bool has_context_ = false;
  std::map<std::string, std::vector<double>> nanoseconds_;  ///< all repetitions of each benchmark
};

/// Runs the benchmarks of each group with their repetitions interleaved.
void runGroups(const std::vector<Group>& groups, RatioReporter& reporter);

}  // namespace limitsurf::bench
