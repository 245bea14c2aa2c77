// Intersects each ray with the solid in closed form, in the grid's cyclic frame, where rays run along z. Half chords
// are √((r − d)(r + d)) with d the distance of the ray from centre or axis, which stays accurate near tangency.
#include "riffler/dexel/quadrics.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "dexel/joiner.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/geom/interval.hpp"

namespace riffler::dexel {

namespace {

/// The part of a ray inside a solid, and the solid's normals at its ends, in the grid's frame.
struct Chord {
  double near, far;
  Vec3 near_normal, far_normal;
};

/// Half the length of a circle's chord at a distance from its centre below the radius.
double half_chord(double radius, double distance) {
  return std::sqrt((radius - distance) * (radius + distance));
}

/// A sphere in one grid's frame.
class SphereRays {
 public:
  SphereRays(const Sphere& solid, Axis axis) : centre_(to_local(axis, solid.centre)), radius_(solid.radius) {}

  /// Returns false if the ray misses the sphere.
  bool cut(double u, double v, Chord& out) const {
    const double x = u - centre_.x, y = v - centre_.y, d = geom::hypot(x, y);
    if (!(d < radius_)) return false;
    const double half = half_chord(radius_, d);
    out = {centre_.z - half, centre_.z + half, Vec3(x, y, -half) / radius_, Vec3(x, y, half) / radius_};
    return true;
  }

 private:
  Vec3 centre_;
  double radius_;
};

/// Normalises without overflow or underflow of the squared components. Throws for a zero or non-finite vector.
Vec3 checked_axis(const Vec3& axis) {
  const double most = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  if (!geom::finite(axis) || !(most > 0)) throw std::invalid_argument("axis must be finite and not of length 0");
  return glm::normalize(axis / most);
}

/// A cylinder in one grid's frame. A ray passes the slab between the caps and, projected along the axis, a circle. In
/// that projection it moves by `lean_` along `across_` per mm of its length (0 if parallel to the axis), at a constant
/// distance from the axis along `aside_`.
class CylinderRays {
 public:
  CylinderRays(const Cylinder& solid, Axis axis)
      : centre_(to_local(axis, solid.centre)),
        axis_(to_local(axis, checked_axis(solid.axis))),
        radius_(solid.radius),
        half_height_(0.5 * solid.height),
        lean_(geom::hypot(axis_.x, axis_.y)),
        across_(lean_ > 0 ? Vec3(-axis_.z * axis_.x / lean_, -axis_.z * axis_.y / lean_, lean_) : Vec3(0)),
        aside_(lean_ > 0 ? Vec3(-axis_.y / lean_, axis_.x / lean_, 0) : Vec3(0)) {}

  /// Returns false if the ray misses the cylinder.
  bool cut(double u, double v, Chord& out) const {
    const Vec3 foot(u - centre_.x, v - centre_.y, 0);
    const double aside = glm::dot(foot, aside_);
    if (!((lean_ > 0 ? std::abs(aside) : geom::hypot(foot.x, foot.y)) < radius_)) return false;
    const double half = half_chord(radius_, std::abs(aside)), middle = glm::dot(foot, across_);
    const Interval caps = between_caps(glm::dot(foot, axis_)),
                   side = lean_ > 0 ? Interval{(-half - middle) / lean_, (half - middle) / lean_} : kAll;
    out.near = centre_.z + std::max(caps.near, side.near);
    out.far = centre_.z + std::min(caps.far, side.far);
    // `cap`: outward normal of the cap through which the ray leaves.
    const Vec3 cap = axis_.z < 0 ? -axis_ : axis_, off = aside * aside_;
    out.near_normal = caps.near >= side.near ? -cap : (off - half * across_) / radius_;
    out.far_normal = caps.far <= side.far ? cap : (off + half * across_) / radius_;
    return out.near < out.far;
  }

 private:
  static constexpr Interval kAll{-kInfinity, kInfinity};

  /// The part of the ray between the caps, mm from the centre's height; `along`: its foot's coordinate on the axis.
  Interval between_caps(double along) const {
    if (axis_.z == 0) return std::abs(along) < half_height_ ? kAll : Interval{};
    const double a = (-half_height_ - along) / axis_.z, b = (half_height_ - along) / axis_.z;
    return {std::min(a, b), std::max(a, b)};
  }

