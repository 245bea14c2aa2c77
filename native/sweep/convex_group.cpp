#include "sweep/convex_group.hpp"

#include <algorithm>
#include <cmath>

#include "geom/hypot.hpp"

namespace riffler::sweep {

namespace {

/// dr/dz of the piece's profile at one of its ends; infinite if it starts or ends flat.
double slope_at(const tool::Piece& piece, double z) {
  if (const auto* f = std::get_if<tool::Frustum>(&piece)) return (f->r1 - f->r0) / (f->z1 - f->z0);
  const auto& r = std::get<tool::Round>(piece);
  const double d = z - r.zc;
  return -d / std::sqrt(std::max(0.0, r.r * r.r - d * d));
}

/// Whether two pieces, one above the other, form a convex body: equal radii where they meet, no concave edge there.
bool convex_together(const tool::Piece& below, const tool::Piece& above) {
  const double z = bottom(above), size = std::max(max_radius(below), max_radius(above));
  // A complete ball or torus extends into the piece above (Profile::pieces).
  if (z > top(below) + 1e-12 * size || z < bottom(below)) return false;
  if (std::abs(radius_at(below, z) - radius_at(above, z)) > 1e-9 * size) return false;
  return slope_at(below, z) >= slope_at(above, z) - 1e-9;
}

/// Whether a truncated cone lies inside the piece, at heights that the piece covers.
bool within(const tool::Frustum& f, const tool::Piece& piece) {
  // The piece's radius is a concave function of the height, so the two ends decide.
  const double slack = 1 + 1e-12;
  return f.r0 >= 0 && f.r1 >= 0 && f.z0 >= bottom(piece) && f.z1 <= top(piece) &&
         f.r0 <= radius_at(piece, f.z0) * slack && f.r1 <= radius_at(piece, f.z1) * slack;
}

/// Extends one of two groups into the other, inside the tool, where there is a concave edge between them. Their ends on
/// a ray are found separately, each up to the tolerance, so groups that only touch might leave a crumb between them.
void overlap(ConvexGroup& below, ConvexGroup& above) {
  tool::Piece &low = below.pieces[below.count - 1], &high = above.pieces[0];
  for (int k = 1; k <= 8; ++k) {
    if (auto* f = std::get_if<tool::Frustum>(&high)) {  // along its own line
      const double z = f->z0 - (top(low) - bottom(low)) / (1 << k);
      const double r = f->r0 - (f->r1 - f->r0) / (f->z1 - f->z0) * (f->z0 - z);
      if (within({z, r, f->z0, f->r0}, low)) return void((f->z0 = z, f->r0 = r));
    }
    if (auto* f = std::get_if<tool::Frustum>(&low)) {
      const double z = f->z1 + (top(high) - bottom(high)) / (1 << k);
      const double r = f->r1 + (f->r1 - f->r0) / (f->z1 - f->z0) * (z - f->z1);
      if (within({f->z1, f->r1, z, r}, high)) return void((f->z1 = z, f->r1 = r));
      // Otherwise add a collar, which keeps a group convex that widens upwards.
      const tool::Frustum collar{f->z1, f->r1, z, f->r1};
      if (f->r1 > f->r0 && below.count < ConvexGroup::kMax && within(collar, high)) {
        below.pieces[below.count++] = collar;
        return;
      }
    }
  }
}

}  // namespace

PieceShape shape_of(const tool::Piece& piece) {
  PieceShape s{};
  s.z0 = bottom(piece), s.z1 = top(piece);
  s.r0 = radius_at(piece, s.z0), s.r1 = radius_at(piece, s.z1);
  s.slope = std::holds_alternative<tool::Frustum>(piece) ? (s.r1 - s.r0) / (s.z1 - s.z0) : 0,
  s.cosine = 1 / geom::hypot(1.0, s.slope);
  s.cut0 = s.cut1 = true;
  if (const auto* round = std::get_if<tool::Round>(&piece)) {
    s.round = true, s.e = round->e, s.zc = round->zc, s.r = round->r;
    s.cut0 = s.z0 > s.zc - s.r, s.cut1 = s.z1 < s.zc + s.r;
    s.ball = whole_ball(piece);
  }
  s.support = s.cosine * (s.r0 - s.slope * s.z0);
  return s;
}

bool whole_ball(const tool::Piece& piece) {
  const auto* r = std::get_if<tool::Round>(&piece);
  return r && r->e == 0 && r->z0 <= r->zc - r->r && r->z1 >= r->zc + r->r;
}

bool smooth_together(const tool::Piece& below, const tool::Piece& above) {
  return slope_at(below, bottom(above)) <= slope_at(above, bottom(above)) + 1e-9;
}

std::vector<ConvexGroup> convex_groups(std::span<const tool::Piece> pieces) {
  std::vector<ConvexGroup> out;
  for (const tool::Piece& piece : pieces) {
    const bool joins = !out.empty() && out.back().count < ConvexGroup::kMax &&
                       convex_together(out.back().pieces[out.back().count - 1], piece);
    if (!joins) out.emplace_back();
    out.back().pieces[out.back().count++] = piece;
  }
  for (std::size_t k = 0; k + 1 < out.size(); ++k) overlap(out[k], out[k + 1]);
  for (ConvexGroup& group : out) {
    double radius = 0;
    for (const tool::Piece& piece : group.all()) radius = std::max(radius, max_radius(piece));
    group.thinnest = std::min(radius, top(group.pieces[group.count - 1]) - bottom(group.pieces[0]));
  }
  return out;
}

}  // namespace riffler::sweep
