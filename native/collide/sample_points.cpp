#include "collide/sample_points.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "collide/pieces.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

constexpr double kSquare = 0.7;       // circumradius of a square with side 1
constexpr double kLongestPart = 1.5;  // of an exact surface, in units of the spacing
constexpr double kTooMany = 3;        // points per square of the spacing

Vec3 area_of(const Corners& t) {
  return 0.5 * glm::cross(t.b - t.a, t.c - t.a);
}

double area_of(const Surface& surface) {
  double sum = 0;
  for (std::size_t i = 0; i < surface.size(); ++i) sum += glm::length(area_of(surface.corners(i)));
  return sum;
}

}  // namespace

double chosen_spacing(const Surface& surface, double spacing) {
  constexpr double kMax = 5e7;
  const double points = surface.exact() ? 4e5 : 1e5;  // no facets are felt where the sum ripples little
  base::require_not_negative(spacing, "spacing", "must not be negative or not finite");
  const double area = area_of(surface);
  if (spacing == 0) return area > 0 ? std::sqrt(area / points) : 1;
  if (area / (spacing * spacing) > kMax)
    throw std::invalid_argument("spacing: so small that the part would have more than 50 million points");
  return spacing;
}

/// A node's centre is the centroid of what it holds.
SphereTree SamplePoints::tree_over(const std::vector<Piece>& pieces) {
  return SphereTree({pieces.size(),
                     [&](std::size_t i) {
                       Box3 box;
                       box.add(pieces[i].centroid);
                       return box;
                     },
                     [&](std::size_t i) { return BoundingSphere{pieces[i].centroid, 0}; },
                     [&](std::size_t i, const Vec3& p) { return glm::length(pieces[i].centroid - p); },
                     [&](std::span<const std::uint32_t> some) {
                       Vec3 sum(0);
                       double size = 0;
                       for (const std::uint32_t i : some)
                         sum += pieces[i].size * (pieces[i].centroid - pieces[some[0]].centroid),
                             size += pieces[i].size;
                       return pieces[some[0]].centroid + (size > 0 ? sum / size : Vec3(0));
                     }});
}

SamplePoints::SamplePoints(const Surface& surface, double spacing)
    : SamplePoints(pieces_of(surface, chosen_spacing(surface, spacing)), chosen_spacing(surface, spacing)) {}

SamplePoints::SamplePoints(std::vector<Piece> pieces, double spacing) : spacing_(spacing), tree_(tree_over(pieces)) {
  areas_.resize(tree_.groups());
  for (std::size_t g = tree_.groups(); g-- > 0;) {
    for (int k = 0; k < base::kLanes; ++k) {
      if (tree_.holds_items(g)) {
        if (tree_.group(g).radius[k] >= 0) areas_[g].add(k, pieces[tree_.order()[tree_.first_item(g) + k]].area);
      } else {
        if (tree_.group(g).radius[k] >= 0)
          for (int i = 0; i < base::kLanes; ++i) areas_[g].add(k, areas_[tree_.first_child(g) + k].area(i));
      }
    }
    areas_[g].measure();
  }
}

void SamplePoints::AreaGroup::measure() {
  for (int k = 0; k < base::kLanes; ++k) {
    const double size = glm::length(area(k));
    per_size[k] = size > 0 ? 1 / size : 0;
  }
}

void SamplePoints::gather(const Surface& surface, std::size_t group, double spacing, std::vector<Piece>& out) {
  const SphereTree& tree = surface.tree();
  for (int k = 0; k < base::kLanes; ++k) {
    const double radius = tree.group(group).radius[k];
    if (radius < 0) continue;
    const bool item = tree.holds_items(group);
    const std::size_t child = (item ? tree.first_item(group) : tree.first_child(group)) + k;
    if (item) {
      // Pieces of negligible area are not cut: otherwise needles would become millions of points without area.
      cut_into_pieces(collide::Piece(surface.corners(child)), 2 * spacing, 0.25 * spacing * spacing, kInfinity,
                      [&](const auto& piece) {
                        const Vec3 a = piece.area();
                        if (a != Vec3(0)) out.push_back({piece.centroid(), a, glm::length(a)});
                      });
    } else if (radius > kSquare * spacing) {
      gather(surface, child, spacing, out);
    } else {
      Vec3 area(0), sum(0);
      double size = 0;
      const std::size_t first = tree.first_under(child);
      for (std::size_t i = first; i < first + tree.under(child); ++i) {
        const Corners& t = surface.corners(i);
        const Vec3 a = area_of(t);
        const double s = glm::length(a);
        area += a, size += s,
            sum += s / 3 *
                   ((t.a - tree.group(group).sphere(k).centre) + (t.b - tree.group(group).sphere(k).centre) +
                    (t.c - tree.group(group).sphere(k).centre));
      }
      if (size > 0) out.push_back({tree.group(group).sphere(k).centre + sum / size, area, size});
    }
  }
}

