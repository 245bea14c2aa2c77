// A mesh that becomes a volume, repaired as far as that requires.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "dexel/from_mesh/boundary.hpp"
#include "riffler/mesh/orient.hpp"

namespace riffler::dexel {

/// A mesh for conversion to a volume, original or repaired.
class SolidMesh {
 public:
  explicit SolidMesh(const Mesh& given) : used_(&given), boundary_(find_boundary(given)) {
    // If all edges are paired, winding numbers are integers and show by themselves whether a shell faces inwards.
    if (!boundary_.empty()) orient();
  }

  const Mesh& mesh() const { return *used_; }
  const std::vector<std::vector<int>>& loops() const { return boundary_.loops; }
  const mesh::Orientation& orientation() const { return orientation_; }

  /// Orients the mesh, once. Returns whether triangles were turned.
  bool orient() {
    if (asked_) return false;
    asked_ = true;
    std::optional<Mesh> better = oriented(*used_, orientation_);
    if (!better) return false;
    take(*std::move(better));
    return true;
  }

  void join_cracks(double tolerance) {
    if (boundary_.empty()) return;
    if (std::optional<Mesh> better = dexel::join_cracks(*used_, boundary_, tolerance)) take(*std::move(better));
  }

 private:
  void take(Mesh&& mesh) {
    storage_ = std::move(mesh);
    used_ = &storage_;
    boundary_ = find_boundary(*used_);
  }

  Mesh storage_;
  const Mesh* used_;
  Boundary boundary_;
  mesh::Orientation orientation_;
  bool asked_ = false;
};

}  // namespace riffler::dexel
