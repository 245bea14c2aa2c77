// TriangleSearch on exact surfaces. The tool's distance is 1-Lipschitz: a surface within c of a flat triangle is no
// nearer than the triangle's bound less c. Halving a triangle's sides in its parameters divides c by four, so around a
// minimum every level leaves a few triangles only. Where all feet are on one smooth part of the tool, a polynomial ends
// that sooner: w² times how far the surface is outside of a ball, cylinder or cone, or of the plane that touches the
// tool there. Its Bézier coefficients bound it, and where they show that it is convex, so does a tangent plane.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collide/triangle_search.hpp"
#include "geom/math.hpp"
#include "nurbs/trimmed_net.hpp"

namespace riffler::collide {

namespace {

constexpr std::size_t kMaxExactCells = 20'000;  // of one piece

/// Parameters of the place of a triangle that is nearest to p, by barycentric coordinates.
Vec2 parameters_at(const Corners& t, const Vec2* uv, const Vec3& p) {
  const Vec3 x = t.b - t.a, y = t.c - t.a, z = p - t.a;
  const double xx = glm::dot(x, x), xy = glm::dot(x, y), yy = glm::dot(y, y), det = xx * yy - xy * xy;
  double b = xx > 0 ? glm::dot(z, x) / xx : 0, c = 0;
  if (det > 1e-24 * xx * yy) {
    b = (yy * glm::dot(z, x) - xy * glm::dot(z, y)) / det;
    c = (xx * glm::dot(z, y) - xy * glm::dot(z, x)) / det;
  } else if (yy > xx) {
    b = 0, c = glm::dot(z, y) / yy;
  }
  b = std::clamp(b, 0.0, 1.0), c = std::clamp(c, 0.0, 1.0);
  if (const double sum = b + c; sum > 1) b /= sum, c /= sum;
  return uv[0] + b * (uv[1] - uv[0]) + c * (uv[2] - uv[0]);
}

bool contains(const Vec2* uv, const Vec2& p) {
  const auto side = [&](int i) {
    const Vec2 way = uv[(i + 1) % 3] - uv[i], to = p - uv[i];
    return way.x * to.y - way.y * to.x;
  };
  return side(0) >= 0 && side(1) >= 0 && side(2) >= 0;
}

Vec3 point_in_tool(const ExactPiece& piece, const Vec2& uv) {
  return piece.frame.to_tool(piece.surface.point(piece.triangle.cell, uv));
}

/// w² (d - τ) in homogeneous coordinates of the tool's frame, or something of the same sign, for the distance d from
/// the part of a tool at a foot.
struct ToolForm {
  enum { Ball, Cone, Plane } kind = Plane;
  Vec3 centre{0};              // of the ball
  double squared = 0;          // of the ball's radius + τ
  double outward = 0, up = 0;  // the cone's normal
  double level = 0;            // the cone: outward ρ + up z - level; the plane: normal · p - level
  Vec3 normal{0};

