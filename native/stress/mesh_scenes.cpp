#include "stress/mesh_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "riffler/dexel/boolean.hpp"
#include "riffler/sweep/carve.hpp"
#include "stress/scenario.hpp"

namespace riffler::stress {

namespace {

/// Largest distance from the origin at which a volume can be meshed, in pitches; a little less to allow for its size.
constexpr double kFar = 0x1p21 - 100;

struct Place {
  dexel::Frame frame;
  Vec3i cells;
  double h;
};

Place draw_place(Random& random, int most = 11) {
  Place out;
  out.h = random.one_of({0.25, 0.25, 0.1, 0.3, 1.0 / 3, 0.37, 1.0, 0.1300001});
  Vec3 lower{0}, size;
  for (int k = 0; k < 3; ++k) {
    int cells = 1 + random.below(most);
    if (random.one_in(6)) cells = 1 + random.below(2);
    // Across the border between bricks of 32 cells, and between tiles.
    if (random.one_in(12)) cells = 28 + random.below(12);
    size[k] = out.h * cells * (random.one_in(2) ? 1.0 : random.uniform(0.55, 1.45));
    const int where = random.below(5);
    if (where == 1) lower[k] = random.uniform(-20, 20);
    if (where == 2) lower[k] = out.h * random.sign() * random.power_of_ten(1, 5);
    if (where == 3) lower[k] = out.h * random.sign() * kFar * (random.one_in(2) ? 1.0 : random.uniform());
    if (where == 4) lower[k] = out.h * (random.below(41) - 20) / 2;
  }
  // No side of the box as long as the pitch would be refused; rounding may have made one shorter.
  if (std::max({size.x, size.y, size.z}) < 1.001 * out.h) size.x = 1.4 * out.h;
  const char* directions = random.one_of({"xyz", "xyz", "xyz", "xyz", "z", "z", "x", "y"});
  out.frame = {{lower, lower + size}, out.h, directions};
  for (int k = 0; k < 3; ++k) out.cells[k] = dexel::ray_count(size[k], out.h);
  return out;
}

Vec3 along(const dexel::Grid& grid) {
  return to_world(grid.axis(), Vec3(0, 0, 1));
}

/// Makes spans from random ends, with near < far and gaps between them; normals along the ray or, with `normals`,
/// random.
SolidSpans spans_from(std::vector<double> ends, const dexel::Grid& grid, Random* normals) {
  std::sort(ends.begin(), ends.end());
  SolidSpans out;
  for (std::size_t n = 0; n + 1 < ends.size(); n += 2) {
    if (!(ends[n] < ends[n + 1]) || (!out.empty() && !(out.back().far < ends[n]))) continue;
    const Vec3 near = normals ? normals->direction() : -along(grid), far = normals ? normals->direction() : along(grid);
    out.push_back({ends[n], ends[n + 1], near, far});
  }
  return out;
}

Volume contradictory(Random& random) {
  Volume volume(draw_place(random).frame);
  const double share = random.uniform(0.2, 1);
  fill_at_random(volume, random, share, !random.one_in(3));
  return volume;
}

/// Sets spans on every ray around the lattice points that are inside. `cut`: share of the distance to the next point.
template <class Inside>
Volume from_points(const dexel::Frame& frame, double cut, const Inside& inside) {
  Volume volume(frame);
  fill(volume, [&](const dexel::Grid& grid, int i, int j) {
    const double h = grid.pitch();
    std::vector<double> ends;
    for (int k = 0; k < dexel::ray_count(grid.box().size().z, h); ++k) {
      const Vec3 p = to_world(grid.axis(), Vec3(i, j, k));
      if (!inside(static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z))) continue;
      const double at = grid.box().lower.z + (k + 0.5) * h;
      if (!ends.empty() && ends.back() > at - (cut + 1e-6) * h)
        ends.pop_back();
      else
        ends.push_back(at - cut * h);
      ends.push_back(at + (1 - cut) * h);
    }
    return spans_from(std::move(ends), grid, nullptr);
  });
  return volume;
}

Volume signs(Random& random, bool checkerboard) {
  const Place place = draw_place(random, 9);
  const Vec3i n = place.cells, side{1 + random.below(3), 1 + random.below(3), 1 + random.below(3)};
  const double share = checkerboard ? (random.one_in(2) ? 0 : random.uniform(0, 0.1)) : random.uniform(0.05, 0.95);
  std::vector<bool> inside(static_cast<std::size_t>(n.x) * n.y * n.z);
  const auto index = [&](int i, int j, int k) { return (static_cast<std::size_t>(i) * n.y + j) * n.z + k; };
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const bool even = (i / side.x + j / side.y + k / side.z) % 2 == 0;
        inside[index(i, j, k)] = (checkerboard && even) != (random.uniform() < share);
      }
  const double cut = random.one_in(2) ? 0.5 : random.uniform(0.01, 0.99);
  return from_points(place.frame, cut, [&](int i, int j, int k) { return inside[index(i, j, k)]; });
}

