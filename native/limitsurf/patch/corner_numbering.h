// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// Consecutive numbers for the corners of a level's faces.
class CornerNumbering {
 public:
  virtual ~CornerNumbering() = default;
  virtual FaceId number(FaceCorner at) const = 0;
  virtual FaceCorner at(FaceId number) const = 0;
};

/// Corners of the control mesh's faces, in face order.
class CageCorners final : public CornerNumbering {
 public:
  explicit CageCorners(const ControlMesh& mesh) {
    faces_.reserve(mesh.faceVertices().size());
    offsets_.reserve(mesh.faceCount());
    for (int f = 0; f < mesh.faceCount(); ++f) {
      offsets_.push_back(static_cast<int>(faces_.size()));
      faces_.insert(faces_.end(), mesh.faceSize(f), f);
    }
  }

  int count() const { return static_cast<int>(faces_.size()); }
  FaceId number(FaceCorner at) const override { return offsets_[at.face] + at.corner; }
  FaceCorner at(FaceId number) const override {
    return {faces_[number], static_cast<int>(number - offsets_[faces_[number]])};
  }

 private:
  std::vector<int> offsets_, faces_;
};

/// Corners of a level that has quads only.
class QuadCorners final : public CornerNumbering {
 public:
  FaceId number(FaceCorner at) const override { return 4 * at.face + at.corner; }
  FaceCorner at(FaceId number) const override { return {number / 4, static_cast<int>(number % 4)}; }
};

}  // namespace limitsurf
