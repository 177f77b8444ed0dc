// SPDX-License-Identifier: Apache-2.0
#include "control_mesh.h"

#include <map>

#include "arrays.h"
#include "bound_class.h"
#include "choices.h"
#include "docstrings.h"
#include "elements.h"
#include "locks/signals.h"
#include "text.h"

namespace limitsurf::python {
namespace {

const Choices<Boundary> kBoundaries = {{"smooth", Boundary::smooth},
                                       {"corners", Boundary::corners}};
const Choices<Creasing> kCreasings = {{"uniform", Creasing::uniform},
                                      {"chaikin", Creasing::chaikin}};
const Choices<Triangles> kTriangles = {{"catmark", Triangles::catmark},
                                       {"smooth", Triangles::smooth}};
const Choices<Scheme> kSchemes = {{"catmark", Scheme::catmark}, {"bilinear", Scheme::bilinear}};

template <typename Enum>
std::string text(Enum value, const Choices<Enum>& choices) {
  for (const auto& [name, known] : choices) {
    if (known == value) {
      return name;
    }
  }
  return {};
}

std::vector<std::int64_t> vectorOf(const Integers& array) {
  return {array.data(), array.data() + array.size()};
}

/// The two entries of an argument; [] stands for two empty arrays.
std::pair<py::object, py::object> pairOf(const py::object& object, const char* name) {
  if (!py::isinstance<py::iterable>(object)) {
    throw py::type_error(std::string(name) + " is " + valueText(object) + "; expected two arrays");
  }
  const py::tuple pair = py::tuple(object);
  if (pair.empty()) {
    return {py::list(), py::list()};
  }
  if (pair.size() != 2) {
    throw MeshError(std::string(name) + " has " + std::to_string(pair.size()) +
                    " entries; expected two arrays");
  }
  return {pair[0], pair[1]};
}

std::vector<double> sharpnessValues(const py::object& object, const char* name) {
  const Doubles values = doubles(object, name);
  requireVector<MeshError>(values, name);
  return {values.data(), values.data() + values.size()};
}

MeshOptions meshOptions(const py::object& edge_sharpness, const py::object& vertex_sharpness,
                        const Text& boundary, const Text& creasing, const Text& triangles,
                        const Text& scheme, const py::object& holes) {
  MeshOptions options;
  options.boundary = choice(boundary, "boundary", kBoundaries);
  options.creasing = choice(creasing, "creasing", kCreasings);
  options.triangles = choice(triangles, "triangles", kTriangles);
  options.scheme = choice(scheme, "scheme", kSchemes);
  if (!edge_sharpness.is_none()) {
    const auto [edges_object, values] = pairOf(edge_sharpness, "edge_sharpness");
    options.edge_sharpness.edges = pairsOf(edges_object, "edge_sharpness edges");
    options.edge_sharpness.values = sharpnessValues(values, "edge_sharpness values");
  }
  if (!vertex_sharpness.is_none()) {
    const auto [vertices, values] = pairOf(vertex_sharpness, "vertex_sharpness");
    const Integers array = integers<MeshError>(vertices, "vertex_sharpness vertices");
    requireVector<MeshError>(array, "vertex_sharpness vertices");
    options.vertex_sharpness.vertices = vectorOf(array);
    options.vertex_sharpness.values = sharpnessValues(values, "vertex_sharpness values");
  }
  if (!holes.is_none()) {
    const Integers array = integers<MeshError>(holes, "holes");
    requireVector<MeshError>(array, "holes");
    options.holes = vectorOf(array);
  }
  return options;
}

Points positionsOf(const py::object& object) {
  Doubles array = doubles(object, "positions");
  shapeEmpty(array, {0, 3});
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw MeshError("positions has shape " + shapeText(array) + "; expected (V, 3)");
  }
  return pointsOf(array);
}

std::shared_ptr<BoundMesh> makeMesh(const py::object& positions, const py::object& face_sizes,
                                    const py::object& face_vertices, const MeshOptions& options) {
  const Points points = positionsOf(positions);
  const Integers sizes = integers<MeshError>(face_sizes, "face_sizes");
  const Integers vertices = integers<MeshError>(face_vertices, "face_vertices");
  requireVector<MeshError>(sizes, "face_sizes");
  requireVector<MeshError>(vertices, "face_vertices");
  const std::vector<std::int64_t> size_vector = vectorOf(sizes), vertex_vector = vectorOf(vertices);
  const GilRelease release;
  const InterruptionPoint point = interruptible();
  return std::shared_ptr<BoundMesh>(new BoundMesh(points, size_vector, vertex_vector, options));
}

/// Appends the elements of a list or a tuple of Python's own integers below 2^63, the commonest
/// face. Of anything else it appends nothing and returns false.
bool appendIntegers(const py::handle& object, std::vector<std::int64_t>& numbers) {
  if (!PyList_CheckExact(object.ptr()) && !PyTuple_CheckExact(object.ptr())) {
    return false;
  }
  const std::size_t before = numbers.size();
  PyObject* const* const elements = PySequence_Fast_ITEMS(object.ptr());
  for (Py_ssize_t i = 0; i < PySequence_Fast_GET_SIZE(object.ptr()); ++i) {
    int overflow = 1;
    if (PyLong_CheckExact(elements[i])) {
      numbers.push_back(PyLong_AsLongLongAndOverflow(elements[i], &overflow));
    }
    if (overflow != 0) {
      numbers.resize(before);
      return false;
    }
  }
  return true;
}

/// The face sizes and face vertices of an (F, k) array or of a sequence of sequences.
std::pair<py::object, py::object> flattened(const py::object& faces) {
  const py::module_ numpy = py::module_::import("numpy");
  if (isReadAsArray(faces)) {
    const Integers array = integers<MeshError>(faces, "faces");
    if (array.ndim() != 2) {
      throw MeshError("faces has shape " + shapeText(array) + "; expected (F, k)");
    }
    return {numpy.attr("full")(array.shape(0), array.shape(1)), array.attr("ravel")()};
  }
  if (!py::isinstance<py::iterable>(faces)) {
    throw py::type_error("faces is " + valueText(faces) + "; expected lists of vertex indices");
  }
  std::vector<std::int64_t> sizes, vertices;
  for (const py::handle face : py::iter(faces)) {
    if (sizes.size() % 4096 == 0 && PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
    const std::size_t before = vertices.size();
    if (!appendIntegers(face, vertices)) {
      const std::string name = "faces[" + std::to_string(sizes.size()) + "]";
      const Integers corner_vertices = integers<MeshError>(face, name.c_str());
      requireVector<MeshError>(corner_vertices, name.c_str());
      vertices.insert(vertices.end(), corner_vertices.data(),
                      corner_vertices.data() + corner_vertices.size());
    }
    sizes.push_back(static_cast<std::int64_t>(vertices.size() - before));
  }
  return {arrayOf(sizes), arrayOf(vertices)};
}

/// The message of an error about the arguments face_sizes or face_vertices, of which from_faces()
/// has made its one argument `faces`.
std::string namingFaces(const std::string& message) {
  for (const std::string begin : {"face_sizes: ", "face_vertices: "}) {
    if (message.compare(0, begin.size(), begin) == 0) {
      return "faces: " + message.substr(begin.size());
    }
  }
  return message;
}

py::object edgeSharpness(const ControlMesh& mesh) {
  const EdgeSharpness& sharpness = mesh.options().edge_sharpness;
  py::array_t<std::int64_t> edges(
      {static_cast<py::ssize_t>(sharpness.edges.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < sharpness.edges.size(); ++i) {
    edges.mutable_data()[2 * i] = sharpness.edges[i].first;
    edges.mutable_data()[2 * i + 1] = sharpness.edges[i].second;
  }
  return py::make_tuple(edges, arrayOf(sharpness.values));
}

py::object vertexSharpness(const ControlMesh& mesh) {
  const VertexSharpness& sharpness = mesh.options().vertex_sharpness;
  return py::make_tuple(arrayOf(sharpness.vertices), arrayOf(sharpness.values));
}

py::tuple state(const ControlMesh& mesh) {
  const MeshOptions& o = mesh.options();
  return py::make_tuple(pointArray(mesh.positions()), arrayOf(mesh.faceSizes()),
                        arrayOf(mesh.faceVertices()), edgeSharpness(mesh), vertexSharpness(mesh),
                        text(o.boundary, kBoundaries), text(o.creasing, kCreasings),
                        text(o.triangles, kTriangles), text(o.scheme, kSchemes), arrayOf(o.holes));
}

using MeshClass = py::class_<BoundMesh, std::shared_ptr<BoundMesh>>;

void bindConstructors(MeshClass& type) {
  using namespace py::literals;
  type.def(py::init([](const py::object& positions, const py::object& face_sizes,
                       const py::object& face_vertices, const py::object& edge_sharpness,
                       const py::object& vertex_sharpness, const Text& boundary,
                       const Text& creasing, const Text& triangles, const Text& scheme,
                       const py::object& holes) {
             return makeMesh(positions, face_sizes, face_vertices,
                             meshOptions(edge_sharpness, vertex_sharpness, boundary, creasing,
                                         triangles, scheme, holes));
           }),
           "positions"_a, "face_sizes"_a, "face_vertices"_a, "edge_sharpness"_a = py::none(),
           "vertex_sharpness"_a = py::none(), "boundary"_a = "smooth", "creasing"_a = "uniform",
           "triangles"_a = "catmark", "scheme"_a = "catmark", "holes"_a = py::none())
      .def_static(
          "from_faces",
          [](const py::object& positions, const py::object& faces, const py::object& edge_sharpness,
             const py::object& vertex_sharpness, const Text& boundary, const Text& creasing,
             const Text& triangles, const Text& scheme, const py::object& holes) {
            const auto [sizes, vertices] = flattened(faces);
            const MeshOptions options = meshOptions(edge_sharpness, vertex_sharpness, boundary,
                                                    creasing, triangles, scheme, holes);
            try {
              return makeMesh(positions, sizes, vertices, options);
            } catch (const MeshError& error) {
              throw MeshError(namingFaces(error.what()));
            }
          },
          "positions"_a, "faces"_a, "edge_sharpness"_a = py::none(),
          "vertex_sharpness"_a = py::none(), "boundary"_a = "smooth", "creasing"_a = "uniform",
          "triangles"_a = "catmark", "scheme"_a = "catmark", "holes"_a = py::none(), kFromFacesDoc);
}

void bindArrays(MeshClass& type) {
  type.def_property_readonly(
          "positions", [](const BoundMesh& mesh) { return pointArray(mesh.positions()); },
          "(V, 3) float64: a copy of the positions.")
      .def_property_readonly(
          "face_sizes", [](const BoundMesh& mesh) { return arrayOf(mesh.faceSizes()); },
          "(F,) int32: the number of vertices of each face.")
      .def_property_readonly(
          "face_vertices", [](const BoundMesh& mesh) { return arrayOf(mesh.faceVertices()); },
          "int32: the vertex indices of all faces, one face after the other.");
}

void bindOptions(MeshClass& type) {
  type.def_property_readonly(
          "boundary",
          [](const BoundMesh& mesh) { return text(mesh.options().boundary, kBoundaries); },
          "The boundary rule, 'smooth' or 'corners'.")
      .def_property_readonly(
          "triangles",
          [](const BoundMesh& mesh) { return text(mesh.options().triangles, kTriangles); },
          "The rule for triangles, 'catmark' or 'smooth'.")
      .def_property_readonly(
          "creasing",
          [](const BoundMesh& mesh) { return text(mesh.options().creasing, kCreasings); },
          "The creasing method, 'uniform' or 'chaikin'.")
      .def_property_readonly(
          "scheme", [](const BoundMesh& mesh) { return text(mesh.options().scheme, kSchemes); },
          "The subdivision scheme, 'catmark' or 'bilinear'.")
      .def_property_readonly(
          "edge_sharpness", [](const BoundMesh& mesh) { return edgeSharpness(mesh); },
          "The given sharpness of edges: edges (E, 2) int64 and values (E,) float64.")
      .def_property_readonly(
          "vertex_sharpness", [](const BoundMesh& mesh) { return vertexSharpness(mesh); },
          "The given sharpness of vertices: vertices (n,) int64 and values (n,) float64.")
      .def_property_readonly(
          "holes", [](const BoundMesh& mesh) { return arrayOf(mesh.options().holes); },
          "int64: the faces that are holes and have no surface.");
}

Text ruleOfState(const py::handle& part) {
  try {
    return py::cast<Text>(part);
  } catch (const py::cast_error&) {
    throw py::value_error("no state of a ControlMesh: the name of a rule is no text");
  }
}

std::shared_ptr<BoundMesh> meshOfState(const py::object& given) {
  const py::tuple s = stateTuple(given, "ControlMesh");
  if (s.size() != 10) {
    throw py::value_error("no state of a ControlMesh: it has " + std::to_string(s.size()) +
                          " parts instead of 10");
  }
  return makeMesh(s[0], s[1], s[2],
                  meshOptions(s[3], s[4], ruleOfState(s[5]), ruleOfState(s[6]), ruleOfState(s[7]),
                              ruleOfState(s[8]), s[9]));
}

std::string description(const BoundMesh& mesh) {
  return "ControlMesh(" + std::to_string(mesh.vertexCount()) + " vertices, " +
         std::to_string(mesh.faceCount()) + " faces, boundary='" +
         text(mesh.options().boundary, kBoundaries) + "')";
}

}  // namespace

void bindControlMesh(py::module_& module) {
  auto type = boundClass<MeshClass>(module, "ControlMesh", kControlMeshDoc);
  bindConstructors(type);
  bindArrays(type);
  bindOptions(type);
  type.def("__repr__", &description)
      .def(py::pickle([](const BoundMesh& mesh) -> py::object { return state(mesh); },
                      &meshOfState));
}

}  // namespace limitsurf::python