  double operator()(const nurbs::Vec4& a, const nurbs::Vec4& b) const {
    if (kind == Ball) return glm::dot(Vec3(a) - a.w * centre, Vec3(b) - b.w * centre) - squared * a.w * b.w;
    if (kind == Cone)
      return outward * outward * (a.x * b.x + a.y * b.y) - (level * a.w - up * a.z) * (level * b.w - up * b.z);
    const double x = glm::dot(normal, Vec3(a)) - level * a.w, y = glm::dot(normal, Vec3(b)) - level * b.w;
    return 0.5 * (a.w * y + b.w * x);
  }
};

ToolForm form_at(const OutlineRuns::At& at, const Vec2& place, const Vec3& point, const Vec3& radial, double least) {
  ToolForm form;
  const double below = least - at.distance;
  if (at.curvature > 0) {
    const Vec2 centre = place - at.normal / at.curvature;
    const double radius = 1 / at.curvature + below;
    if (std::abs(centre.x) <= 1e-12 * (1 + std::abs(centre.y)) && radius > 0) {
      form.kind = ToolForm::Ball, form.centre = Vec3(0, 0, centre.y), form.squared = radius * radius;
      return form;
    }
  } else if (at.normal.x > 0) {
    form.kind = ToolForm::Cone, form.outward = at.normal.x, form.up = at.normal.y;
    form.level = glm::dot(at.normal, place) + below;
    return form;
  }
  form.normal = at.normal.x * radial + Vec3(0, 0, at.normal.y);
  form.level = glm::dot(form.normal, point) + below;
  return form;
}

/// Newton's method for the minimum of a form on a net, within the unit square.
nurbs::Jet4 walk_down(const nurbs::Vec4* net, const nurbs::Degrees& degrees, const ToolForm& form, Vec2& at) {
  nurbs::Jet4 h = nurbs::jet_of(net, degrees, at);
  for (int round = 0; round < 8; ++round) {
    const double u = form(h.s, h.u), v = form(h.s, h.v), uu = form(h.u, h.u) + form(h.s, h.uu),
                 uv = form(h.u, h.v) + form(h.s, h.uv), vv = form(h.v, h.v) + form(h.s, h.vv);
    const bool hold_u = (at.x <= 0 && u > 0) || (at.x >= 1 && u < 0),
               hold_v = (at.y <= 0 && v > 0) || (at.y >= 1 && v < 0);
    Vec2 step(0);
    const double det = uu * vv - uv * uv;
    if (!hold_u && !hold_v && det > 1e-14 * uu * vv)
      step = Vec2(uv * v - vv * u, uv * u - uu * v) / det;
    else
      step = Vec2(hold_u || !(uu > 0) ? 0 : -u / uu, hold_v || !(vv > 0) ? 0 : -v / vv);
    const Vec2 next = glm::clamp(at + step, 0.0, 1.0);
    if (glm::length(next - at) <= 1e-12) break;
    at = next, h = nurbs::jet_of(net, degrees, at);
  }
  return h;
}

}  // namespace

/// Whether nothing above a cell is nearer than the minimum by more than `near`, if all its feet are on the part of the
/// tool that `from` sees, the surface's point at `uv`. It may lower the minimum.
bool TriangleSearch::proven(const ExactPiece& piece, const ExactCell& cell, const Look& from, const Vec2& uv,
                            double near) {
  if (!(from.at.margin > 0) || from.at.reach < kInfinity || from.radial == Vec3(0)) return false;
  const Vec2 lower = glm::min(cell.uv[0], glm::min(cell.uv[1], cell.uv[2])),
             size = glm::max(cell.uv[0], glm::max(cell.uv[1], cell.uv[2])) - lower;
  if (!(size.x > 0 && size.y > 0)) return false;
  const nurbs::ExactCell& whole = piece.surface.cells[piece.triangle.cell];
  std::array<nurbs::Vec4, nurbs::kMaxNet> net;
  nurbs::trimmed_net(piece.surface.nets.data() + whole.net, whole.degrees,
                     {lower.y, lower.y + size.y, {lower.x, lower.x}, {lower.x + size.x, lower.x + size.x}}, net.data());
  for (std::size_t k = 0; k < whole.degrees.size(); ++k) {
    const Vec3 p = piece.frame.to_tool(piece.surface.origin + nurbs::affine(net[k]));
    if (glm::length(p - from.point) >= from.at.margin) return false;
    net[k] = nurbs::Vec4(net[k].w * p, net[k].w);
  }
  Vec2 at = (uv - lower) / size;
  for (int round = 0; round < 2; ++round) {
    const ToolForm form = form_at(from.at, from.place, from.point, from.radial, least_.distance - near);
    excess_.set(net.data(), whole.degrees, form);
    if (excess_.positive()) return true;
    if (!excess_.convex()) return false;
    const nurbs::Jet4 h = walk_down(net.data(), whole.degrees, form, at);
    if (nurbs::Excess::tangent_is_positive(h, at, form)) return true;
    const double before = least_.distance;
    const Vec2 there = lower + at * size;
    // A point of the rectangle, but perhaps not of the triangle, which may end at a border.
    if (contains(cell.uv, there)) look(nurbs::affine(h.s));
    if (!(least_.distance < before)) return false;
  }
  return false;
}

void TriangleSearch::visit(const ExactPiece& piece, const Vec3& place) {
  look(point_in_tool(piece, parameters_at(piece.chord, piece.triangle.uv, place)));
}

/// Raises the lower bound of a cell. It may lower the minimum.
void TriangleSearch::bound(const ExactPiece& piece, ExactCell& cell, double near) {
  const double chord = piece.surface.chord(piece.triangle.cell, cell.uv[0], cell.uv[1], cell.uv[2]);
  const auto on_axis = [](const Vec3& p) { return Vec3(0, 0, p.z); };
  const auto is_open = [&](double low) { return low - chord < least_.distance - near; };
  on_chord_ = true;
  const Look middle = look((cell.t.a + cell.t.b + cell.t.c) / 3.0);
  double low = lower(cell.t, middle);
  if (is_open(low)) {
    const Look lowest = downhill(cell.t, middle);
    on_chord_ = false;
    const Vec2 uv = parameters_at(cell.t, cell.uv, lowest.point);
    const Look there = look(point_in_tool(piece, uv));
    if (is_open(low) && proven(piece, cell, there, uv, near)) {
      cell.low = std::max(cell.low, least_.distance - near);
      return;
    }
    on_chord_ = true;
    if (lowest.point != middle.point) low = std::max(low, lower(cell.t, look(lowest.point)));
    if (is_open(low) && lowest.place.x < farthest(cell.t, lowest.point))  // as for flat triangles
      low = std::max(
          low, lower({on_axis(cell.t.a), on_axis(cell.t.b), on_axis(cell.t.c)}, look_beside(on_axis(lowest.point))));
    cell.by_chord = chord > lowest.at.distance - low;
  }
  on_chord_ = false;
  cell.low = std::max(cell.low, low - chord);
}

/// Halves a cell: where its chord leaves the bound open, across the side that the chord is largest along, otherwise
/// across the longest. False if its parameters cannot be halved.
bool TriangleSearch::halve(const ExactPiece& piece, const ExactCell& cell) {
  const Vec3 corners[3] = {cell.t.a, cell.t.b, cell.t.c};
  double longest = -1;
  int i = 0;
  for (int side = 0; side < 3; ++side) {
    const int end = (side + 1) % 3;
    const Vec2& uv = cell.uv[side];
    const double length = cell.by_chord ? piece.surface.chord(piece.triangle.cell, uv, uv, cell.uv[end])
                                        : glm::length(corners[end] - corners[side]);
    if (length > longest) longest = length, i = side;
  }
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const Vec2 middle = 0.5 * (cell.uv[i] + cell.uv[j]);
  if (middle == cell.uv[i] || middle == cell.uv[j]) return false;
  const Vec3 at = point_in_tool(piece, middle);
  for (const ExactCell& half :
       {ExactCell{{corners[i], at, corners[k]}, {cell.uv[i], middle, cell.uv[k]}, cell.low, false},
        ExactCell{{at, corners[j], corners[k]}, {middle, cell.uv[j], cell.uv[k]}, cell.low, false}}) {
    exact_heap_.push_back(half);
    std::push_heap(exact_heap_.begin(), exact_heap_.end());
  }
  return true;
}

void TriangleSearch::search(const ExactPiece& piece, double low, Deadline& deadline) {
  const double near = std::max(kExact, loose_);
  const std::size_t before = cells_;
  const nurbs::ExactTriangle& t = piece.triangle;
  exact_heap_.assign(1, {piece.chord, {t.uv[0], t.uv[1], t.uv[2]}, low, false});
  while (!exact_heap_.empty() && exact_heap_.front().low < least_.distance - near && least_.distance >= enough_) {
    if (cells_ > before + kMaxExactCells || deadline.passed()) {
      left_ = std::min(left_, exact_heap_.front().low);
      return;
    }
    std::pop_heap(exact_heap_.begin(), exact_heap_.end());
    ExactCell cell = exact_heap_.back();
    exact_heap_.pop_back();
    bound(piece, cell, near);
    if (cell.low < least_.distance - near && !halve(piece, cell)) left_ = std::min(left_, cell.low);
  }
}

}  // namespace riffler::collide
