#include "sweep/turning_part.hpp"

#include <algorithm>
#include <cmath>

#include "sweep/swept_piece.hpp"

namespace riffler {

namespace {

PieceShape shape_of(const Piece& piece) {
  PieceShape s{};
  s.z0 = bottom(piece), s.z1 = top(piece);
  s.r0 = radius_at(piece, s.z0), s.r1 = radius_at(piece, s.z1);
  s.slope = (s.r1 - s.r0) / (s.z1 - s.z0), s.cosine = 1 / std::hypot(1.0, s.slope);
  if (const auto* round = std::get_if<Round>(&piece)) {
    s.round = true, s.e = round->e, s.zc = round->zc, s.r = round->r;
    s.ball = s.e == 0 && s.z0 <= s.zc - s.r && s.z1 >= s.zc + s.r;
  }
  return s;
}

/// dr/dz of the piece's profile at one of its ends; infinite where it starts or ends flat.
double slope_at(const Piece& piece, double z) {
  if (const auto* f = std::get_if<Frustum>(&piece)) return (f->r1 - f->r0) / (f->z1 - f->z0);
  const auto& r = std::get<Round>(piece);
  const double d = z - r.zc;
  return -d / std::sqrt(std::max(0.0, r.r * r.r - d * d));
}

/// Whether two pieces, one above the other, make one convex body: same radius where they meet, no hollow there.
bool convex_together(const Piece& below, const Piece& above) {
  const double z = bottom(above), size = std::max(max_radius(below), max_radius(above));
  // A ball or torus that is taken whole reaches into the piece above (Profile::pieces).
  if (z > top(below) + 1e-12 * size || z < bottom(below)) return false;
  if (std::abs(radius_at(below, z) - radius_at(above, z)) > 1e-9 * size) return false;
  return slope_at(below, z) >= slope_at(above, z) - 1e-9;
}

}  // namespace

std::vector<ConvexGroup> convex_groups(std::span<const Piece> pieces) {
  std::vector<ConvexGroup> out;
  for (const Piece& piece : pieces) {
    const bool joins = !out.empty() && out.back().count < ConvexGroup::kMost &&
                       convex_together(out.back().pieces[out.back().count - 1], piece);
    if (!joins) out.emplace_back();
    out.back().pieces[out.back().count++] = piece;
  }
  return out;
}

TurningPoses::TurningPoses(const ConvexGroup& group, const Motion& motion, double t0, double t1, double tolerance)
    : count_(group.count), motion_(motion), t0_(t0), t1_(t1), origin_(motion.tip(t0).z) {
  double lever = 0, thinnest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count_; ++k) {
    const Piece& p = group.pieces[k];
    pieces_[k] = shape_of(p);
    lever = std::max(lever, std::hypot(std::max(std::abs(bottom(p)), std::abs(top(p))), max_radius(p)));
    thinnest = std::min({thinnest, top(p) - bottom(p), max_radius(p)});
  }
  // √5 · 0.2 + 0.5 < 1: where a surface is no steeper against the ray than 2, both shares together stay below the
  // tolerance along the ray. A plane may not be behind by more than a small part of the body (docs/methods.md).
  along_ = 0.5 * tolerance, aside_ = std::min(0.2 * tolerance, 0.02 * thinnest);
  const Vec3 way = motion.to().tip - motion.from().tip;
  const Vec3 axis = motion.axis((t0 + t1) / 2);
  for (int i = 0; i < 3; ++i) {
    tip_from_[i] = motion.from().tip[i], tip_way_[i] = way[i];
    rotation_[i] = motion.rotation()[i], axis_[i] = axis[i];
  }
  way_ = glm::length(way), spin2_ = motion.angle() * motion.angle();
  coriolis_ = 2 * glm::length(glm::cross(motion.rotation(), way));
  const double moved = (way_ + motion.angle() * lever) * (t1 - t0);
  deepest_ = std::clamp(static_cast<int>(std::ceil(std::log2(std::max(moved / aside_, 1.0)))), 1, kDeepest);
}

PoseFrame TurningPoses::make(double t) const {
  const Vec3 tip = motion_.tip(t), axis = motion_.axis(t), way = motion_.to().tip - motion_.from().tip;
  PoseFrame f{};
  f.t = t, f.oz = axis.z, f.tilt = std::hypot(axis.x, axis.y);
  Vec3 e1{1, 0, 0}, e2{0, axis.z, 0};
  if (f.tilt > 0) {
    e1 = {-axis.z * axis.x / f.tilt, -axis.z * axis.y / f.tilt, f.tilt};
    e2 = {axis.y / f.tilt, -axis.x / f.tilt, 0};
  }
  const Vec3* frame[3] = {&e1, &e2, &axis};
  for (int i = 0; i < 3; ++i) {
    f.tip[i] = tip[i], f.e1[i] = e1[i], f.e2[i] = e2[i], f.axis[i] = axis[i];
    f.way[i] = glm::dot(way, *frame[i]), f.spin[i] = glm::dot(motion_.rotation(), *frame[i]);
  }
  return f;
}

const PoseFrame& TurningPoses::at(std::uint32_t place, PoseFrame& spare) {
  const double t =
      place == kEnd ? t1_ : t0_ + (t1_ - t0_) * (static_cast<double>(place) / static_cast<double>(kEnd));
  constexpr std::uint32_t kStride = kEnd >> kKept;
  if (place % kStride != 0) return spare = make(t);
  const std::uint32_t k = place / kStride;
  // One bit each; the end pose shares the last bit's word by being made at once.
  if (k == 1U << kKept ? !(have_ >> 63 & 1U) : !(have_ >> k & 1U)) {
    kept_[k] = make(t);
    have_ |= std::uint64_t{1} << (k == 1U << kKept ? 63 : k);
  }
  return kept_[k];
}

Vec3 turning_normal(const ConvexGroup& group, const Motion& motion, const Vec3& p, double t) {
  Vec3 n{0, 0, 1};
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : group.all()) {
    const SweptPiece body(piece, motion.tip(t), motion.axis(t), Vec3(0));
    SweptHit near, far;
    if (!body.hit(p.x, p.y, near, far)) continue;
    for (const SweptHit& hit : {near, far})
      if (const double off = std::abs(hit.s - p.z); off < least) least = off, n = body.normal(p.x, p.y, hit);
  }
  const Vec3 velocity = motion.velocity(p, t);
  const double speed = glm::length(velocity), slide = glm::dot(n, velocity);
  if (t == 0 || t == 1 || !(std::abs(slide) > 0)) return n;
  // Within the move the swept surface is where n · v = 0 (3.1). On a smooth side t is near that; what n · v is left is
  // taken out. On an edge no side has it: there the edge sweeps the surface.
  if (std::abs(slide) <= 0.15 * speed) return glm::normalize(n - (slide / (speed * speed)) * velocity);
  const Vec3 axis = motion.axis(t), w = p - motion.tip(t), out = w - glm::dot(w, axis) * axis;
  const Vec3 swept = glm::cross(glm::cross(axis, out), velocity);
  const double length = glm::length(swept);
  if (!(length > 1e-9 * speed * glm::length(out))) return n;
  return swept * ((glm::dot(swept, out) < 0 ? -1.0 : 1.0) / length);
}

}  // namespace riffler
