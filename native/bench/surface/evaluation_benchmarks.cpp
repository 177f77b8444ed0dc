// SPDX-License-Identifier: Apache-2.0
#include "bench/surface/evaluation_benchmarks.h"

#include <memory>
#include <numeric>
#include <optional>
#include <string>

#include "bench/support/agreement.h"
#include "bench/support/bfr_peer.h"
#include "bench/support/face_classes.h"
#include "bench/support/location_samples.h"
#include "bench/support/mesh_arrays.h"
#include "bench/support/numpy_file.h"
#include "support/cages/benchmark_cages.h"

namespace limitsurf::bench {
namespace {

/// Of the rows of faces "near" an EV.
constexpr Distances kNear = {5, 12};

/// A cage that all libraries open when it is first needed.
class OpenCage {
 public:
  explicit OpenCage(test::Cage (*make)()) : make_(make) {}

  const MeshArrays& cage() { return open().cage; }
  const LimitSurface& ours() { return open().ours; }
  const BfrPeer& bfr(int level) {
    return level == kBfrLevels[0] ? open().bfr_low : open().bfr_high;
  }
  const std::vector<ClassifiedFace>& classified() { return open().classified; }

 private:
  struct Opened {
    explicit Opened(MeshArrays made)
        : cage(std::move(made)),
          ours(cage.controlMesh()),
          topology(farTopology(cage)),
          bfr_low(cage, *topology, kBfrLevels[0]),
          bfr_high(cage, *topology, kBfrLevels[1]),
          classified(classifyFaces(cage)) {}
    MeshArrays cage;
    LimitSurface ours;
    TopologyPointer topology;
    BfrPeer bfr_low, bfr_high;
    std::vector<ClassifiedFace> classified;
  };
  const Opened& open() {
    if (!opened_) opened_ = std::make_unique<Opened>(make_());
    return *opened_;
  }

  test::Cage (*make_)();
  std::unique_ptr<Opened> opened_;
};

/// The samples of a row in both orders, made when they are first needed.
class Samples {
 public:
  Samples(std::string name, std::shared_ptr<OpenCage> cage, std::optional<FaceClass> face_class,
          std::optional<Distances> near_ev, int count)
      : name_(std::move(name)),
        cage_(std::move(cage)),
        face_class_(face_class),
        near_ev_(near_ev),
        count_(count) {}

  const std::string& name() const { return name_; }
  OpenCage& cage() const { return *cage_; }
  const std::vector<Location>& sorted() {
    make();
    return sorted_;
  }
  const std::vector<Location>& shuffled() {
    make();
    return shuffled_;
  }

 private:
  void make() {
    if (!sorted_.empty()) return;
    const std::vector<ClassifiedFace>& classified = cage_->classified();
    std::vector<int> faces(classified.size());
    std::iota(faces.begin(), faces.end(), 0);
    if (face_class_) faces = facesOf(classified, *face_class_);
    sorted_ = near_ev_ ? samplesNearEvs(classified, faces, count_, *near_ev_)
                       : uniformSamples(faces, count_);
    shuffled_ = bench::shuffled(sorted_);
    noteDifference(
        name_ + " (" + std::to_string(faces.size()) + " faces)",
        largestDifference(cage_->cage(), cage_->ours(), cage_->bfr(kBfrLevels[1]), sorted_));
  }

