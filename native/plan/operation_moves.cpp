#include "plan/operation_moves.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/functions.hpp"
#include "riffler/base/check.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/plan/cc_frame.hpp"

namespace riffler::plan {

namespace {

Mesh turned(Mesh mesh, const Mat3& frame) {
  for (Vec3& v : mesh.vertices) v = v * frame;
  return mesh;
}

/// Highest point of part, fixtures and the stock's box along z of the frame.
double top_of(const SetupScene& scene, const TurnedScene& in) {
  double top = mesh::bounds(in.part).upper.z;
  for (const Mesh& one : in.fixtures) top = std::max(top, mesh::bounds(one).upper.z);
  const Box3& box = scene.stock.frame().box;
  for (int corner = 0; corner < 8; ++corner)
    top = std::max(
        top, glm::dot(in.frame[2], Vec3(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                                        corner & 4 ? box.upper.z : box.lower.z)));
  return top;
}

}  // namespace

Mat3 operation_frame(const Vec3& axis, double angle) {
  const Vec3 z = unit_axis(axis, "axis");
  const CcFrame base = z == Vec3(0, 0, 1) ? CcFrame{} : cc_frame({1, 0, 0}, z);
  const double c = base::cos(angle), s = base::sin(angle);
  return Mat3(c * base.x + s * base.y, c * base.y - s * base.x, base.z);
}

TurnedScene turned(const SetupScene& scene, double angle) {
  base::require_length(scene.clearance, "clearance");
  validate(scene.part);
  if (scene.part.empty()) throw std::invalid_argument("part: it has no triangles");
  TurnedScene out;
  out.frame = operation_frame(scene.axis, angle);
  out.part = turned(scene.part, out.frame);
  for (const Mesh& one : scene.fixtures) validate(one), out.fixtures.push_back(turned(one, out.frame));
  out.plane = top_of(scene, out) + scene.clearance;
  return out;
}

Mesh turned_stock(const SetupScene& scene, const Mat3& frame) {
  return turned(marching::to_mesh(scene.stock), frame);
}

Mesh joined(const Mesh& part, const std::vector<Mesh>& fixtures) {
  Mesh out = part;
  for (const Mesh& one : fixtures) {
    const int base = static_cast<int>(out.vertices.size());
    out.vertices.insert(out.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const Vec3i& t : one.triangles) out.triangles.push_back(t + Vec3i(base));
  }
  return out;
}

void require_upright_cutter(const Tool& tool, const char* work) {
  double widest = 0;
  for (const tool::ProfileSegment& s : tool.profile().segments()) {
    if (s.to.x < widest - 1e-9)
      throw std::invalid_argument("tool: " + tool.name() + " narrows above its widest place; " + work +
                                  " from one side needs a cutter that does not: ball, flat, fillet, taper, cone or a "
                                  "profile like them");
    widest = std::max(widest, s.to.x);
  }
}

void MoveWriter::to(const Vec3& tip, MoveKind kind) {
  if (!out_.poses.empty() && tip == last_) return;
  const double feed = kind == MoveKind::Rapid ? 0 : kind == MoveKind::Lead ? plunge_ : feed_;
  out_.poses.push_back({frame_ * tip, frame_[2]}), out_.kinds.push_back(kind), out_.feeds.push_back(feed);
  last_ = tip;
}

void MoveWriter::approach(const Vec3& tip, double plane, double height) {
  to({tip.x, tip.y, plane}, MoveKind::Rapid);
  if (height < plane) to({tip.x, tip.y, std::max(height, tip.z + kAbove)}, MoveKind::Rapid);
  to(tip, MoveKind::Lead);
}

}  // namespace riffler::plan
