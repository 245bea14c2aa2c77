#include <algorithm>
#include <cmath>

#include "stress/scenario.hpp"

#include "geom/math.hpp"

namespace riffler::stress {

namespace {

/// Draws the moves of one stage.
class Drawer {
 public:
  Drawer(Random& random, const Stage& stage, const Volume& now)
      : random_(random),
        box_(stage.frame.box),
        pitch_(stage.frame.pitch),
        radius_(stage.tool.profile().max_radius()),
        length_(stage.tool.length()),
        tool_(stage.tool),
        now_(now) {}

  void draw(Kind kind, Pose& from, Pose& to);

 private:
  /// A random point in the stock or a little outside.
  Vec3 place() {
    const Vec3 margin = 0.1 * box_.size();
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = random_.uniform(box_.lower[k] - margin[k], box_.upper[k] + margin[k]);
    return p;
  }
  /// A point on a random ray along direction `k`, in the middle of the box.
  Vec3 on_a_ray(int k) {
    Vec3 p = (box_.lower + box_.upper) / 2.0;
    for (int a = 1; a < 3; ++a) {
      const int c = (k + a) % 3, n = dexel::ray_count(box_.size()[c], pitch_);
      p[c] = box_.lower[c] + (random_.below(n) + 0.5) * pitch_;
    }
    return p;
  }
  Vec3 any_way() { return random_.uniform(0.1, 3) * radius_ * random_.direction(); }
  Vec3 any_axis() { return random_.one_in(3) ? random_.along_rays() : random_.direction(); }
  static Vec3 turned(const Vec3& axis, const Vec3& towards, double angle) {
    return glm::normalize(std::cos(angle) * axis + std::sin(angle) * towards);
  }

  void walls_on_rays(Pose& from, Pose& to);
  void tangent_to_ray(Pose& from, Pose& to);
  void on_lattice(Pose& from, Pose& to);
  void on_surface(Pose& from, Pose& to);
  Vec3 surface_point(int& along);
  void about_pivot(Pose& from, Pose& to);
  void edge_on(Pose& from, Pose& to);
  void turn(Pose& from, Pose& to, double angle);

