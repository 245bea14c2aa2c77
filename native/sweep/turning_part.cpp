#include "sweep/turning_part.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"

namespace riffler::sweep {

namespace {

/// Truncates a Round that extends into the piece above it where that piece begins. The top of that piece may be cut off
/// (steps.cpp), and then the Round must not protrude from it.
void end_at(PieceShape& round, const tool::Piece& above) {
  round.z1 = bottom(above), round.r1 = radius_at(above, round.z1), round.ball = false, round.cut1 = true;
}

/// n · axis of the outward normal at the lower or upper end of a piece's side.
double turn_at(const PieceShape& s, double z) {
  return s.round ? std::clamp((z - s.zc) / s.r, -1.0, 1.0) : -s.slope * s.cosine;
}

/// Finds where planes can touch the group, apart from flat ends and flanks. Returns the number of rims.
std::size_t find_rims(std::span<const PieceShape> pieces, std::span<Rim> rims) {
  std::size_t count = 0;
  double turn = -1;  // how far the planes have turned, starting at the lower end
  const auto edge = [&](double radius, double z, double to) {
    if (to > turn + 1e-9) rims[count++] = {radius, z, 0, turn, to};
    turn = std::max(turn, to);
  };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const PieceShape& s = pieces[k];
    edge(s.r0, s.z0, turn_at(s, s.z0));
    if (!s.round) continue;
    const double next = k + 1 < pieces.size() ? turn_at(pieces[k + 1], pieces[k + 1].z0) : 1;
    const double to = std::min(turn_at(s, s.z1), next);
    if (to > turn) rims[count++] = {s.e, s.zc, s.r, turn, to};
    turn = std::max(turn, to);
  }
  edge(pieces.back().r1, pieces.back().z1, 1);
  return count;
}

}  // namespace

TurningBody::TurningBody(const ConvexGroup& group, const Motion& motion, double from, double to, double tolerance)
    : count(group.count),
      rim_count(0),
      leans(false),
      widest(0),
      t0(from),
      t1(to),
      origin(motion.tip(from).z),
      middle((from + to) / 2),
      angle(motion.angle()) {
  double lever = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const tool::Piece& p = group.pieces[k];
    pieces[k] = shape_of(p);
    if (k > 0 && pieces[k - 1].z1 > pieces[k].z0) end_at(pieces[k - 1], p);
    leans = leans || pieces[k].slope != 0, widest = std::max(widest, max_radius(p));
    lever = std::max(lever, geom::hypot(std::max(std::abs(bottom(p)), std::abs(top(p))), max_radius(p)));
  }
  rim_count = find_rims({pieces.data(), count}, rims);
  const Vec3 velocity = motion.to().tip - motion.from().tip, o = motion.axis(middle), first = motion.from().tip;
  // The rotation vector is perpendicular to the axis, so this vector is a quarter turn ahead of the axis.
  const Vec3 ahead = angle > 0 ? glm::cross(motion.rotation(), o) / angle : Vec3(0);
  for (int i = 0; i < 3; ++i) {
    tip[i] = first[i] - (i == 2 ? origin : 0), way[i] = velocity[i];
    axis[i] = o[i], side[i] = ahead[i], spin[i] = motion.rotation()[i];
    start.tip[i] = tip[i] + t0 * way[i], start.axis[i] = motion.axis(t0)[i];
    end.tip[i] = tip[i] + t1 * way[i], end.axis[i] = motion.axis(t1)[i];
  }
  speed = glm::length(velocity), pull = angle * angle * angle, drift = 3 * angle * angle * speed;
  // √5 · 0.2 + 0.5 < 1: if a surface is no steeper against the ray than 2, both errors together stay below the
  // tolerance along the ray. A plane may lag behind by only a small fraction of the body's size (docs/methods.md).
  along = 0.5 * tolerance, aside = std::min(0.2 * tolerance, 0.02 * group.thinnest);
  const double moved = (speed + angle * lever) * (t1 - t0);
  deepest = std::clamp(static_cast<int>(std::ceil(base::log2(std::max(moved / aside, 1.0)))), 1, 40);
}

}  // namespace riffler::sweep
