#include "nurbs/exact_triangles.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "nurbs/trimmed_net.hpp"
#include "nurbs/trimmed_span.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nurbs {

namespace {

constexpr int kMaxDivisions = 48;          // of a span
constexpr int kMaxForShape = 12;           // until chords need not be short relative to a cell
constexpr int kMaxDivisionsForEdges = 24;  // for edges of borders
constexpr std::size_t kMaxEdgesOfCell = 8;

Vec3 size_of(const Vec4* net, const Degrees& degrees) {
  Box3 box;
  for (std::size_t k = 0; k < degrees.size(); ++k) box.add(affine(net[k]));
  return box.size();
}

[[noreturn]] void too_many() {
  throw std::invalid_argument("tolerance: the mesh would have more than 50 million triangles; give a larger one");
}

/// Divides one span.
class Divider {
 public:
  Divider(const SurfaceCore& core, std::size_t span, const Fineness& fineness, ExactTriangles& out)
      : span_(core.spans[span]),
        which_(span),
        trims_(span_, core.regions[span_.patch]),
        degrees_(span_.degrees),
        fineness_(fineness),
        out_(out) {}

  void run() { divide(span_.net.data(), Vec2(0), Vec2(1), 0, 0, trims_.all()); }

 private:
  void divide(const Vec4* net, const Vec2& lower, const Vec2& upper, int halvings, int cuts,
              const TrimRegion::Edges& above) {
    if (out_.triangles.size() > fineness_.most) too_many();
    const TrimRegion::Edges edges = trims_.touching(above, lower, upper);
    if (edges.empty() && !trims_.holds(0.5 * (lower + upper))) return;
    const SecondDerivatives bend = second_derivatives(net, degrees_);
    const Vec2 sides = side_lengths(net, degrees_);
    const double of_size = halvings < kMaxForShape ? fineness_.of_size * glm::length(size_of(net, degrees_)) : 1e300;
    const double chord = std::min(fineness_.chord, of_size);
    const bool bent = bend.chord(1, 1) > chord, is_long = std::max(sides.x, sides.y) > fineness_.longest;
    const bool crossed = edges.size() > kMaxEdgesOfCell && cuts < kMaxDivisionsForEdges;
    if (halvings >= kMaxDivisions && bent) too_many();
    if (!(bent || is_long || crossed) || halvings >= kMaxDivisions) return add(net, lower, upper, bend, edges);
    // Halving a direction divides its own part of the bound by 4, and the twist's by 2 in either direction.
    const bool along_u = bent && bend.uu != bend.vv ? bend.uu > bend.vv : sides.x >= sides.y;
    const Vec2 middle = 0.5 * (lower + upper);
    std::vector<Vec4> halves(2 * degrees_.size());
    halve(net, degrees_, along_u, halves.data(), halves.data() + degrees_.size());
    const int cut = cuts + (bent || is_long ? 0 : 1);
    divide(halves.data(), lower, along_u ? Vec2(middle.x, upper.y) : Vec2(upper.x, middle.y), halvings + 1, cut, edges);
    divide(halves.data() + degrees_.size(), along_u ? Vec2(middle.x, lower.y) : Vec2(lower.x, middle.y), upper,
           halvings + 1, cut, edges);
  }

  void add(const Vec4* net, const Vec2& lower, const Vec2& upper, const SecondDerivatives& bend,
           const TrimRegion::Edges& edges) {
    const auto cell = static_cast<std::uint32_t>(out_.cells.size());
    out_.cells.push_back({degrees_, out_.nets.size(), bend, which_, span_.to_patch(lower), span_.to_patch(upper)});
    out_.nets.insert(out_.nets.end(), net, net + degrees_.size());
    pieces_.clear();
    if (edges.empty())
      pieces_.emplace_back();
    else
      trims_.append_pieces(edges, lower, upper, pieces_);
    for (const Trapezoid& t : pieces_) {
      const Vec2 a(t.left[0], t.low), b(t.right[0], t.low), c(t.right[1], t.high), d(t.left[1], t.high);
      // The shorter diagonal, so that triangles are not narrow; corners in one place leave one triangle.
      const auto place = [&](const Vec2& uv) { return affine(point_of(net, degrees_, uv)); };
      if (glm::length(place(c) - place(a)) <= glm::length(place(d) - place(b)))
        push(cell, a, b, c), push(cell, a, c, d);
      else
        push(cell, a, b, d), push(cell, b, c, d);
    }
  }

  void push(std::uint32_t cell, const Vec2& a, const Vec2& b, const Vec2& c) {
    const Vec2 x = b - a, y = c - a;
    if (x.x * y.y - x.y * y.x > 0) out_.triangles.push_back({cell, {a, b, c}});
  }

  const BezierSpan& span_;
  std::size_t which_;
  TrimmedSpan trims_;
  Degrees degrees_;
  const Fineness& fineness_;
  ExactTriangles& out_;
  std::vector<Trapezoid> pieces_;
};

void append(const ExactTriangles& some, ExactTriangles& all) {
  const std::size_t net = all.nets.size();
  const auto cell = static_cast<std::uint32_t>(all.cells.size());
  for (ExactCell c : some.cells) c.net += net, all.cells.push_back(c);
  all.nets.insert(all.nets.end(), some.nets.begin(), some.nets.end());
  for (ExactTriangle t : some.triangles) t.cell += cell, all.triangles.push_back(t);
}

}  // namespace

ExactTriangles exact_triangles(const SurfaceCore& core, const Fineness& fineness, const Progress& progress) {
  std::vector<ExactTriangles> parts(core.spans.size());
  base::parallel_for(
      core.spans.size(), 1, [&](std::size_t s, std::size_t) { Divider(core, s, fineness, parts[s]).run(); }, progress);
  ExactTriangles all;
  all.origin = core.origin;
  for (ExactTriangles& some : parts) {
    if (all.triangles.size() + some.triangles.size() > fineness.most) too_many();
    append(some, all);
    some = {};
  }
  return all;
}

}  // namespace riffler::nurbs
