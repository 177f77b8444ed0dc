// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/interpolation_benchmarks.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "bench/support/face_classes.h"
#include "bench/support/location_samples.h"
#include "bench/support/median.h"
#include "bench/support/mesh_arrays.h"
#include "bench/support/process_cost.h"
#include "limitsurf/surface/limit_surface.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

constexpr int kRepetitions = 9;

/// A mesh of quads as a subdivision surface of Embree.
class EmbreeSurface {
 public:
  explicit EmbreeSurface(const MeshArrays& cage) : device_(rtcNewDevice("threads=1")) {
    if (!device_) throw std::runtime_error("Embree does not start");
    scene_ = rtcNewScene(device_);
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SUBDIVISION);
    const auto vertices = static_cast<std::size_t>(cage.positions.rows());
    auto* const positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices));
    Eigen::Map<Eigen::VectorXf>(positions, cage.positions.size()) =
        Eigen::Map<const Eigen::VectorXd>(cage.positions.data(), cage.positions.size())
            .cast<float>();
    copy(cage.face_sizes, RTC_BUFFER_TYPE_FACE);
    copy(cage.face_vertices, RTC_BUFFER_TYPE_INDEX);
    rtcSetGeometrySubdivisionMode(geometry_, 0, RTC_SUBDIVISION_MODE_SMOOTH_BOUNDARY);
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }
  ~EmbreeSurface() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeSurface(const EmbreeSurface&) = delete;
  EmbreeSurface& operator=(const EmbreeSurface&) = delete;

  RTCGeometry geometry() const { return geometry_; }

 private:
  void copy(const std::vector<std::int64_t>& from, RTCBufferType type) {
    auto* const to = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry_, type, 0, RTC_FORMAT_UINT, sizeof(unsigned), from.size()));
    std::transform(from.begin(), from.end(), to,
                   [](std::int64_t value) { return static_cast<unsigned>(value); });
  }

  RTCDevice device_;
  RTCScene scene_;
  RTCGeometry geometry_;
};

/// Locations as Embree takes them, and its results: the x of all rows first, then the y and the z.
class EmbreeBatch {
 public:
  explicit EmbreeBatch(const std::vector<Location>& at)
      : faces_(at.size()), u_(at.size()), v_(at.size()) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      faces_[i] = static_cast<unsigned>(at[i].face);
      u_[i] = static_cast<float>(at[i].u);
      v_[i] = static_cast<float>(at[i].v);
    }
    for (std::vector<float>& result : results_) result.resize(3 * at.size());
  }

  void evaluate(const EmbreeSurface& surface, bool with_derivatives) {
    RTCInterpolateNArguments arguments = {};
    arguments.geometry = surface.geometry();
    arguments.primIDs = faces_.data();
    arguments.u = u_.data();
    arguments.v = v_.data();
    arguments.N = static_cast<unsigned>(faces_.size());
    arguments.bufferType = RTC_BUFFER_TYPE_VERTEX;
    arguments.P = results_[0].data();
    arguments.dPdu = with_derivatives ? results_[1].data() : nullptr;
    arguments.dPdv = with_derivatives ? results_[2].data() : nullptr;
    arguments.valueCount = 3;
    rtcInterpolateN(&arguments);
  }

  Points position() const {
    return Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3>>(
               results_[0].data(), static_cast<Eigen::Index>(faces_.size()), 3)
        .cast<double>();
  }

 private:
  std::vector<unsigned> faces_;
  std::vector<float> u_, v_;
  std::vector<float> results_[3];  // the position, du and dv
};

void compare(const char* name, const MeshArrays& cage, const std::vector<Location>& at) {
  const LimitSurface surface(cage.controlMesh());
  const EmbreeSurface theirs(cage);
  EmbreeBatch batch(at);
  for (const bool with_derivatives : {false, true}) {
    const Derivatives order = with_derivatives ? Derivatives::first : Derivatives::none;
    Evaluation limit;
    std::vector<double> our_seconds, their_seconds;
    for (int repetition = 0; repetition < kRepetitions; ++repetition) {
      double before = cpuSeconds();
      limit = surface.evaluate(at, order, false, 1);
      our_seconds.push_back(cpuSeconds() - before);
      before = cpuSeconds();
      batch.evaluate(theirs, with_derivatives);
      their_seconds.push_back(cpuSeconds() - before);
    }
    const double ours = median(our_seconds), other = median(their_seconds);
    const double farthest = (batch.position() - limit.position).rowwise().norm().maxCoeff();
    const double to_ns = 1e9 / static_cast<double>(at.size());
    std::printf("| %s | %s | %.1f | %.1f | %.2f | %.1e |\n", name, with_derivatives ? "P,D1" : "P",
                to_ns * ours, to_ns * other, other / ours, farthest / cage.diagonal());
    std::fflush(stdout);
  }
}

}  // namespace

int measureInterpolation(int count) {
  std::printf(
      "Embree's rtcInterpolateN on one thread, ns per sample; medians of %d\n\n"
      "| face | result | limitsurf | Embree | Embree / ours | its position: max |\n"
      "|---|---|---:|---:|---:|---:|\n",
      kRepetitions);
  const MeshArrays every_class = test::everyClassCage(), crosses = test::crossesCage(),
                   mixed = test::largeCage(144);
  const std::vector<ClassifiedFace> classified = classifyFaces(every_class);
  const auto samples = [&](FaceClass face_class) {
    return uniformSamples(facesOf(classified, face_class), count);
  };
  compare("regular", every_class, samples(FaceClass::regular));
  compare("interior-EV", every_class, samples(FaceClass::interior_ev));
  // Embree 3.13.5 crashes on the open fans of FaceClass::boundary_ev.
  compare("corner", every_class, samples(FaceClass::corner));
  const auto all_faces = [](const MeshArrays& cage) {
    std::vector<int> faces(static_cast<std::size_t>(cage.faceCount()));
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
  };
  compare("multi-EV", crosses, uniformSamples(all_faces(crosses), count));
  compare("mixed-20k-faces", mixed, uniformSamples(all_faces(mixed), count));
  compare("mixed-20k-faces, random order", mixed,
          shuffled(uniformSamples(all_faces(mixed), count)));
  return 0;
}

}  // namespace limitsurf::bench
