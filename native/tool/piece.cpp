#include "riffler/tool/piece.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::tool {

namespace {
template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
}  // namespace

double radius_at(const Piece& piece, double z) {
  return std::visit(Overloaded{[&](const Frustum& f) { return f.r0 + (f.r1 - f.r0) * ((z - f.z0) / (f.z1 - f.z0)); },
                               [&](const Round& r) {
                                 const double d = z - r.zc;
                                 return std::max(0.0, r.e + std::sqrt(std::max(0.0, r.r * r.r - d * d)));
                               }},
                    piece);
}

double max_radius(const Piece& piece) {
  return std::visit(Overloaded{[](const Frustum& f) { return std::max(f.r0, f.r1); },
                               [&](const Round& r) { return radius_at(piece, std::clamp(r.zc, r.z0, r.z1)); }},
                    piece);
}

double bottom(const Piece& piece) {
  return std::visit([](const auto& p) { return p.z0; }, piece);
}

double top(const Piece& piece) {
  return std::visit([](const auto& p) { return p.z1; }, piece);
}

}  // namespace riffler::tool
