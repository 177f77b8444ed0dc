// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/sdc/catmarkScheme.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "limitsurf/rules/sharpness_order.h"
#include "limitsurf/rules/subdivision_options.h"

namespace limitsurf {

/// The rule for the new point of a vertex.
enum class VertexRule {
  smooth,  ///< interior
  crease,  ///< a boundary or a crease runs through it
  corner,  ///< pinned
};

/// The options in the form that OpenSubdiv's Sdc takes.
inline OpenSubdiv::Sdc::Options sdcOptions(const SubdivisionOptions& options) {
  using OpenSubdiv::Sdc::Options;
  Options sdc;
  sdc.SetVtxBoundaryInterpolation(options.boundary == Boundary::smooth
                                      ? Options::VTX_BOUNDARY_EDGE_ONLY
                                      : Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  sdc.SetTriangleSubdivision(options.triangles == Triangles::smooth ? Options::TRI_SUB_SMOOTH
                                                                    : Options::TRI_SUB_CATMARK);
  sdc.SetCreasingMethod(options.creasing == Creasing::chaikin ? Options::CREASE_CHAIKIN
                                                              : Options::CREASE_UNIFORM);
  return sdc;
}

inline bool isSharp(float sharpness) { return OpenSubdiv::Sdc::Crease::IsSharp(sharpness); }
inline bool isSemiSharp(float sharpness) { return OpenSubdiv::Sdc::Crease::IsSemiSharp(sharpness); }
inline bool isInfinitelySharp(float sharpness) {
  return OpenSubdiv::Sdc::Crease::IsInfinite(sharpness);
}
/// The value of SHARPNESS_INFINITE of OpenSubdiv's Sdc, which its header does not give at compile
/// time.
constexpr float kInfinitelySharp = 10;

/// The sharpness of a vertex and of its edges, before and after a step.
struct SharpnessAround {
  float vertex = 0, child_vertex = 0;
  std::vector<float> edges, child_edges;
  /// Edges that count in the average of Chaikin's rule alone (SeamSharpness).
  std::vector<float> averaged_edges, averaged_child_edges;

  /// Sets the children of all edges.
  void subdivideEdges(const OpenSubdiv::Sdc::Crease& crease) {
    averaged_child_edges.clear();
    if (averaged_edges.empty()) {
      subdivideSharpness(crease, edges, child_edges);
      return;
    }
    std::vector<float> all = edges;
    all.insert(all.end(), averaged_edges.begin(), averaged_edges.end());
    subdivideSharpness(crease, all, child_edges);
    const auto averaged = child_edges.begin() + static_cast<std::ptrdiff_t>(edges.size());
    averaged_child_edges.assign(averaged, child_edges.end());
    child_edges.resize(edges.size());
  }
};

/// The weights of one Catmull-Clark step, taken from OpenSubdiv's Sdc, in any precision.
/// Face weights belong to the new points of the faces (Sdc calls them "face centers").
template <typename Real>
class SubdivisionRules {
 public:
  explicit SubdivisionRules(const SubdivisionOptions& options = {}) {
    scheme_.SetOptions(sdcOptions(options));
  }

  struct VertexMask {
    Real vertex = 0;
    SmallArray<Real> edges;  ///< for the far ends of the vertex's edges; empty if all are 0
    SmallArray<Real> faces;  ///< for the new points of the vertex's faces; empty if all are 0
  };

  struct EdgeMask {
    Real vertices[2] = {0, 0};
    Real faces[2] = {0, 0};  ///< both 0 on a boundary
  };

  /// The weight of each of a face's `size` vertices in its face point.
  Real faceMask(int size) const {
    Mask mask(size, 0, 0);
    scheme_.ComputeFaceVertexMask(Face{size}, mask);
    return mask.VertexWeight(0);
  }

  /// A smooth edge, or one on a boundary. The sizes of its faces matter for Triangles::smooth
  /// alone.
  EdgeMask edgeMask(bool boundary, int face_size_0 = 4, int face_size_1 = 4) const {
    using OpenSubdiv::Sdc::Crease;
    Mask mask(2, 0, 2);
    const Crease::Rule rule = boundary ? Crease::RULE_CREASE : Crease::RULE_SMOOTH;
    scheme_.ComputeEdgeVertexMask(Edge{boundary ? 1 : 2, {face_size_0, face_size_1}, 0, {0, 0}},
                                  mask, rule, rule);
    return edgeMaskOf(mask);
  }

  /// An edge between two faces. Its sharpness decays to that of its two children.
  EdgeMask edgeMask(float sharpness, const float child_sharpness[2], int face_size_0,
                    int face_size_1) const {
    const Edge edge{
        2, {face_size_0, face_size_1}, sharpness, {child_sharpness[0], child_sharpness[1]}};
    Mask mask(2, 0, 2);
    scheme_.ComputeEdgeVertexMask(edge, mask);
    return edgeMaskOf(mask);
  }

  /// A vertex with `face_count` faces that is sharp or has sharp edges.
  VertexMask vertexMask(const SharpnessAround& around, int face_count) const {
    const SmallArray<int> order = sharpnessOrder(around.edges);
    const SmallArray<float> edges = inOrder(around.edges, order),
                            child_edges = inOrder(around.child_edges, order);
    const Mask sdc = maskOf({static_cast<int>(edges.size()), face_count, around.vertex,
                             around.child_vertex, edges.data(), child_edges.data()});
    VertexMask mask = vertexMaskOf(sdc);  // all faces have the same weight
    if (!order.empty()) {
      for (std::size_t i = 0; i < mask.edges.size(); ++i) {
        mask.edges[static_cast<std::size_t>(order[i])] = sdc.edges[i];
      }
    }
    return mask;
  }

  /// A vertex without semi-sharp edges. Its edges and faces are numbered counter-clockwise; the
  /// first and the last edge of a boundary vertex lie on the boundary.
  VertexMask vertexMask(VertexRule rule, int edge_count) const {
    using OpenSubdiv::Sdc::Crease;
    VertexMask result;
    if (rule == VertexRule::smooth && edge_count > kLargestSquarableValence) {
      // Sdc squares the valence in an int, which would overflow.
      const Real n = static_cast<Real>(edge_count);
      result.vertex = (n - 2) / n;
      result.edges = SmallArray<Real>(static_cast<std::size_t>(edge_count), 1 / (n * n));
      result.faces = result.edges;
      return result;
    }
    Mask mask(1, edge_count, edge_count);
    const Crease::Rule sdc_rule = rule == VertexRule::smooth   ? Crease::RULE_SMOOTH
                                  : rule == VertexRule::crease ? Crease::RULE_CREASE
                                                               : Crease::RULE_CORNER;
    const bool smooth = rule == VertexRule::smooth;
    SmallArray<float> edges(static_cast<std::size_t>(edge_count), 0);
    if (rule == VertexRule::crease) {
      edges[0] = edges[edges.size() - 1] = kInfinitelySharp;
    }
    scheme_.ComputeVertexVertexMask(
        Vertex{edge_count, smooth ? edge_count : edge_count - 1, 0, 0, edges.data(), edges.data()},
        mask, sdc_rule, sdc_rule);
    return vertexMaskOf(mask);
  }

 private:
  /// The largest integer whose square fits into 32 bits.
  static constexpr int kLargestSquarableValence = 46340;

  // The classes that Sdc's templates take for neighbourhoods and masks.
  struct Face {
    int size;
    int GetNumVertices() const { return size; }
  };

  struct Edge {
    int face_count;
    int face_sizes[2];
    float sharpness;
    float child_sharpness[2];
    int GetNumFaces() const { return face_count; }
    float GetSharpness() const { return sharpness; }
    void GetChildSharpnesses(const OpenSubdiv::Sdc::Crease&, float out[2]) const {
      out[0] = child_sharpness[0];
      out[1] = child_sharpness[1];
    }
    void GetNumVerticesPerFace(int out[]) const {
      out[0] = face_sizes[0];
      out[1] = face_sizes[1];
    }
  };

  struct Vertex {
    int edge_count, face_count;
    float sharpness, child_sharpness;
    const float* edges;
    const float* child_edges;
    int GetNumEdges() const { return edge_count; }
    int GetNumFaces() const { return face_count; }
    float GetSharpness() const { return sharpness; }
    float* GetSharpnessPerEdge(float out[]) const {
      return std::copy_n(edges, edge_count, out), out;
    }
    float GetChildSharpness(const OpenSubdiv::Sdc::Crease&) const { return child_sharpness; }
    float* GetChildSharpnessPerEdge(const OpenSubdiv::Sdc::Crease&, float out[]) const {
      return std::copy_n(child_edges, edge_count, out), out;
    }
  };

  struct Mask {
    using Weight = Real;
    SmallArray<Real> vertices, edges, faces;
    bool vertex_count = false, edge_count = false, face_count = false, centers = false;

    Mask(int v, int e, int f)
        : vertices(static_cast<std::size_t>(v)),
          edges(static_cast<std::size_t>(e)),
          faces(static_cast<std::size_t>(f)) {}
    int GetNumVertexWeights() const { return vertex_count ? int(vertices.size()) : 0; }
    int GetNumEdgeWeights() const { return edge_count ? int(edges.size()) : 0; }
    int GetNumFaceWeights() const { return face_count ? int(faces.size()) : 0; }
    void SetNumVertexWeights(int count) { vertex_count = count > 0; }
    void SetNumEdgeWeights(int count) { edge_count = count > 0; }
    void SetNumFaceWeights(int count) { face_count = count > 0; }
    bool AreFaceWeightsForFaceCenters() const { return centers; }
    void SetFaceWeightsForFaceCenters(bool on) { centers = on; }
    Real& VertexWeight(int i) { return vertices[i]; }
    Real& EdgeWeight(int i) { return edges[i]; }
    Real& FaceWeight(int i) { return faces[i]; }
    const Real& VertexWeight(int i) const { return vertices[i]; }
    const Real& EdgeWeight(int i) const { return edges[i]; }
    const Real& FaceWeight(int i) const { return faces[i]; }
  };

  Mask maskOf(const Vertex& vertex) const {
    Mask mask(1, vertex.edge_count, vertex.edge_count);
    scheme_.ComputeVertexVertexMask(vertex, mask);
    return mask;
  }

  static EdgeMask edgeMaskOf(const Mask& mask) {
    EdgeMask result;
    for (int i = 0; i < 2; ++i) {
      result.vertices[i] = mask.VertexWeight(i);
      result.faces[i] = mask.GetNumFaceWeights() ? mask.FaceWeight(i) : Real(0);
    }
    return result;
  }

  static VertexMask vertexMaskOf(const Mask& mask) {
    VertexMask result;
    result.vertex = mask.VertexWeight(0);
    if (mask.GetNumEdgeWeights()) {
      result.edges = mask.edges;
    }
    if (mask.GetNumFaceWeights()) {
      result.faces = mask.faces;
    }
    return result;
  }

  OpenSubdiv::Sdc::Scheme<OpenSubdiv::Sdc::SCHEME_CATMARK> scheme_;
};

}  // namespace limitsurf