  std::string name_;
  std::shared_ptr<OpenCage> cage_;
  std::optional<FaceClass> face_class_;
  std::optional<Distances> near_ev_;
  int count_;
  std::vector<Location> sorted_, shuffled_;
};

template <Derivatives kDerivatives>
void runOurs(benchmark::State& state, const LimitSurface& surface,
             const std::vector<Location>& samples) {
  for (auto _ : state) {
    const Evaluation result = surface.evaluate(samples, kDerivatives, false, 1);
    benchmark::DoNotOptimize(result.position.data());
    benchmark::ClobberMemory();
  }
  countItems(state, samples.size());
}

template <Derivatives kDerivatives>
void runBfr(benchmark::State& state, const BfrPeer& bfr, const std::vector<Location>& samples) {
  const std::vector<BfrPeer::Coordinate> at = bfr.coordinates(samples);
  // limitsurf's evaluate() returns new arrays each time, which costs page faults; Bfr does not have
  // these here.
  Evaluation result;
  const auto size = [&](std::initializer_list<Points*> members) {
    for (Points* p : members) p->setZero(static_cast<Eigen::Index>(samples.size()), 3);
  };
  size({&result.position});
  if (kDerivatives >= Derivatives::first) size({&result.du, &result.dv});
  if (kDerivatives >= Derivatives::second) size({&result.duu, &result.duv, &result.dvv});
  for (auto _ : state) {
    bfr.evaluate<kDerivatives>(at, result);
    benchmark::DoNotOptimize(result.position.data());
    benchmark::ClobberMemory();
  }
  countItems(state, samples.size());
}

template <Derivatives kDerivatives>
void addGroup(std::vector<Group>& groups, const std::string& row, std::shared_ptr<Samples> samples,
              bool is_random, const char* table = kEvaluationTable) {
  const auto locations = [samples, is_random]() -> const std::vector<Location>& {
    return is_random ? samples->shuffled() : samples->sorted();
  };
  Group group{table, row, {}};
  group.columns.push_back({"limitsurf", [=](benchmark::State& state) {
                             runOurs<kDerivatives>(state, samples->cage().ours(), locations());
                           }});
  for (const int level : kBfrLevels) {
    group.columns.push_back({"Bfr " + std::to_string(level), [=](benchmark::State& state) {
                               runBfr<kDerivatives>(state, samples->cage().bfr(level), locations());
                             }});
  }
  groups.push_back(std::move(group));
}

/// The samples of the rows of the table of evaluation.
std::vector<std::shared_ptr<Samples>> evaluationRows(int sample_count) {
  const auto every_class = std::make_shared<OpenCage>(test::everyClassCage);
  const auto crosses = std::make_shared<OpenCage>(test::crossesCage);
  const auto polygons = std::make_shared<OpenCage>(test::polygonsCage);
  const auto mixed = std::make_shared<OpenCage>(+[] { return test::largeCage(144); });
  struct Row {
    std::string name;
    std::shared_ptr<OpenCage> cage;
    std::optional<FaceClass> face_class;
    std::optional<Distances> near_ev;
  };
  const Row rows[] = {
      {"regular", every_class, FaceClass::regular, {}},
      {"interior-EV", every_class, FaceClass::interior_ev, {}},
      {"boundary-EV", every_class, FaceClass::boundary_ev, {}},
      {"corner", every_class, FaceClass::corner, {}},
      {"multi-EV", crosses, FaceClass::multi_ev, {}},
      {"non-quad", polygons, FaceClass::polygon, {}},
      {"near-interior-EV", every_class, FaceClass::interior_ev, kNear},
      {"near-boundary-EV", every_class, FaceClass::boundary_ev, kNear},
      {"near-corner", every_class, FaceClass::corner, kNear},
      {"mixed-20k-faces", mixed, std::nullopt, {}},
  };
  std::vector<std::shared_ptr<Samples>> samples;
  for (const Row& row : rows) {
    samples.push_back(
        std::make_shared<Samples>(row.name, row.cage, row.face_class, row.near_ev, sample_count));
  }
  return samples;
}

void saveLocations(const std::string& path, const std::vector<Location>& locations) {
  std::vector<std::int64_t> faces;
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv(
      static_cast<Eigen::Index>(locations.size()), 2);
  for (const Location& location : locations) {
    uv.row(static_cast<Eigen::Index>(faces.size())) << location.u, location.v;
    faces.push_back(location.face);
  }
  writeNumpy(path + ".face.npy", faces);
  writeNumpy(path + ".uv.npy", uv);
}

}  // namespace

std::vector<Group> depthGroups(int sample_count) {
  const auto every_class = std::make_shared<OpenCage>(test::everyClassCage);
  std::vector<Group> groups;
  for (const auto& [name, face_class] : {std::pair("interior-EV", FaceClass::interior_ev),
                                         std::pair("boundary-EV", FaceClass::boundary_ev)}) {
    for (const int exponent : {1, 2, 3, 5, 8, 12, 20, 30, 40}) {
      const std::string row = std::string(name) + "/2^-" + std::to_string(exponent) + "/";
      const auto samples = std::make_shared<Samples>(
          row, every_class, face_class, Distances{exponent - 0.5, exponent + 0.5}, sample_count);
      addGroup<Derivatives::none>(groups, row + "P", samples, false, kDepthTable);
      addGroup<Derivatives::first>(groups, row + "P,D1", samples, false, kDepthTable);
      addGroup<Derivatives::second>(groups, row + "P,D1,D2", samples, false, kDepthTable);
    }
  }
  return groups;
}

std::vector<Group> evaluationGroups(int sample_count) {
  std::vector<Group> groups;
  for (const std::shared_ptr<Samples>& samples : evaluationRows(sample_count)) {
    for (const bool is_random : {false, true}) {
      const std::string label = samples->name() + (is_random ? "/random/" : "/sorted/");
      addGroup<Derivatives::none>(groups, label + "P", samples, is_random);
      addGroup<Derivatives::first>(groups, label + "P,D1", samples, is_random);
      addGroup<Derivatives::second>(groups, label + "P,D1,D2", samples, is_random);
    }
  }
  return groups;
}

void saveEvaluation(const std::string& folder, int sample_count) {
  for (const std::shared_ptr<Samples>& samples : evaluationRows(sample_count)) {
    const std::string path = folder + "/" + samples->name();
    samples->cage().cage().save(path);
    saveLocations(path + ".sorted", samples->sorted());
    saveLocations(path + ".random", samples->shuffled());
  }
}

}  // namespace limitsurf::bench
