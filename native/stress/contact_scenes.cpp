#include "stress/contact_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "geom/math.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::stress {

namespace {

void add(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int n = static_cast<int>(mesh.vertices.size());
  for (const Vec3& p : {a, b, c}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({n, n + 1, n + 2});
}

Mesh sheet(Random& random, const Vec3& corner) {
  Mesh out;
  const int n = 3 + random.below(30);
  const double side = random.uniform(0.2, 3), rough = random.uniform(0, 2) * side;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) out.vertices.push_back(corner + Vec3(side * i, side * j, random.uniform(0, rough)));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + n + 1;
      out.triangles.push_back({a, a + 1, b + 1});
      out.triangles.push_back({a, b + 1, b});
    }
  return out;
}

Mesh soup(Random& random) {
  Mesh out;
  const int n = 1 + random.below(200);
  for (int k = 0; k < n; ++k) {
    const Vec3 a{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-5, 5)};
    const Vec3 b = a + random.power_of_ten(-3, 1) * random.direction();
    const Vec3 c = a + random.power_of_ten(-3, 1) * random.direction();
    switch (random.below(6)) {
      case 0:
        add(out, a, b, a + random.uniform(0, 2) * (b - a) + random.power_of_ten(-14, -3) * random.direction());
        break;
      case 1:
        add(out, a, b, b);
        break;
      case 2:
        add(out, a, a, a);
        break;
      case 3:
        add(out, a, b, c), add(out, a, b, c), add(out, a, c, b);
        break;
      default:
        add(out, a, b, c);
    }
  }
  return out;
}

Mesh blocks(Random& random) {
  Mesh out;
  for (int k = 1 + random.below(6); k > 0; --k) {
    const Vec3 low(5.0 * random.below(4), 5.0 * random.below(4), 5.0 * random.below(3) - 10), size{5, 5, 5};
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {0.0, 1.0}) {
        Vec3 o = low, u{0}, v{0};
        o[axis] += side * size[axis], u[(axis + 1) % 3] = size.x, v[(axis + 2) % 3] = size.x;
        if (side == 0) std::swap(u, v);
        add(out, o, o + u, o + u + v), add(out, o, o + u + v, o + v);
      }
  }
  return out;
}

Mesh spikes(Random& random) {
  Mesh out;
  const Vec3 tip{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
  for (int k = 2 + random.below(60); k > 0; --k) {
    const Vec3 end = tip + random.uniform(1, 30) * random.direction();
    add(out, tip, end, end + random.power_of_ten(-9, -1) * random.direction());
  }
  return out;
}

Mesh flat(Random& random) {
  Mesh out;
  const double side = random.uniform(20, 80), z = random.below(3) - 1;
  const int n = 1 + random.below(4);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3 o{side * i / n, side * j / n, z}, u{side / n, 0, 0}, v{0, side / n, 0};
      add(out, o, o + u, o + u + v), add(out, o, o + u + v, o + v);
    }
  return out;
}

/// The side of a cylinder about z, facing outwards or, as a bore, inwards.
Mesh tube(int sides, double radius, double height, bool bore) {
  Mesh out;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * kPi * i / sides;
      out.vertices.push_back({radius * std::cos(a), radius * std::sin(a), height * j});
    }
  for (int i = 0; i < sides; ++i) {
    const int p = i, q = (i + 1) % sides;
    const int first = bore ? q + sides : q, second = bore ? q : q + sides;
    out.triangles.push_back({p, first, second});
    out.triangles.push_back(bore ? Vec3i(p, p + sides, q + sides) : Vec3i(p, q + sides, p + sides));
  }
  return out;
}

Mesh prism(Random& random) {
  const int sides = 3 + random.below(30);
  const double height = random.uniform(5, 60),
               radius = random.uniform(5, 30);  // separate statements, so that every compiler draws in this order
  Mesh out = tube(sides, radius, height, false);
  for (int i = 1; i + 1 < sides; ++i)
    out.triangles.push_back({0, i + 1, i}), out.triangles.push_back({sides, sides + i, sides + i + 1});
  return out;
}

