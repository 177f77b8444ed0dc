// SPDX-License-Identifier: Apache-2.0
#include "edge_curves.h"

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "batches.h"
#include "bound_class.h"
#include "choices.h"
#include "edge_curves_docstrings.h"
#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/curves/scatter_along.h"
#include "numbers.h"
#include "progress.h"
#include "text.h"

namespace limitsurf::python {
namespace {

/// Curves, the surface, which lives as long as they do, and the pose of which they were made.
struct BoundEdgeCurves {
  BoundEdgeCurves(const SharedSurface& of, EdgeCurves made)
      : surface_(of.shared_from_this()), pose_(of.pose()), curves_(std::move(made)) {}

  const EdgeCurves& curves() const { return curves_; }
  const SharedSurface& surface() const { return *surface_; }

  /// Throws unless they were made of this surface, as it is now posed. Its lock must be held.
  void check(const SharedSurface& of) const {
    if (&of != surface_.get()) {
      throw std::invalid_argument(
          "the curves were made by another surface: call edge_curves() of this one");
    }
    if (of.pose() != pose_) {
      throw std::invalid_argument(
          "set_positions() has posed the surface since the curves were made: call edge_curves() "
          "again");
    }
  }

 private:
  std::shared_ptr<const SharedSurface> surface_;
  std::uint64_t pose_;
  EdgeCurves curves_;
};

CurveSide sideOf(const std::string& side) {
  if (side != "left" && side != "right") {
    throw std::invalid_argument("side is '" + shortened(side) + "'; expected 'left' or 'right'");
  }
  return side == "left" ? CurveSide::left : CurveSide::right;
}

std::unique_ptr<BoundEdgeCurves> makeCurves(const SharedSurface& shared, const py::object& edges,
                                            int threads) {
  checkThreads(threads);
  std::optional<EdgeChoice> chosen;
  std::vector<std::pair<std::int64_t, std::int64_t>> given;
  if (py::isinstance<py::str>(edges)) {
    chosen =
        choice<EdgeChoice>(edges.cast<Text>(), "edges",
                           {{"boundary", EdgeChoice::boundary}, {"creases", EdgeChoice::creases}});
  } else {
    given = pairsOf(edges, "edges");
  }
  const LongCall call(shared.lock);
  return std::make_unique<BoundEdgeCurves>(shared,
                                           chosen ? EdgeCurves(shared.surface(), *chosen, threads)
                                                  : EdgeCurves(shared.surface(), given, threads));
}

py::object along(const AlongCurves& found) {
  const py::object at = locations(found.at);
  return result("AlongCurves")(at.attr("face"), at.attr("uv"), arrayOf(found.curve),
                               arrayOf(found.arc), pointArray(found.tangent),
                               pointArray(found.outward), arrayOf(found.row), arrayOf(found.ended));
}

py::object curvesAt(const BoundEdgeCurves& self, const py::object& curve, const py::object& arc,
                    const Text& side, int threads) {
  checkThreads(threads);
  const CurveSide on = sideOf(side);
  const Doubles arcs = doubles(arc, "arc");
  requireVector<std::invalid_argument>(arcs, "arc");
  Integers numbers = integers<std::invalid_argument>(curve, "curve");
  if (numbers.ndim() == 0) {
    const std::int64_t number = *numbers.data();
    numbers = Integers(arcs.shape(0));
    std::fill_n(numbers.mutable_data(), arcs.shape(0), number);
  }
  requireVector<std::invalid_argument>(numbers, "curve");
  if (numbers.shape(0) != arcs.shape(0)) {
    throw std::invalid_argument("curve has shape " + shapeText(numbers) + " and arc " +
                                shapeText(arcs) + "; expected as many rows");
  }
  const std::vector<std::int64_t> rows(numbers.data(), numbers.data() + numbers.size());
  const std::vector<double> lengths(arcs.data(), arcs.data() + arcs.size());
  AlongCurves found;
  {
    const LongCall call(self.surface().lock);
    self.check(self.surface());
    found = pointsAlong(self.surface().surface(), self.curves(), rows, lengths, on, threads);
  }
  return along(found);
}

py::object scatterAlong(const SharedSurface& shared, const BoundEdgeCurves& curves,
                        std::optional<std::int64_t> count, std::optional<double> spacing,
                        double jitter, std::uint64_t seed, std::optional<double> phase,
                        const Text& side, int rows, double row_distance, int threads,
                        const py::object& progress) {
  checkThreads(threads);
  AlongOptions options;
  options.rows = rows;
  options.row_distance = row_distance;
  options.count = count;
  options.spacing = spacing;
  options.jitter = jitter;
  options.phase = phase;
  options.seed = seed;
  options.side = sideOf(side);
  const ProgressReport report(progress);
  const Progress tell = progress.is_none() ? Progress() : Progress(report);
  AlongCurves found;
  {
    const LongCall call(shared.lock);
    curves.check(shared);
    found = limitsurf::scatterAlong(shared.surface(), curves.curves(), options, threads, tell);
  }
  return along(found);
}

/// (k, 2) int32 of a pair of numbers for each edge.
template <typename Pair>
py::array_t<int> edgePairs(const BoundEdgeCurves& self, const Pair& pair) {
  const EdgeCurves& curves = self.curves();
  py::array_t<int> rows({static_cast<py::ssize_t>(curves.edgeCount()), py::ssize_t{2}});
  int* out = rows.mutable_data();
  for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
    const std::pair<int, int> values = pair(curves, edge);
    *out++ = values.first;
    *out++ = values.second;
  }
  return rows;
}

py::array_t<double> lengthsOf(const BoundEdgeCurves& self) {
  std::vector<double> lengths;
  lengths.reserve(static_cast<std::size_t>(self.curves().count()));
  for (int curve = 0; curve < self.curves().count(); ++curve) {
    lengths.push_back(self.curves().length(curve));
  }
  return arrayOf(lengths);
}

py::array_t<double> edgeLengthsOf(const BoundEdgeCurves& self) {
  std::vector<double> lengths;
  lengths.reserve(static_cast<std::size_t>(self.curves().edgeCount()));
  for (std::int64_t edge = 0; edge < self.curves().edgeCount(); ++edge) {
    lengths.push_back(self.curves().edgeLength(edge));
  }
  return arrayOf(lengths);
}

py::array_t<bool> closedOf(const BoundEdgeCurves& self) {
  py::array_t<bool> flags(self.curves().count());
  for (int curve = 0; curve < self.curves().count(); ++curve) {
    flags.mutable_at(curve) = self.curves().closed(curve);
  }
  return flags;
}

}  // namespace