Volume one_ulp(Random& random) {
  Volume volume(draw_place(random).frame);
  const bool alike = random.one_in(2);
  const std::uint64_t seed = random.bits();
  fill(volume, [&](const dexel::Grid& grid, int i, int j) {
    // The same planes on all rays, or different ones on each.
    Random own(seed, alike ? 0 : static_cast<std::uint64_t>(i), alike ? 0 : static_cast<std::uint64_t>(j));
    const double h = grid.pitch(), low = grid.box().lower.z, high = grid.box().upper.z;
    const auto step = [&](double at) { return own.one_in(3) ? at : std::nextafter(at, own.one_in(2) ? 1e30 : -1e30); };
    std::vector<double> ends{step(low), step(high)};
    for (int n = own.below(4); n > 0; --n) {
      const double at = low + h / 2 * own.below(2 * dexel::ray_count(high - low, h) + 1);
      const double cut = own.one_in(3) ? own.uniform(low, high) : step(at);
      ends.push_back(cut), ends.push_back(std::nextafter(cut, 1e30));
    }
    return spans_from(std::move(ends), grid, nullptr);
  });
  return volume;
}

Volume islands(Random& random) {
  Volume volume(draw_place(random).frame);
  const int rare = 2 + random.below(60);
  const bool one_grid = random.one_in(3);
  const auto axis = static_cast<Axis>(random.below(3));
  fill(volume, [&](const dexel::Grid& grid, int, int) -> SolidSpans {
    if (!random.one_in(rare) || (one_grid && grid.axis() != axis)) return {};
    const double low = grid.box().lower.z, high = grid.box().upper.z;
    if (random.one_in(3)) return spans_from({low, high}, grid, nullptr);
    return spans_from({random.uniform(low, high), random.uniform(low, high)}, grid,
                      random.one_in(2) ? &random : nullptr);
  });
  return volume;
}

Vec3 point_in(Random& random, const Box3& box) {
  return box.lower + Vec3(random.uniform(), random.uniform(), random.uniform()) * box.size();
}

/// A random point on the lattice or halfway between its planes.
Vec3 snapped(Random& random, const Place& place) {
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = place.frame.box.lower[k] + place.h / 2 * random.below(2 * place.cells[k] + 1);
  return p;
}

Solid snapped_box(Random& random, const Place& place) {
  const Vec3 a = snapped(random, place), b = snapped(random, place);
  return box(glm::min(a, b), glm::max(a, b) + Vec3(1 + random.below(3)) * (place.h / 2));
}

Solid plate(Random& random, const Place& place) {
  const Box3& b = place.frame.box;
  const double thick = place.h * random.uniform(0.01, 1.2);
  if (random.one_in(2)) {  // of any slope
    const Vec3 n = random.direction();
    const double at = glm::dot(n, point_in(random, b));
    return meet(half_space(n, at + thick), half_space(-n, -at));
  }
  const Vec3 from = random.one_in(2) ? snapped(random, place) : point_in(random, b);
  Vec3 side = random.one_in(2) ? b.size() : Vec3(place.h) * random.uniform(0.3, 6);
  side[random.below(3)] = thick;
  return box(from, from + side);
}

