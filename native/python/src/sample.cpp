// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "batches.h"
#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "numbers.h"
#include "progress.h"
#include "result_memory.h"
#include "sampling_docstrings.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

/// Writes what a Python function of (face, uv) gives. The thread must hold the GIL.
void writeWeights(const py::object& function, Span<Location> at, double* weights) {
  const auto rows = static_cast<py::ssize_t>(at.size());
  auto face = newArray<int>({rows});
  auto uv = newArray<double>({rows, 2});
  int* faces = face.mutable_data();
  double* uvs = uv.mutable_data();
  for (std::size_t i = 0; i < at.size(); ++i) {
    faces[i] = at[i].face;
    uvs[2 * i] = at[i].u;
    uvs[2 * i + 1] = at[i].v;
  }
  const Doubles values = doubles(maskAsNumbers(function(face, uv)), "density's result");
  if (values.ndim() != 1 || values.shape(0) != rows) {
    throw std::invalid_argument("density returned shape " + shapeText(values) + " for " +
                                std::to_string(rows) + " locations; expected (" +
                                std::to_string(rows) + ",)");
  }
  std::copy(values.data(), values.data() + rows, weights);
}

Density::Function densityFunction(const py::object& function) {
  return [&function](Span<Location> at, double* weights) {
    withGil([&] { writeWeights(function, at, weights); });
  };
}

/// The argument `density_limits`: an array (f,) or (f, side, side), or None.
DensityLimits densityLimits(const py::object& limits) {
  if (limits.is_none()) {
    return {};
  }
  const Doubles array = doubles(limits, "density_limits");
  if (array.ndim() != 1 && (array.ndim() != 3 || array.shape(1) != array.shape(2))) {
    throw std::invalid_argument("density_limits has shape " + shapeText(array) +
                                "; expected (f,) or (f, side, side)");
  }
  const py::ssize_t side = array.ndim() == 1 ? 1 : array.shape(1);
  return DensityLimits(static_cast<int>(std::min<py::ssize_t>(side, 1 << 20)),
                       {array.data(), array.data() + array.size()});
}

/// The argument `density`: None, a function, or weights of the mesh's vertices.
class DensityArgument {
 public:
  DensityArgument(const py::object& density, const py::object& limits)
      : object_(density), limits_(densityLimits(limits)) {
    if (PyCallable_Check(density.ptr())) {
      return;
    }
    if (limits_.areKnown()) {
      throw std::invalid_argument("density_limits are given, but density is not a function");
    }
    if (density.is_none()) {
      return;
    }
    const Doubles array = doubles(maskAsNumbers(density), "density");
    requireVector<std::invalid_argument>(array, "density");
    weights_ = Eigen::Map<const Eigen::VectorXd>(array.data(), array.shape(0));
  }

  /// The density on a surface. It is called without the GIL.
  Density on(const LimitSurface& surface, int threads) const {
    if (weights_) {
      return Density(surface, *weights_, threads);
    }
    return object_.is_none() ? Density() : Density(densityFunction(object_), limits_);
  }

 private:
  const py::object& object_;
  DensityLimits limits_;
  std::optional<Eigen::VectorXd> weights_;
};

/// The result of sample(sampler, density, progress), called without the GIL.
template <typename Sample>
auto sampled(const SharedSurface& shared, const DensityArgument& density, int threads,
             const py::object& progress, const Sample& sample) {
  checkThreads(threads);
  const ProgressReport report(progress);
  const Progress tell = progress.is_none() ? Progress() : Progress(report);
  const LongCall call(shared.lock);
  const AreaSampler& sampler = shared.sampler.get(shared.surface(), threads);
  return sample(sampler, density.on(shared.surface(), threads), tell);
}

py::object area(const SharedSurface& shared, Flag error, int threads) {
  checkThreads(threads);
  SurfaceArea area;
  {
    const LongCall call(shared.lock);
    area = measuredArea(shared.surface(), threads);
  }
  if (error) {
    return py::make_tuple(area.value, area.error);
  }
  return py::float_(area.value);
}

py::object scatterJittered(const SharedSurface& shared, int per_side, std::uint64_t seed,
                           const py::object& faces, int threads) {
  checkThreads(threads);
  Integers chosen;
  if (!faces.is_none()) {
    chosen = integers<LocationError>(faces, "faces");
    requireVector<LocationError>(chosen, "faces");
  }
  const Span<std::int64_t> ids(chosen.data(), static_cast<std::size_t>(chosen.size()));
  Locations at;
  {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    at = faces.is_none()
             ? limitsurf::scatterJittered(shared.surface(), per_side, seed, threads)
             : limitsurf::scatterJittered(shared.surface(), ids, per_side, seed, threads);
  }
  return locations(at);
}

py::object scatterUniform(const SharedSurface& shared, std::int64_t count, std::uint64_t seed,
                          const py::object& density, const py::object& limits, int threads,
                          const py::object& progress) {
  return locations(
      sampled(shared, DensityArgument(density, limits), threads, progress,
              [&](const AreaSampler& sampler, const Density& weights, const Progress& tell) {
                return sampler.uniform(count, seed, weights, threads, tell);
              }));
}

py::object scatterBlueNoise(const SharedSurface& shared, std::optional<std::int64_t> count,
                            std::optional<double> radius, std::uint64_t seed,
                            const py::object& density, const py::object& limits, int threads,
                            const py::object& progress) {
  const BlueNoise noise =
      sampled(shared, DensityArgument(density, limits), threads, progress,
              [&](const AreaSampler& sampler, const Density& weights, const Progress& tell) {
                return sampler.blueNoise({count, radius, seed, weights}, threads, tell);
              });
  const py::object at = locations(noise.at);
  return result("BlueNoise")(at.attr("face"), at.attr("uv"), noise.radius);
}

}  // namespace

void bindSampling(SurfaceClass& type) {
  using namespace py::literals;
  type.def("area", &area, py::kw_only(), "error"_a = false, "threads"_a = 0, kAreaDoc)
      .def("scatter_jittered", &scatterJittered, "per_side"_a, "seed"_a = 0, py::kw_only(),
           "faces"_a = py::none(), "threads"_a = 0, kScatterJitteredDoc)
      .def("scatter_uniform", &scatterUniform, "count"_a, "seed"_a = 0, "density"_a = py::none(),
           py::kw_only(), "density_limits"_a = py::none(), "threads"_a = 0,
           "progress"_a = py::none(), kScatterUniformDoc)
      .def("scatter_blue_noise", &scatterBlueNoise, py::kw_only(), "count"_a = py::none(),
           "radius"_a = py::none(), "seed"_a = 0, "density"_a = py::none(),
           "density_limits"_a = py::none(), "threads"_a = 0, "progress"_a = py::none(),
           kScatterBlueNoiseDoc);
}

}  // namespace limitsurf::python
