// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/sdc/catmarkScheme.h>

#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// Which rule moves a vertex.
enum class VertexRule {
  smooth,  ///< interior
  crease,  ///< a boundary curve runs through it
  corner,  ///< pinned
};

/// Weights of one Catmull-Clark step, taken from OpenSubdiv's Sdc, in any precision.
/// Face weights apply to the new face points (Sdc's "face centers").
template <typename Real>
class SubdivisionRules {
 public:
  explicit SubdivisionRules(Triangles triangles = Triangles::catmark) {
    OpenSubdiv::Sdc::Options options;
    if (triangles == Triangles::smooth) {
      options.SetTriangleSubdivision(OpenSubdiv::Sdc::Options::TRI_SUB_SMOOTH);
    }
    scheme_.SetOptions(options);
  }

  struct VertexMask {
    Real vertex = 0;
    std::vector<Real> edges;  ///< of the far ends of the vertex's edges; empty: all 0
    std::vector<Real> faces;  ///< of the new points of the vertex's faces; empty: all 0
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

  /// `face_sizes`: the two faces' sizes, which only Triangles::smooth looks at.
  EdgeMask edgeMask(bool boundary, int face_size_0 = 4, int face_size_1 = 4) const {
    using OpenSubdiv::Sdc::Crease;
    Mask mask(2, 0, 2);
    const Crease::Rule rule = boundary ? Crease::RULE_CREASE : Crease::RULE_SMOOTH;
    scheme_.ComputeEdgeVertexMask(Edge{boundary ? 1 : 2, {face_size_0, face_size_1}}, mask, rule,
                                  rule);
    EdgeMask result;
    for (int i = 0; i < 2; ++i) {
      result.vertices[i] = mask.VertexWeight(i);
      result.faces[i] = mask.GetNumFaceWeights() ? mask.FaceWeight(i) : Real(0);
    }
    return result;
  }

  /// Edges and faces are counted counter-clockwise; on a boundary the first and last edge lie on
  /// it.
  VertexMask vertexMask(VertexRule rule, int edge_count) const {
    using OpenSubdiv::Sdc::Crease;
    VertexMask result;
    if (rule == VertexRule::smooth && edge_count > kLargestSquarableValence) {
      // Sdc squares the valence in an int.
      const Real n = static_cast<Real>(edge_count);
      result.vertex = (n - 2) / n;
      result.edges.assign(edge_count, 1 / (n * n));
      result.faces = result.edges;
      return result;
    }
    Mask mask(1, edge_count, edge_count);
    const Crease::Rule sdc_rule = rule == VertexRule::smooth   ? Crease::RULE_SMOOTH
                                  : rule == VertexRule::crease ? Crease::RULE_CREASE
                                                               : Crease::RULE_CORNER;
    const bool smooth = rule == VertexRule::smooth;
    scheme_.ComputeVertexVertexMask(Vertex{edge_count, smooth ? edge_count : edge_count - 1}, mask,
                                    sdc_rule, sdc_rule);
    result.vertex = mask.VertexWeight(0);
    if (mask.GetNumEdgeWeights()) {
      result.edges = mask.edges;
    }
    if (mask.GetNumFaceWeights()) {
      result.faces = mask.faces;
    }
    return result;
  }

 private:
  static constexpr int kLargestSquarableValence = 46340;

  // The neighbourhoods and the mask that Sdc's templates ask for.
  struct Face {
    int size;
    int GetNumVertices() const { return size; }
  };

  struct Edge {
    int face_count;
    int face_sizes[2];
    int GetNumFaces() const { return face_count; }
    float GetSharpness() const { return 0; }
    void GetChildSharpnesses(const OpenSubdiv::Sdc::Crease&, float out[2]) const {
      out[0] = out[1] = 0;
    }
    void GetNumVerticesPerFace(int out[]) const {
      out[0] = face_sizes[0];
      out[1] = face_sizes[1];
    }
  };

  struct Vertex {
    int edge_count, face_count;
    int GetNumEdges() const { return edge_count; }
    int GetNumFaces() const { return face_count; }
    float GetSharpness() const { return 0; }
    float* GetSharpnessPerEdge(float out[]) const {
      for (int i = 0; i < edge_count; ++i) {
        const bool on_boundary = face_count < edge_count && (i == 0 || i == edge_count - 1);
        out[i] = on_boundary ? OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE : 0;
      }
      return out;
    }
    float GetChildSharpness(const OpenSubdiv::Sdc::Crease&) const { return 0; }
    float* GetChildSharpnessPerEdge(const OpenSubdiv::Sdc::Crease&, float out[]) const {
      return GetSharpnessPerEdge(out);
    }
  };

  struct Mask {
    using Weight = Real;
    std::vector<Real> vertices, edges, faces;
    bool vertex_count = false, edge_count = false, face_count = false, centers = false;

    Mask(int v, int e, int f) : vertices(v), edges(e), faces(f) {}
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

  OpenSubdiv::Sdc::Scheme<OpenSubdiv::Sdc::SCHEME_CATMARK> scheme_;
};

}  // namespace limitsurf
