// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/poisson_disc_sampling.h"

#include <algorithm>
#include <iterator>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A round has about kTasks tasks, each with so many cells, and reports after so many tasks.
constexpr std::size_t kTasks = 64, kFewestCells = 512, kMostCells = 4096, kTasksPerReport = 32;
/// The number of tiles that one task cuts into first cells.
constexpr std::size_t kTilesPerTask = 64;
/// More first cells than kMostCellsPerPoint for each expected point, and kSpareCells besides, are
/// refused: with well-shaped parameters there is about one for each point.
constexpr double kMostCellsPerPoint = 64, kSpareCells = 1 << 24;
/// More points than expected for which there is memory from the start.
/// Of more than kMostInAdvance, however, it is taken when they are there.
constexpr double kUsualExcess = 1.05, kMostInAdvance = 1 << 22;

}  // namespace

PoissonDiscSampling::PoissonDiscSampling(const SurfacePatches& patches,
                                         const SettlingCores& settling, const Box& box,
                                         const DensityField& density, double radius, double gap,
                                         double expected, std::uint64_t seed, int threads)
    : surface_{patches,
               settling,
               NoiseRadii(density, radius, patches.diagonal()),
               gap,
               kMostCellsPerPoint * expected + kSpareCells,
               {0},
               std::vector<CoreExtent>(static_cast<std::size_t>(patches.tileCount()))},
      key_(keyOf(seed)),
      threads_(threads),
      accepted_(box, surface_.radii.smallest(), surface_.radii.largest()),
      candidates_(box, surface_.radii.smallest(), surface_.radii.largest()) {
  accepted_.reserve(static_cast<std::size_t>(std::min(kUsualExcess * expected, kMostInAdvance)));
}

void PoissonDiscSampling::makeFirstCells() {
  const std::size_t tiles = static_cast<std::size_t>(surface_.patches.tileCount());
  first_cells_.resize((tiles + kTilesPerTask - 1) / kTilesPerTask);
  parallelFor(first_cells_.size(), 1, threads_, [&](std::size_t first, std::size_t last) {
    std::vector<SurfacePiece> pieces;
    for (std::size_t task = first; task < last; ++task) {
      pieces.clear();
      const std::size_t end = std::min(tiles, (task + 1) * kTilesPerTask);
      for (std::size_t tile = task * kTilesPerTask; tile < end; ++tile) {
        surface_.patches.appendPieces(static_cast<int>(tile), pieces);
      }
      CellSplitting splitting(surface_, accepted_);
      std::vector<TrialCell>& cells = first_cells_[task];
      for (const SurfacePiece& piece : pieces) {
        const std::size_t before = cells.size();
        splitting.begin(piece, cells);
        // Cells are counted after every piece, since a single piece may have too many.
        surface_.first_cells += cells.size() - before;
      }
    }
  });
  for (const std::vector<TrialCell>& cells : first_cells_) {
    cells_.add(cells);
  }
}

NoisePoints PoissonDiscSampling::run(const std::function<void(std::size_t points)>& report) {
  makeFirstCells();
  for (; cells_.size() > 0; ++round_) {
    makeTrials(report);
    trials_ += cells_.size();
    accept();
  }
  return {accepted_.takeDiscs(), std::move(points_)};
}

void PoissonDiscSampling::makeTrials(const std::function<void(std::size_t)>& report) {
  const std::uint64_t key = key_ ^ mixed(static_cast<std::uint64_t>(round_));
  const std::size_t cells_per_task = std::clamp(cells_.size() / kTasks, kFewestCells, kMostCells);
  const std::size_t count = (cells_.size() + cells_per_task - 1) / cells_per_task;
  tasks_.resize(count);
  for (std::size_t first = 0; first < count; first += kTasksPerReport) {
    report(points_.size());
    parallelFor(std::min(kTasksPerReport, count - first), 1, threads_,
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t i = first + begin; i < first + end; ++i) {
                    CellTrials::Outcome& outcome = tasks_[i].outcome;
                    outcome.clear();
                    CellTrials trials(surface_, accepted_, key);
                    cells_.visit(i * cells_per_task,
                                 std::min(cells_.size(), (i + 1) * cells_per_task),
                                 [&](Span<TrialCell> cells) { trials.make(cells, outcome); });
                  }
                });
  }
}

void PoissonDiscSampling::accept() {
  std::vector<Span<NoiseDisc>> discs;
  std::size_t first = 0;
  for (Task& task : tasks_) {
    discs.push_back(task.outcome.discs);
    task.first = first;
    first += task.outcome.discs.size();
  }
  candidates_.clear();
  candidates_.insert(discs, threads_);
  candidates_.sortCrowded(threads_);
  for (Task& task : tasks_) {
    std::vector<NoiseDisc>().swap(task.outcome.discs);  // the grid has them now
  }
  parallelFor(tasks_.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      decide(tasks_[i]);
    }
  });
  discs.clear();
  cells_.clear();
  first_cells_.clear();
  last_cells_.resize(tasks_.size());
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    Task& task = tasks_[i];
    discs.push_back(task.discs);
    points_.insert(points_.end(), task.points.begin(), task.points.end());
    last_cells_[i].swap(task.cells);
    cells_.add(last_cells_[i]);
  }
  accepted_.insert(discs, threads_);
}

void PoissonDiscSampling::decide(Task& task) {
  const CellTrials::Outcome& outcome = task.outcome;
  task.discs.clear();
  task.points.clear();
  task.cells.clear();
  const std::size_t count = outcome.candidates.size();
  std::vector<bool> has_won(count, false);
  std::vector<CellSplitting::Hit> hits;
  DiscFinder others(candidates_);
  InterruptionStride stride;
  for (std::size_t i = 0; i < count; ++i) {
    stride.step();
    const std::size_t number = task.first + i;
    if (!others.hasRival(number)) {
      const NoiseDisc& own = candidates_.disc(number);
      hits.push_back({&own, &outcome.candidates[i].cell, false});
      has_won[i] = true;
      task.discs.push_back(own);
      task.discs.back().rank = NoiseDisc::kAccepted;
      task.points.push_back(outcome.candidates[i].at);
    }
  }
  CellSplitting(surface_, accepted_).findCovered(hits);
  std::vector<TrialCell> open;
  for (std::size_t i = 0, hit = 0; i < count; ++i) {
    if (!has_won[i] || !hits[hit++].is_covered) {
      open.push_back(outcome.candidates[i].cell);
    }
  }
  // The cells of a patch come one after the other.
  std::merge(outcome.parts.begin(), outcome.parts.end(), open.begin(), open.end(),
             std::back_inserter(task.cells),
             [](const TrialCell& a, const TrialCell& b) { return a.comesBefore(b); });
}

}  // namespace limitsurf