Mesh needles(Random& random) {
  const int strips = 10 + random.below(400);
  const double wide = random.power_of_ten(-3, 0), length = random.uniform(5, 80), high = random.uniform(0, 2);
  Mesh out;
  for (int i = 0; i <= strips; ++i)
    for (const double y : {0.0, length}) out.vertices.push_back({wide * i, y, high * std::sin(0.4 * wide * i)});
  for (int i = 0; i < 2 * strips; i += 2)
    out.triangles.push_back({i, i + 2, i + 3}), out.triangles.push_back({i, i + 3, i + 1});
  return out;
}

}  // namespace

const char* name(ContactScene scene) {
  constexpr const char* kNames[] = {"sheet", "soup", "blocks", "spikes", "far away",
                                    "flat",  "bore", "prism",  "needles"};
  return kNames[static_cast<int>(scene)];
}

Mesh draw_part(Random& random, ContactScene scene) {
  switch (scene) {
    case ContactScene::Soup:
      return soup(random);
    case ContactScene::Blocks:
      return blocks(random);
    case ContactScene::Spikes:
      return spikes(random);
    case ContactScene::FarAway:
      return sheet(random, {1e5 * random.sign(), 1e5 * random.sign(), 1e5 * random.sign()});
    case ContactScene::Flat:
      return flat(random);
    case ContactScene::Bore:
      return tube(360, 20, 60, true);
    case ContactScene::Prism:
      return prism(random);
    case ContactScene::Needles:
      return needles(random);
    default:
      return sheet(random, {0, 0, 0});
  }
}

Tool draw_tool(Random& random) {
  const double d = 2.0 * (1 + random.below(6)), length = d * random.uniform(1.5, 4);
  Tool tool = cutters::ball(d, length);
  switch (random.below(7)) {
    case 0:
      tool = cutters::flat(d, length);
      break;
    case 1:
      tool = cutters::fillet(d, d * random.uniform(0.05, 0.5), length);
      break;
    case 2:
      tool = cutters::taper(0.1 * d, 0.2, d, 4 * d, random.one_in(2));
      break;
    case 3:
      tool = cutters::cone_end(1.0, 0.1 * d, 0.5, d, 4 * d);
      break;
    case 4:  // a hollow between two cones
      tool =
          cutters::profile({{{0.3 * d, 0}, {}}, {{0.5 * d, 0.2 * d}, Vec2(0.5 * d, 0)}, {{0.25 * d, d}, {}}}, length);
      break;
    default:
      break;
  }
  const double top = tool.length(), r = 0.5 * d;
  if (!random.one_in(4)) tool = tool.with_shank({{top, r, top + 5, r}, {top + 5, r, top + 9, 1.8 * r}});
  if (random.one_in(3)) {
    const double gap = random.one_in(4) ? 2 : 0, from = top + 9 + gap;
    tool = tool.with_holder({{from, 3 * r, from + 20, 3 * r}, {from + 20, 4 * r, from + 30, 2 * r}});
  }
  return tool;
}

Pose draw_pose(Random& random, const Mesh& part, const Tool& tool) {
  const Vec3i& t = part.triangles[random.below(static_cast<int>(part.triangles.size()))];
  const Vec3 &a = part.vertices[t.x], &b = part.vertices[t.y], &c = part.vertices[t.z];
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  if (random.one_in(4)) u = random.below(2), v = u > 0 ? 0 : random.below(2);  // a vertex
  const Vec3 p = a + u * (b - a) + v * (c - a), n = glm::cross(b - a, c - a);
  const Vec3 normal = glm::length(n) > 1e-12 ? glm::normalize(n) : Vec3(0, 0, 1);
  Pose pose{p, random.one_in(3) ? normal : random.direction()};
  if (random.one_in(8)) pose.axis = {0, 0, random.sign()};
  const double r = 0.5 * tool.diameter();
  switch (random.below(8)) {
    case 0:  // a ball tangent from outside or with its side along the surface
      pose.tip = p + r * normal - r * pose.axis;
      break;
    case 1:
      pose.tip = p - random.uniform(0, tool.length()) * pose.axis;
      break;
    case 2:
      pose.tip = p + random.power_of_ten(0, 5) * random.direction();
      break;
    case 3:  // touches or not, by rounding
      pose.tip = p + random.power_of_ten(-15, -6) * random.direction();
      break;
    default:
      pose.tip = p + random.uniform(-0.5, 1) * normal;
  }
  return pose;
}

}  // namespace riffler::stress
