// SPDX-License-Identifier: Apache-2.0
//
// LimitSurface::curvature().
#include <algorithm>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "limitsurf/batch_parts.h"
#include "limitsurf/number_text.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/curvature/irregular_curvature.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

/// What curvatures are made of.
struct CurvatureInputs {
  explicit CurvatureInputs(Eigen::Index rows)
      : position(rows, 3),
        du(rows, 3),
        dv(rows, 3),
        duu(rows, 3),
        duv(rows, 3),
        dvv(rows, 3),
        normal(rows, 3) {}

  EvaluationArrays<double> arrays(std::size_t rows) {
    return {{position.data(), rows}, {du.data(), rows},  {dv.data(), rows},    {duu.data(), rows},
            {duv.data(), rows},      {dvv.data(), rows}, {normal.data(), rows}};
  }

  FundamentalForms forms(Eigen::Index row) const {
    Jet jet;
    jet.patch.du = padded(du.row(row));
    jet.patch.dv = padded(dv.row(row));
    jet.patch.duu = padded(duu.row(row));
    jet.patch.duv = padded(duv.row(row));
    jet.patch.dvv = padded(dvv.row(row));
    FundamentalForms result = fundamentalForms(jet);
    if (!normal.row(row).allFinite()) {
      result.cross.setZero();
    }
    return result;
  }

  Points position, du, dv, duu, duv, dvv, normal;

 private:
  static Padded padded(const Vector3& vector) { return {vector[0], vector[1], vector[2], 0}; }
};

/// A row that is exactly at an irregular vertex, and the vertex's ring.
struct IrregularRow {
  std::size_t row;
  int ring;
};

void put(const CurvatureArrays& out, std::size_t row, const PrincipalCurvatures& k) {
  out.k1.numbers[row] = k.k1;
  out.k2.numbers[row] = k.k2;
  out.mean.numbers[row] = k.k1 / 2 + k.k2 / 2;
  out.gaussian.numbers[row] = k.k1 * k.k2;
  for (int i = 0; i < 3; ++i) {
    out.direction1.numbers[3 * row + static_cast<std::size_t>(i)] = k.direction1[i];
    out.direction2.numbers[3 * row + static_cast<std::size_t>(i)] = k.direction2[i];
  }
}

void checkCounts(const CurvatureArrays& out, std::size_t rows) {
  const auto check = [&](const char* name, std::size_t count) {
    checkRows(name, static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(rows));
  };
  check("gaussian", out.gaussian.count);
  check("mean", out.mean.count);
  check("k1", out.k1.count);
  check("k2", out.k2.count);
  check("direction1", out.direction1.count);
  check("direction2", out.direction2.count);
  check("irregular", out.irregular.count);
}

}  // namespace

void checkCurvatureRadius(double radius) {
  if (!(radius > 0 && radius <= 0.5)) {
    std::ostringstream message;
    message << "radius is " << numberText(radius) << "; expected more than 0 and at most 0.5";
    throw std::invalid_argument(message.str());
  }
}

Curvature LimitSurface::curvature(const LocationBatch& at, IrregularRule rule, double radius,
                                  int threads) const {
  const auto rows = static_cast<Eigen::Index>(at.size());
  Curvature out;
  for (Eigen::VectorXd* values : {&out.gaussian, &out.mean, &out.k1, &out.k2}) {
    values->resize(rows);
  }
  out.direction1.resize(rows, 3);
  out.direction2.resize(rows, 3);
  out.irregular.resize(rows);
  const std::size_t count = at.size();
  curvature(at,
            {{out.gaussian.data(), count},
             {out.mean.data(), count},
             {out.k1.data(), count},
             {out.k2.data(), count},
             {out.direction1.data(), count},
             {out.direction2.data(), count},
             {out.irregular.data(), count}},
            rule, radius, threads);
  return out;
}

void LimitSurface::curvature(const LocationBatch& at, const CurvatureArrays& results,
                             IrregularRule rule, double radius, int threads) const {
  const LocationBatch checked = checkLocations(at, threads);
  checkCurvatureRadius(radius);
  checkCounts(results, at.size());
  std::vector<IrregularRow> irregular_rows;
  std::mutex mutex;  // of `irregular_rows`
  const auto makePart = [&](std::size_t begin, const LocationBatch& part,
                            const CurvatureInputs& of) {
    TileEvaluator evaluator(data_->table, data_->pose);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::size_t row = begin + i;
      results.irregular.flags[row] = false;
      const Location location = part[i];
      const TileRef tile = data_->table.faces[location.face];
      if (tile.kind != TileRef::kBSpline) {
        const TileLocation place = evaluator.locate(location);
        if (place.atVertex() || TileEvaluator::needsModeProducts(place)) {
          Jet jet;
          evaluator.evaluate<2>(place, jet);
          put(results, row, principalCurvatures(evaluator.fundamentalForms(place, jet)));
          if (place.atVertex()) {
            results.irregular.flags[row] = true;
            const std::lock_guard<std::mutex> lock(mutex);
            irregular_rows.push_back({row, data_->table.ring_tiles[place.tile.index].ring});
          }
          continue;
        }
      }
      put(results, row, principalCurvatures(of.forms(static_cast<Eigen::Index>(i))));
    }
  };
  const auto inputs = [](std::size_t count) {
    return CurvatureInputs(static_cast<Eigen::Index>(count));
  };
  forEachPart(at.size(), threads, inputs,
              [&](std::size_t begin, std::size_t end, CurvatureInputs& of) {
                const LocationBatch part = checked.rows(begin, end - begin);
                evaluate<double>(part, Derivatives::second, of.arrays(part.size()), 1);
                makePart(begin, part, of);
              });
  if (rule == IrregularRule::none || irregular_rows.empty()) {
    return;
  }
  std::vector<int> wanted;
  wanted.reserve(irregular_rows.size());
  for (const IrregularRow& irregular : irregular_rows) {
    wanted.push_back(irregular.ring);
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const IrregularCurvature around(data_->table, data_->pose, data_->ptex, radius);
  const std::vector<PrincipalCurvatures> means = around.around(wanted, threads);
  for (const IrregularRow& irregular : irregular_rows) {
    const auto found = std::lower_bound(wanted.begin(), wanted.end(), irregular.ring);
    put(results, irregular.row, means[static_cast<std::size_t>(found - wanted.begin())]);
  }
}

}  // namespace limitsurf