void bindEdgeCurves(py::module_& module) {
  using namespace py::literals;
  boundClass<py::class_<BoundEdgeCurves>>(module, "EdgeCurves", kEdgeCurvesDoc)
      .def("__len__", [](const BoundEdgeCurves& self) { return self.curves().count(); })
      .def_property_readonly("lengths", &lengthsOf,
                             "(c,) float64: the arc length of each curve, in units of the mesh. "
                             "Relative error: 1e-9.")
      .def_property_readonly("closed", &closedOf,
                             "(c,) bool: whether each curve ends where it began and goes on there.")
      .def_property_readonly(
          "offsets", [](const BoundEdgeCurves& self) { return arrayOf(self.curves().offsets()); },
          "(c + 1,) int64: the edges of curve i are rows offsets[i] to offsets[i + 1] - 1.")
      .def_property_readonly(
          "edges",
          [](const BoundEdgeCurves& self) {
            return edgePairs(self, [](const EdgeCurves& curves, std::int64_t edge) {
              return curves.edgeVertices(edge);
            });
          },
          "(k, 2) int32: the vertices of each edge, in the direction of its curve.")
      .def_property_readonly(
          "faces",
          [](const BoundEdgeCurves& self) {
            return edgePairs(self, [](const EdgeCurves& curves, std::int64_t edge) {
              return std::pair<int, int>(curves.edgeFace(edge, CurveSide::left),
                                         curves.edgeFace(edge, CurveSide::right));
            });
          },
          "(k, 2) int32: the faces of the mesh on the left and on the right of each edge, as seen "
          "along "
          "the curve from outside; -1 where there is none that has a limit surface.")
      .def_property_readonly("edge_lengths", &edgeLengthsOf,
                             "(k,) float64: the arc length of each edge. Relative error: 1e-9.")
      .def_property_readonly(
          "left_out", [](const BoundEdgeCurves& self) { return self.curves().leftOut(); },
          "The number of edges that were left out because they have no limit surface.")
      .def("at", &curvesAt, "curve"_a, "arc"_a, "side"_a = "left", py::kw_only(), "threads"_a = 0,
           kEdgeCurvesAtDoc);
}

void bindEdgeCurveMakers(SurfaceClass& type) {
  using namespace py::literals;
  type.def("edge_curves", &makeCurves, "edges"_a = "boundary", py::kw_only(), "threads"_a = 0,
           kEdgeCurvesMakerDoc)
      .def("scatter_along", &scatterAlong, "curves"_a, "count"_a = py::none(),
           "spacing"_a = py::none(), "jitter"_a = 0., "seed"_a = 0, py::kw_only(),
           "phase"_a = py::none(), "side"_a = "left", "rows"_a = 1, "row_distance"_a = 0.,
           "threads"_a = 0, "progress"_a = py::none(), kScatterAlongDoc);
}

}  // namespace limitsurf::python
