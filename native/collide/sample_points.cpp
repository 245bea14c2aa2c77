#include "collide/sample_points.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

Vec3 area_of(const Corners& t) {
  return 0.5 * glm::cross(t.b - t.a, t.c - t.a);
}

double area_of(const Surface& surface) {
  double sum = 0;
  for (std::size_t i = 0; i < surface.size(); ++i) sum += glm::length(area_of(surface.corners(i)));
  return sum;
}

/// Halves the longest side until none is longer than `most`, or the piece's area is negligible: otherwise needles would
/// become millions of pieces without area.
template <class Visit>
void split(const Corners& t, double most, const Visit& visit) {
  const double ab = glm::length(t.b - t.a), bc = glm::length(t.c - t.b), ca = glm::length(t.a - t.c);
  const double longest = std::max({ab, bc, ca});
  if (longest <= most || 32 * glm::length(area_of(t)) <= most * most) return visit(t);
  const Corners r = ab == longest ? t : bc == longest ? Corners{t.b, t.c, t.a} : Corners{t.c, t.a, t.b};
  const Vec3 m = 0.5 * (r.a + r.b);
  split({r.a, m, r.c}, most, visit), split({m, r.b, r.c}, most, visit);
}

}  // namespace

double chosen_spacing(const Surface& surface, double spacing) {
  constexpr double kChosen = 1e5, kMax = 5e7;
  base::require_not_negative(spacing, "spacing", "must not be negative or not finite");
  const double area = area_of(surface);
  if (spacing == 0) return area > 0 ? std::sqrt(area / kChosen) : 1;
  if (area / (spacing * spacing) > kMax)
    throw std::invalid_argument("spacing: so small that the part would have more than 50 million points");
  return spacing;
}

SamplePoints::SamplePoints(const Surface& surface, double spacing)
    : SamplePoints(pieces_of(surface, chosen_spacing(surface, spacing)), chosen_spacing(surface, spacing)) {}

SamplePoints::SamplePoints(std::vector<Piece> pieces, double spacing)
    : spacing_(spacing),
      tree_({pieces.size(),
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
                 sum += pieces[i].size * (pieces[i].centroid - pieces[some[0]].centroid), size += pieces[i].size;
               return pieces[some[0]].centroid + (size > 0 ? sum / size : Vec3(0));
             }}) {
  areas_.resize(tree_.groups());
  for (std::size_t g = tree_.groups(); g-- > 0;)
    for (int k = 0; k < base::kLanes; ++k) {
      if (tree_.holds_items(g)) {
        if (tree_.group(g).radius[k] >= 0) areas_[g].area[k] = pieces[tree_.order()[tree_.first_item(g) + k]].area;
      } else {
        for (const Vec3& a : areas_[base::kLanes * g + 1 + k].area) areas_[g].area[k] += a;
      }
    }
}

void SamplePoints::gather(const Surface& surface, std::size_t group, double spacing, std::vector<Piece>& out) {
  const SphereTree& tree = surface.tree();
  for (int k = 0; k < base::kLanes; ++k) {
    const double radius = tree.group(group).radius[k];
    if (radius < 0) continue;
    const bool item = tree.holds_items(group);
    const std::size_t child = item ? tree.first_item(group) + k : base::kLanes * group + 1 + k;
    if (item) {
      split(surface.corners(child), 2 * spacing, [&](const Corners& t) {
        const Vec3 a = area_of(t);
        if (a != Vec3(0)) out.push_back({(t.a + t.b + t.c) / 3.0, a, glm::length(a)});
      });
    } else if (radius > 0.7 * spacing) {  // circumradius of a square with side `spacing`
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

std::vector<SamplePoints::Piece> SamplePoints::pieces_of(const Surface& surface, double spacing) {
  std::vector<Piece> out;
  gather(surface, 0, spacing, out);
  return out;
}

}  // namespace riffler::collide