  Vec3 centre_, axis_;
  double radius_, half_height_;
  double lean_;
  Vec3 across_, aside_;
};

/// Adjusts the coordinate `place` (mm) of a ray along a side of the box with `rays` rays: the last ray may lie on the
/// box's upper side or, a lone one, beyond it. As in from_mesh, it counts as inside.
double within(double place, int rays, double lower, double upper, double pitch) {
  const double inner = upper - Grid::kRayShift * pitch;
  return place < inner ? place : rays == 1 ? 0.5 * (lower + upper) : inner;
}

/// Fills a tile with the solid's chords, clipped by the box.
template <class Rays>
void fill(Grid& grid, std::size_t tile, const Rays& rays) {
  const Box3& box = grid.box();
  const double low = box.lower.z, high = box.upper.z, pitch = grid.pitch(), least = kSliver * pitch;
  const Vec3 along = to_world(grid.axis(), Vec3(0, 0, 1));
  const PackedNormal down = PackedNormal::pack(-along), up = PackedNormal::pack(along);
  Chord chord;
  grid.fill_tile(tile, [&](int i, int j, TileBuilder& builder) {
    const double u = within(grid.shifted_u(i), grid.nu(), box.lower.x, box.upper.x, pitch),
                 v = within(grid.shifted_v(j), grid.nv(), box.lower.y, box.upper.y, pitch);
    if (!rays.cut(u, v, chord)) return;
    const Span span{std::max(chord.near, low), std::min(chord.far, high)};
    if (!(span.near < span.far) || span.length() < least) return;
    SpanNormals normals;
    if (grid.has_normals()) {
      const auto packed = [&](const Vec3& n) { return PackedNormal::pack(to_world(grid.axis(), n)); };
      normals.near = span.near - chord.near > least ? down : packed(chord.near_normal);
      normals.far = chord.far - span.far > least ? up : packed(chord.far_normal);
    }
    builder.add(span, normals);
  });
}

/// Whether the whole solid lies in the frame's box, up to rounding.
bool holds(const Frame& frame, const Box3& solid) {
  const Box3 box = frame.box.grown(kSliver * frame.pitch);
  for (int k = 0; k < 3; ++k)
    if (!(box.lower[k] <= solid.lower[k] && solid.upper[k] <= box.upper[k])) return false;
  return true;
}

/// `inner`: radius of a ball inside the solid; a lattice with a pitch this small meets the ball.
template <class Rays, class Solid>
Volume made(const char* name, const Solid& solid, double inner, const Frame& frame, const Progress& progress) {
  const Box3 around = bounds(solid);
  Volume volume(frame);
  const double share = 1.0 / static_cast<double>(volume.grids().size());
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    Grid& grid = volume.grids()[g];
    const Rays rays(solid, grid.axis());
    base::parallel_for(
        grid.tile_count(), 4,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t t = begin; t < end; ++t) fill(grid, t, rays);
        },
        base::part(progress, static_cast<double>(g) * share, static_cast<double>(g + 1) * share));
    if (grid.span_count() > 0 || !holds(frame, around)) continue;
    std::ostringstream text;
    text << "no ray meets the " << name << ", which is small for a pitch of " << frame.pitch
         << " mm; take a pitch of at most " << inner << " mm";
    throw std::invalid_argument(text.str());
  }
  return volume;
}

Box3 checked_box(const Vec3& centre, const Vec3& reach, const char* name) {
  base::require(geom::finite(centre), "centre", "must be finite");
  const Box3 box{centre - reach, centre + reach};
  for (int k = 0; k < 3; ++k)
    if (!geom::finite(box.lower) || !geom::finite(box.upper) || !(box.lower[k] < box.upper[k]))
      throw std::invalid_argument(std::string("the ") + name +
                                  " is too small or too large for its centre's coordinates: doubles cannot hold both");
  return box;
}

}  // namespace

Box3 bounds(const Sphere& solid) {
  base::require_length(solid.radius, "radius");
  return checked_box(solid.centre, Vec3(solid.radius), "sphere");
}

Box3 bounds(const Cylinder& solid) {
  base::require_length(solid.radius, "radius"), base::require_length(solid.height, "height");
  const Vec3 a = glm::abs(checked_axis(solid.axis));
  const Vec3 disc(geom::hypot(a.y, a.z), geom::hypot(a.z, a.x), geom::hypot(a.x, a.y));
  return checked_box(solid.centre, 0.5 * solid.height * a + solid.radius * disc, "cylinder");
}

Volume sphere(const Sphere& solid, const Frame& frame, const Progress& progress) {
  return made<SphereRays>("sphere", solid, solid.radius, frame, progress);
}

Volume cylinder(const Cylinder& solid, const Frame& frame, const Progress& progress) {
  return made<CylinderRays>("cylinder", solid, std::min(solid.radius, 0.5 * solid.height), frame, progress);
}

}  // namespace riffler::dexel
