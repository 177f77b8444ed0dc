// SPDX-License-Identifier: Apache-2.0
#include "support/truth/golden.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace limitsurf::test {
namespace {

std::filesystem::path folder() { return std::filesystem::path(LIMITSURF_TEST_DATA) / "golden"; }

/// Fans of all valences of one kind of vertex stand in a folder of their own.
std::filesystem::path pathOf(const std::string& name) {
  const std::size_t valence = name.find("_valence");
  const bool is_fan = valence != std::string::npos;
  return folder() / (is_fan ? name.substr(0, valence) : "meshes") / (name + ".golden");
}

/// Takes arrays off the front of the bytes. The files are little-endian, as are the machines that
/// the library is built for.
class Reader {
 public:
  explicit Reader(std::string bytes) : bytes_(std::move(bytes)) {}

  std::map<std::string, std::string> header() {
    const std::string end = "end\n";
    const std::size_t size = bytes_.find(end);
    if (bytes_.rfind("limitsurf-golden 1\n", 0) != 0 || size == std::string::npos) {
      throw std::runtime_error("no golden file");
    }
    std::istringstream lines(bytes_.substr(0, size));
    std::map<std::string, std::string> result;
    for (std::string key, value; lines >> key >> value;) result[key] = value;
    next_ = size + end.size();
    return result;
  }

  template <typename T>
  std::vector<T> take(std::size_t count) {
    std::vector<T> result(count);
    if (next_ + count * sizeof(T) > bytes_.size()) throw std::runtime_error("truncated");
    if (count > 0) std::memcpy(result.data(), bytes_.data() + next_, count * sizeof(T));
    next_ += count * sizeof(T);
    return result;
  }

  bool atEnd() const { return next_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<std::string> goldenNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder())) {
    if (entry.path().extension() == ".golden") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Golden readGolden(const std::string& name) {
  std::ifstream file(pathOf(name), std::ios::binary);
  if (!file) throw std::runtime_error("no golden values of " + name);
  Reader reader(std::string(std::istreambuf_iterator<char>(file), {}));
  std::map<std::string, std::string> header = reader.header();
  const auto count = [&](const char* key) {
    return static_cast<std::size_t>(std::stoul(header.at(key)));
  };

  Golden golden;
  golden.name = name;
  MeshOptions& options = golden.cage.options;
  options.boundary = header.at("boundary") == "corners" ? Boundary::corners : Boundary::smooth;
  options.creasing = header.at("creasing") == "chaikin" ? Creasing::chaikin : Creasing::uniform;
  options.triangles = header.at("triangles") == "smooth" ? Triangles::smooth : Triangles::catmark;

  const std::vector<double> positions = reader.take<double>(3 * count("positions"));
  golden.cage.positions = Eigen::Map<const Points>(positions.data(), positions.size() / 3, 3);
  const std::vector<std::int32_t> sizes = reader.take<std::int32_t>(count("faces"));
  const std::vector<std::int32_t> vertices = reader.take<std::int32_t>(count("face_vertices"));
  auto vertex = vertices.begin();
  for (const std::int32_t size : sizes) {
    golden.cage.faces.emplace_back(vertex, vertex + size);
    vertex += size;
  }
  const std::vector<std::int32_t> edges = reader.take<std::int32_t>(2 * count("sharp_edges"));
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    options.edge_sharpness.edges.emplace_back(edges[i], edges[i + 1]);
  }
  options.edge_sharpness.values = reader.take<double>(count("sharp_edges"));
  for (const std::int32_t sharp : reader.take<std::int32_t>(count("sharp_vertices"))) {
    options.vertex_sharpness.vertices.push_back(sharp);
  }
  options.vertex_sharpness.values = reader.take<double>(count("sharp_vertices"));

  const std::vector<double> uvs = reader.take<double>(2 * count("uvs"));
  const std::size_t samples = count("samples");
  const std::vector<std::uint16_t> faces = reader.take<std::uint16_t>(samples);
  const std::vector<std::uint16_t> uv_rows = reader.take<std::uint16_t>(samples);
  const std::vector<std::uint16_t> states = reader.take<std::uint16_t>(samples);
  const std::vector<double> values = reader.take<double>(3 * count("values"));
  if (!reader.atEnd()) throw std::runtime_error(name + ": bytes left over");

  Golden base;
  if (header.at("base") != "-") base = readGolden(header.at("base"));
  for (Points& rows : golden.values) rows.resize(samples, 3);
  const double* next = values.data();
  for (std::size_t i = 0; i < samples; ++i) {
    golden.at.push_back({faces[i], uvs[2 * uv_rows[i]], uvs[2 * uv_rows[i] + 1]});
    for (int quantity = 0; quantity < kQuantities; ++quantity) {
      auto row = golden.values[quantity].row(i);
      switch ((states[i] >> (2 * quantity)) & 3) {
        case 0:
          row.setConstant(std::numeric_limits<double>::quiet_NaN());
          break;
        case 1:
          row = Eigen::Map<const Eigen::RowVector3d>(next);
          next += 3;
          break;
        default:
          row = base.values[quantity].row(i);
      }
    }
  }
  return golden;
}

}  // namespace limitsurf::test
