#include "plan/grown_piece.hpp"
#include "geom/hypot.hpp"

#include <cmath>

namespace riffler::plan {

namespace {

/// Everything within `margin` of the level disc of radius `r` at height `z`.
tool::Piece rounded_disc(double r, double z, double margin) {
  return tool::Round{r, z, margin, z - margin, z + margin};
}

void grow(const tool::Frustum& f, double margin, std::vector<tool::Piece>& out) {
  out.push_back(rounded_disc(f.r0, f.z0, margin));
  if (!(f.r1 > f.r0)) return;  // seen from below there is its lower end only
  const double dr = f.r1 - f.r0, dz = f.z1 - f.z0, length = geom::hypot(dr, dz);
  const double side = margin * dz / length, down = margin * dr / length;
  out.push_back(tool::Frustum{f.z0 - down, f.r0 + side, f.z1 - down, f.r1 + side});
  out.push_back(rounded_disc(f.r1, f.z1, margin));
}

void grow(const tool::Round& round, double margin, std::vector<tool::Piece>& out) {
  const double scale = (round.r + margin) / round.r;
  const auto moved = [&](double z) { return round.zc + (z - round.zc) * scale; };
  if (round.z0 > round.zc - round.r) out.push_back(rounded_disc(tool::radius_at(round, round.z0), round.z0, margin));
  if (!(round.z0 < round.zc)) return;  // it narrows upwards
  out.push_back(tool::Round{round.e, round.zc, round.r + margin, moved(round.z0), moved(round.z1)});
  if (round.z1 < round.zc) out.push_back(rounded_disc(tool::radius_at(round, round.z1), round.z1, margin));
}

}  // namespace

std::vector<tool::Piece> grown_lower_side(const tool::Piece& piece, double margin) {
  if (!(margin > 0)) return {piece};
  std::vector<tool::Piece> out;
  std::visit([&](const auto& one) { grow(one, margin, out); }, piece);
  return out;
}

}  // namespace riffler::plan