/// Points of an exact surface: the middles of parts of its triangles, in their parameters, with the area there.
void SamplePoints::gather_exact(const Surface& surface, double spacing, std::vector<Piece>& out) {
  struct Part {
    Vec2 uv[3];
    Vec3 p[3];
  };
  const nurbs::ExactTriangles& exact = *surface.exact();
  std::vector<Part> open;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const nurbs::ExactTriangle& t = surface.exact(i);
    const nurbs::ExactCell& cell = exact.cells[t.cell];
    const Corners& c = surface.corners(i);
    open.push_back({{t.uv[0], t.uv[1], t.uv[2]}, {c.a, c.b, c.c}});
    while (!open.empty()) {
      const Part part = open.back();
      open.pop_back();
      double longest = -1;
      int side = 0;
      for (int k = 0; k < 3; ++k)
        if (const double length = glm::length(part.p[(k + 1) % 3] - part.p[k]); length > longest)
          longest = length, side = k;
      const Vec2 x = part.uv[1] - part.uv[0], y = part.uv[2] - part.uv[0];
      const double share = 0.5 * (x.x * y.y - x.y * y.x);
      if (longest > kLongestPart * spacing) {
        const int next = (side + 1) % 3;
        const Vec2 uv = 0.5 * (part.uv[side] + part.uv[next]);
        const Vec3 p = exact.point(t.cell, uv);
        open.push_back(part), open.back().uv[next] = uv, open.back().p[next] = p;
        open.push_back(part), open.back().uv[side] = uv, open.back().p[side] = p;
        continue;
      }
      const nurbs::Jet3 jet = nurbs::rational(
          nurbs::jet_of(exact.nets.data() + cell.net, cell.degrees, (part.uv[0] + part.uv[1] + part.uv[2]) / 3.0));
      const Vec3 area = share * glm::cross(jet.u, jet.v);
      if (area != Vec3(0)) out.push_back({exact.origin + jet.s, area, glm::length(area)});
    }
  }
}

std::vector<SamplePoints::Piece> SamplePoints::pieces_of(const Surface& surface, double spacing) {
  std::vector<Piece> out;
  surface.exact() ? gather_exact(surface, spacing, out) : gather(surface, 0, spacing, out);
  // Narrow triangles next to each other leave many more points than their area needs.
  const double needed = area_of(surface) / (spacing * spacing);
  if (static_cast<double>(out.size()) > kTooMany * needed + base::kLanes) out = merged(out, spacing);
  return out;
}

/// Pieces as close together as those of one square of the spacing become one.
std::vector<SamplePoints::Piece> SamplePoints::merged(const std::vector<Piece>& pieces, double spacing) {
  const SphereTree tree = tree_over(pieces);
  std::vector<Piece> out;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t group = open.back();
    open.pop_back();
    for (int k = 0; k < base::kLanes; ++k) {
      const double radius = tree.group(group).radius[k];
      if (radius < 0) continue;
      const std::size_t child = tree.first_child(group) + k;
      if (tree.holds_items(group)) {
        out.push_back(pieces[tree.order()[tree.first_item(group) + k]]);
      } else if (radius > kSquare * spacing) {
        open.push_back(child);
      } else {
        Piece sum{tree.group(group).sphere(k).centre, Vec3(0), 0};
        for (std::size_t i = tree.first_under(child); i < tree.first_under(child) + tree.under(child); ++i)
          sum.area += pieces[tree.order()[i]].area, sum.size += pieces[tree.order()[i]].size;
        out.push_back(sum);
      }
    }
  }
  return out;
}

}  // namespace riffler::collide