  Random& random_;
  Box3 box_;
  double pitch_, radius_, length_;
  const Tool& tool_;
  const Volume& now_;
};

/// Places the cutter's side, or a flat face, exactly in a plane of rays; the move is a whole number of pitches, or 0.
void Drawer::walls_on_rays(Pose& from, Pose& to) {
  const Vec3 axis = random_.along_rays();
  const int k = axis.x != 0 ? 0 : axis.y != 0 ? 1 : 2;
  from = {on_a_ray((k + 1 + random_.below(2)) % 3), axis};
  if (random_.one_in(2)) from.tip[k] = on_a_ray((k + 1) % 3)[k];
  const int c = (k + 1 + random_.below(2)) % 3;
  from.tip[c] += random_.sign() * radius_;
  to = from;
  to.tip[random_.below(3)] += pitch_ * (random_.below(13) - 6);
}

/// Makes one ray tangent to the cutter's side; the move keeps it tangent or leaves it.
void Drawer::tangent_to_ray(Pose& from, Pose& to) {
  const int k = random_.below(3);
  Vec3 ray{0};
  ray[k] = 1;
  const Vec3 axis = random_.one_in(4) ? ray : random_.direction();
  const Vec3 cross = glm::cross(axis, ray);
  const Vec3 side = glm::length(cross) > 1e-3 ? glm::normalize(cross) : random_.square_to(ray);
  const Vec3 touching = on_a_ray(k) + random_.uniform(-0.4, 0.4) * box_.size()[k] * ray;
  from = {touching + radius_ * side - random_.uniform(0, 1) * std::min(length_, 4 * radius_) * axis, axis};
  const Vec3 ways[] = {Vec3(0), axis, ray, side, random_.direction()};
  to = {from.tip + random_.uniform(-2, 2) * radius_ * random_.one_of(ways), axis};
}

/// Places tip and move on the lattice of half pitches, with the axis along rays.
void Drawer::on_lattice(Pose& from, Pose& to) {
  from.axis = to.axis = random_.along_rays();
  for (int k = 0; k < 3; ++k) {
    const int n = 2 * dexel::ray_count(box_.size()[k], pitch_);
    from.tip[k] = box_.lower[k] + 0.5 * pitch_ * random_.below(n + 1);
    to.tip[k] = from.tip[k] + (random_.one_in(2) ? 0 : 0.5 * pitch_ * (random_.below(17) - 8));
  }
}

/// A point where a ray enters or leaves the material, and the direction of the ray.
Vec3 Drawer::surface_point(int& along) {
  const auto& grids = now_.grids();
  const dexel::Grid& grid = grids[random_.below(static_cast<int>(grids.size()))];
  along = static_cast<int>(grid.axis());
  for (int tries = 0; tries < 20; ++tries) {
    const int i = random_.below(grid.nu()), j = random_.below(grid.nv());
    const auto ray = grid.ray(i, j);
    if (ray.empty()) continue;
    const dexel::Span& s = ray[random_.below(static_cast<int>(ray.size()))];
    return to_world(grid.axis(), {grid.u(i), grid.v(j), random_.one_in(2) ? s.near : s.far});
  }
  return {box_.upper.x, box_.upper.y, box_.upper.z};
}

/// Places the tip exactly on the stock's surface; the move is in the surface, along the ray, or random.
void Drawer::on_surface(Pose& from, Pose& to) {
  int k = 2;
  from.tip = surface_point(k);
  Vec3 ray{0};
  ray[k] = random_.sign();
  from.axis = random_.one_in(3) ? random_.direction() : ray;
  Vec3 way = any_way();
  if (!random_.one_in(3)) way[k] = 0;
  if (random_.one_in(5)) way = Vec3(0);
  to = {from.tip + way, from.axis};
}

void Drawer::turn(Pose& from, Pose& to, double angle) {
  const Vec3 axis = any_axis();
  from = {place(), axis};
  to = {from.tip + (random_.one_in(3) ? Vec3(0) : any_way()), turned(axis, random_.square_to(axis), angle)};
}

/// Turns the tool about a point of its axis, such as a ball tip's centre, or about a point high above.
void Drawer::about_pivot(Pose& from, Pose& to) {
  turn(from, to, random_.power_of_ten(-3, 0.2));
  const double height = random_.one_of({0.0, 1.0, 2.0, 16.0}) * radius_;
  const Vec3 pivot = from.tip + height * from.axis;
  to.tip = pivot - height * to.axis;
}

/// Makes the axis cross, reach or leave the plane perpendicular to a direction of rays.
void Drawer::edge_on(Pose& from, Pose& to) {
  const Vec3 ray = random_.along_rays(), level = random_.square_to(ray);
  const double before = random_.one_in(4) ? 0 : -random_.power_of_ten(-6, -0.1),
               after = random_.one_in(4) ? 0.0 : random_.power_of_ten(-6, -0.1);
  from = {place(), turned(level, ray, before)};
  to = {from.tip + (random_.one_in(3) ? Vec3(0) : any_way()), turned(level, ray, after)};
}

void Drawer::draw(Kind kind, Pose& from, Pose& to) {
  from = to = {place(), any_axis()};
  switch (kind) {
    case Kind::Still:
      break;
    case Kind::TinyWay:
      to.tip += radius_ * random_.power_of_ten(-14, -6) * (random_.one_in(2) ? random_.along_rays() : any_axis());
      break;
    case Kind::AlongRays:
      from.axis = to.axis = random_.direction();
      to.tip += random_.uniform(0, 4) * radius_ * random_.along_rays();
      break;
    case Kind::AxisAlongRays:
      from.axis = to.axis = random_.along_rays();
      to.tip += any_way();
      break;
    case Kind::BothAlongRays:
      from.axis = to.axis = random_.along_rays();
      to.tip += random_.uniform(0, 4) * radius_ * random_.along_rays();
      break;
    case Kind::WallsOnRays:
      return walls_on_rays(from, to);
    case Kind::TangentToRay:
      return tangent_to_ray(from, to);
    case Kind::OnLattice:
      return on_lattice(from, to);
    case Kind::OnSurface:
      return on_surface(from, to);
    case Kind::LongWay: {
      const Vec3 way = random_.power_of_ten(1, 5) * radius_ * random_.direction();
      from.tip -= random_.uniform() * way;
      to.tip = from.tip + way;
      break;
    }
    case Kind::Straight:
      from.axis = to.axis = random_.direction();
      to.tip += any_way();
      break;
    case Kind::TinyAngle:
      return turn(from, to, random_.power_of_ten(-12, -5));
    case Kind::Turning:
      return turn(from, to, random_.power_of_ten(-3, 0.3));
    case Kind::AboutPivot:
      return about_pivot(from, to);
    case Kind::EdgeOnToRays:
      return edge_on(from, to);
    case Kind::NearAntipodal:
      return turn(from, to, kPi - random_.power_of_ten(-6, -1));
    case Kind::FarOutside: {
      turn(from, to, random_.one_in(2) ? 0 : random_.uniform(0, 1));
      const Vec3 away = (random_.power_of_ten(1, 6) * (glm::length(box_.size()) + length_)) * random_.direction();
      from.tip += away, to.tip += away;
      break;
    }
    default:
      break;
  }
}

Kind draw_kind(Random& random, bool first) {
  for (;;) {
    const Kind kind = static_cast<Kind>(random.below(static_cast<int>(Kind::kCount)));
    if (first && kind == Kind::Repeated) continue;
    if (kind == Kind::NearAntipodal && !random.one_in(3)) continue;  // these are slow
    return kind;
  }
}

}  // namespace

const char* name(Kind kind) {
  constexpr const char* kNames[] = {
      "no move",        "tiny move",      "move along rays", "axis along rays", "both along rays", "walls on rays",
      "tangent to ray", "on the lattice", "tip on surface",  "long move",       "straight",        "tiny angle",
      "turning",        "about a pivot",  "edge-on to rays", "near antipodal",  "far outside",     "repeated"};
  static_assert(std::size(kNames) == static_cast<std::size_t>(Kind::kCount));
  return kNames[static_cast<int>(kind)];
}

Move draw_move(Random& random, const Stage& stage, const Volume& now, std::span<const Move> before) {
  Move move{draw_kind(random, before.empty()), {}, {}, std::min(stage.tolerance, stage.finest)};
  if (move.kind == Kind::Repeated) {
    const Move& last = before[random.one_in(2) ? before.size() - 1 : random.below(static_cast<int>(before.size()))];
    move.from = last.from, move.to = last.to, move.tolerance = last.tolerance;
    if (random.one_in(3)) std::swap(move.from, move.to);
    return move;
  }
  Drawer(random, stage, now).draw(move.kind, move.from, move.to);
  // A large turn of a long cutter at a fine tolerance takes thousands of steps.
  if (glm::dot(move.from.axis, move.to.axis) < 0.3)
    move.tolerance = std::min(std::max(move.tolerance, stage.tool.profile().max_radius() * 0.02), stage.finest);
  return move;
}

}  // namespace riffler::stress
