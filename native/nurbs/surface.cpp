#include "riffler/nurbs/surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "nurbs/check_patch.hpp"
#include "nurbs/normal.hpp"
#include "nurbs/surface_core.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::nurbs {

namespace {

std::vector<Patch> checked(std::vector<Patch> patches) {
  if (patches.empty()) throw std::invalid_argument("a surface needs at least one patch");
  for (std::size_t i = 0; i < patches.size(); ++i) try {
      check_patch(patches[i]);
    } catch (const std::invalid_argument& error) {
      if (patches.size() == 1) throw;
      throw std::invalid_argument("patch " + std::to_string(i) + ": " + error.what());
    }
  return patches;
}

Box3 control_box(const std::vector<Patch>& patches) {
  Box3 box;
  for (const Patch& patch : patches)
    for (const Vec3& p : patch.points) box.add(p);
  return box;
}

/// The domain's knots without repetitions; the last one is left out.
std::vector<double> breaks_of(const std::vector<double>& knots, int degree, std::size_t count) {
  std::vector<double> breaks;
  for (auto j = static_cast<std::size_t>(degree); j < count; ++j)
    if (knots[j] < knots[j + 1]) breaks.push_back(knots[j]);
  return breaks;
}

std::size_t interval_at(const std::vector<double>& breaks, double t) {
  const auto above = std::upper_bound(breaks.begin(), breaks.end(), t);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, above - breaks.begin() - 1));
}

}  // namespace

Vec2 Patch::lower() const {
  return {knots_u[static_cast<std::size_t>(degree_u)], knots_v[static_cast<std::size_t>(degree_v)]};
}

Vec2 Patch::upper() const {
  return {knots_u[count_u], knots_v[count_v]};
}

SurfaceCore::SurfaceCore(std::vector<Patch> given) : patches(checked(std::move(given))), box(control_box(patches)) {
  origin = 0.5 * box.lower + 0.5 * box.upper;
  const Vec3 far = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  scale = std::max({far.x, far.y, far.z});
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    first_span.push_back(spans.size());
    append_spans(patch, i, origin, spans);
    breaks_u.push_back(breaks_of(patch.knots_u, patch.degree_u, patch.count_u));
    breaks_v.push_back(breaks_of(patch.knots_v, patch.degree_v, patch.count_v));
  }
  for (const Patch& patch : patches) regions.emplace_back(patch.trims);
  tree = ClosestTree(spans, regions);
}

const BezierSpan& SurfaceCore::span_at(std::size_t patch, const Vec2& uv) const {
  const std::size_t i = interval_at(breaks_u[patch], uv.x), j = interval_at(breaks_v[patch], uv.y);
  return spans[first_span[patch] + i * breaks_v[patch].size() + j];
}

Surface::Surface(std::vector<Patch> patches) : core_(std::make_shared<const SurfaceCore>(std::move(patches))) {}

const std::vector<Patch>& Surface::patches() const {
  return core_->patches;
}

Box3 Surface::bounds() const {
  return core_->box;
}

void Surface::check_parameters(std::span<const Vec2> uv, std::size_t patch) const {
  const std::size_t patches = core_->patches.size();
  if (patch >= patches)
    throw std::invalid_argument("patch " + std::to_string(patch) + " does not exist; the surface has " +
                                std::to_string(patches) + ", counted from 0");
  const Vec2 lower = core_->patches[patch].lower(), upper = core_->patches[patch].upper();
  for (std::size_t i = 0; i < uv.size(); ++i)
    if (!(uv[i].x >= lower.x && uv[i].x <= upper.x && uv[i].y >= lower.y && uv[i].y <= upper.y))
      throw std::invalid_argument("uv, row " + std::to_string(i) + ": (" + base::in_figures(uv[i].x) + ", " +
                                  base::in_figures(uv[i].y) + ") is not in the domain, u from " +
                                  base::in_figures(lower.x) + " to " + base::in_figures(upper.x) + " and v from " +
                                  base::in_figures(lower.y) + " to " + base::in_figures(upper.y));
}

std::vector<char> Surface::inside(std::span<const Vec2> uv, std::size_t patch) const {
  check_parameters(uv, patch);
  std::vector<char> found;
  for (const Vec2& p : uv) found.push_back(core_->regions[patch].holds(p));
  return found;
}

std::vector<SurfacePoint> Surface::evaluate(std::span<const Vec2> uv, std::size_t patch,
                                            const Progress& progress) const {
  check_parameters(uv, patch);
  std::vector<SurfacePoint> found(uv.size());
  base::parallel_for(
      uv.size(), 256,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const BezierSpan& span = core_->span_at(patch, uv[i]);
          const Vec2 at = (uv[i] - span.lower) / (span.upper - span.lower);
          const Vec4 h = point_of(span.net.data(), span.degrees, at);
          found[i] = {core_->origin + affine(h), normal_of(span.net.data(), span.degrees, at)};
        }
      },
      progress);
  return found;
}

std::vector<Foot> Surface::closest(std::span<const Vec3> points, const Progress& progress) const {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(glm::length(points[i]) <= base::kMaxSize))
      throw std::invalid_argument("points, row " + std::to_string(i) + ": not finite; leave such points out");
  std::vector<Foot> found(points.size());
  base::parallel_for(
      points.size(), 16,
      [&](std::size_t begin, std::size_t end) {
        ClosestSearch search(core_->tree, core_->spans, core_->regions);
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3 p = points[i] - core_->origin;
          const LeafFoot foot = search(p, core_->scale);
          const BezierSpan& span = core_->spans[core_->tree.leaf(foot.leaf).span];
          found[i] = {core_->origin + foot.point, normal_of(span.net.data(), span.degrees, foot.uv), foot.distance,
                      span.patch, span.to_patch(foot.uv)};
        }
      },
      progress);
  return found;
}

}  // namespace riffler::nurbs