Solid any_solid(Random& random, const Place& place) {
  const Box3& b = place.frame.box;
  switch (random.below(5)) {
    case 0:
      return sphere(point_in(random, b), random.uniform(0.3, 5) * place.h);
    case 1: {
      const Vec3 n = random.direction();
      return half_space(n, glm::dot(n, point_in(random, b)));
    }
    case 2: {
      const Vec3 half{random.uniform(0.05, 5), random.uniform(0.4, 5), random.uniform(0.4, 5)};
      return turned_box(point_in(random, b), half * place.h, random_turn(random));
    }
    case 3:
      return snapped_box(random, place);
    default:
      return plate(random, place);
  }
}

template <class Draw>
Volume solids(Random& random, const Place& place, const Draw& draw) {
  Solid solid = draw(random, place);
  for (int n = random.below(5); n > 0; --n) {
    const Solid other = draw(random, place);
    switch (random.below(3)) {
      case 0:
        solid = unite(solid, other);
        break;
      case 1:
        solid = subtract(solid, other);
        break;
      default:
        solid = subtract(box(place.frame.box.lower, place.frame.box.upper), solid);
    }
  }
  return solid_volume(place.frame, solid);
}

Volume booleans(Random& random) {
  const Place place = draw_place(random);
  Volume volume = random.one_in(2) ? Volume::block(place.frame) : solids(random, place, any_solid);
  for (int n = 1 + random.below(4); n > 0; --n) {
    const dexel::Boolean op = random.one_of(
        {dexel::Boolean::Subtract, dexel::Boolean::Subtract, dexel::Boolean::Add, dexel::Boolean::Intersect});
    apply(op, volume, solid_volume(place.frame, any_solid(random, place)));
  }
  return volume;
}

Volume carved(Random& random) {
  const auto cutters = cutter_names();
  const Stage stage =
      draw_stage(random, cutters[static_cast<std::size_t>(random.below(static_cast<int>(cutters.size())))]);
  Volume volume = Volume::block(stage.frame);
  std::vector<Move> moves;
  for (int n = 1 + random.below(4); n > 0; --n) {
    moves.push_back(draw_move(random, stage, volume, moves));
    sweep::CarveOptions options;
    options.tolerance = moves.back().tolerance;
    sweep::carve(volume, stage.tool, std::vector<Pose>{moves.back().from, moves.back().to}, options);
  }
  return volume;
}

}  // namespace

SolidSpans spans_at_random(Random& random, const dexel::Grid& grid, double share, bool normals) {
  const double h = grid.pitch(), low = grid.box().lower.z, high = grid.box().upper.z;
  std::vector<double> ends;
  for (int n = random.uniform() < share ? 1 + random.below(4) : 0; n > 0; --n)
    for (int e = 0; e < 2; ++e) {
      double at = random.uniform(low - h, high + h);
      if (random.one_in(3)) at = low + std::round((at - low) / (h / 2)) * (h / 2);
      if (random.one_in(10)) at += random.uniform(-2e-3, 2e-3) * h;
      ends.push_back(at);
    }
  return spans_from(std::move(ends), grid, normals ? &random : nullptr);
}

void fill_at_random(Volume& volume, Random& random, double share, bool normals) {
  fill(volume, [&](const dexel::Grid& grid, int, int) { return spans_at_random(random, grid, share, normals); });
}

const char* name(MeshScene scene) {
  constexpr const char* kNames[] = {"contradictory", "signs",      "checkerboard", "one ulp",  "islands",
                                    "solids",        "coincident", "thin",         "booleans", "carved"};
  return kNames[static_cast<int>(scene)];
}

Volume draw_volume(Random& random, MeshScene scene) {
  switch (scene) {
    case MeshScene::Contradictory:
      return contradictory(random);
    case MeshScene::Signs:
      return signs(random, false);
    case MeshScene::Checkerboard:
      return signs(random, true);
    case MeshScene::OneUlp:
      return one_ulp(random);
    case MeshScene::Islands:
      return islands(random);
    case MeshScene::Coincident:
      return solids(random, draw_place(random), snapped_box);
    case MeshScene::Thin:
      return solids(random, draw_place(random), plate);
    case MeshScene::Booleans:
      return booleans(random);
    case MeshScene::Carved:
      return carved(random);
    default:
      return solids(random, draw_place(random), any_solid);
  }
}

}  // namespace riffler::stress
