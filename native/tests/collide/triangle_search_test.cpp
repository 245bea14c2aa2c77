#include "collide/triangle_search.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "collide/outline_lanes.hpp"
#include "collide/tools.hpp"
#include "mesh/closest.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"

namespace riffler::collide::triangle_search_test {
namespace {

using stress::Random;

double distance_at(const tool::Outline& outline, const Vec3& p) {
  return outline.nearest(std::hypot(p.x, p.y), p.z).distance;
}

/// A place on the tool's surface, or in it, and round it.
Vec3 place_near(const tool::Outline& outline, Random& random) {
  const tool::OutlineEdge& e = outline.edges()[random.below(static_cast<int>(outline.edges().size()))];
  const Vec2 p = glm::mix(e.from, e.to, random.uniform());
  const double angle = random.uniform(0, 6.3), reach = random.power_of_ten(-4, 1);
  return Vec3(p.x * std::cos(angle), p.x * std::sin(angle), p.y) + reach * random.uniform() * random.direction();
}

Corners triangle_near(const tool::Outline& outline, Random& random) {
  const Vec3 p = place_near(outline, random);
  const double size = random.power_of_ten(-3, 1.7);
  const auto corner = [&] { return p + size * random.uniform(-1, 1) * random.direction(); };
  Corners t{corner(), corner(), corner()};
  switch (random.below(8)) {
    case 0:  // a needle
      t.c = glm::mix(t.a, t.b, random.uniform()) + 1e-7 * random.direction();
      break;
    case 1:  // level
      t.a.z = t.b.z = t.c.z = p.z;
      break;
    case 2:  // upright
      t.b = t.a + Vec3(0, 0, size), t.c = t.a + size * random.square_to({0, 0, 1});
      break;
    case 3:  // through the axis
      t.a.x = t.a.y = 0;
      break;
    case 4:  // without area
      t.c = random.one_in(2) ? t.b : glm::mix(t.a, t.b, 0.25);
      break;
    default:
      break;
  }
  return t;
}

Vec3 on(const Corners& t, double s, double u) {
  if (s + u > 1) s = 1 - s, u = 1 - u;
  return t.a + s * (t.b - t.a) + u * (t.c - t.a);
}

/// By all the ways there are to a triangle, since projecting onto a needle's plane goes wrong.
double off_triangle(const Vec3& p, const Corners& t) {
  double least = glm::length(mesh::closest_on_triangle(p, t.a, t.b, t.c).point - p);
  for (const auto& [a, b] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
    least = std::min(least, glm::length(mesh::closest_on_triangle(p, a, b, b).point - p));
  // In the middle of a needle: across it, from its side to the other two.
  for (const auto& [a, b, c] : {Corners{t.a, t.b, t.c}, Corners{t.b, t.c, t.a}, Corners{t.c, t.a, t.b}}) {
    const double square = glm::dot(b - a, b - a), at = glm::dot(p - a, b - a), tip = glm::dot(c - a, b - a);
    if (!(at > 0 && at < square && tip > 0 && tip < square)) continue;
    const Vec3 other = at < tip ? a + at / tip * (c - a) : c + (at - tip) / (square - tip) * (b - c);
    least =
        std::min(least, glm::length(mesh::closest_on_triangle(p, a + at / square * (b - a), other, other).point - p));
  }
  return least;
}

/// The least distance that many points find, the last of them ever nearer to the best.
double sampled(const tool::Outline& outline, const Corners& t, Random& random) {
  Vec2 best{0, 0};
  double least = distance_at(outline, t.a);
  const auto look = [&](double s, double u) {
    s = std::clamp(s, 0.0, 1.0), u = std::clamp(u, 0.0, 1 - s);
    if (const double d = distance_at(outline, on(t, s, u)); d < least) least = d, best = {s, u};
  };
  for (int i = 0; i <= 24; ++i)
    for (int j = 0; i + j <= 24; ++j) look(i / 24.0, j / 24.0);
  for (double step = 0.05; step > 1e-10; step *= 0.93)
    look(best.x + step * random.uniform(-1, 1), best.y + step * random.uniform(-1, 1));
  return least;
}

void search_all(TriangleSearch& search, const Corners& t) {
  Deadline none;
  search.search(t, -std::numeric_limits<double>::infinity(), none);
}

TEST(TriangleSearch, FindsTheSmallestDistanceAndItsPlaceForEveryTool) {
  std::uint64_t seed = 1;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    Random random(++seed);
    std::size_t most = 0, all = 0;
    for (int n = 0; n < test::cases(1500); ++n) {
      const Corners t = triangle_near(outline, random);
      TriangleSearch search(runs);
      search_all(search, t);
      const TriangleSearch::Least& found = search.least();
      ASSERT_LE(search.low(), sampled(outline, t, random) + 1e-9) << n;
      ASSERT_GE(search.low(), found.distance - (found.distance < -1 ? 1e-4 : 1e-9)) << n << " " << found.distance;
      ASSERT_NEAR(found.distance, distance_at(outline, found.point), 1e-12) << n;
      ASSERT_LE(off_triangle(found.point, t), 1e-10) << n;
      most = std::max(most, search.cells()), all += search.cells();
    }
    EXPECT_LE(most, TriangleSearch::kMaxCells + 40);
    EXPECT_LE(all, 1500U * 40);
  }
}

TEST(TriangleSearch, BoundsFromOneEvaluationAreNeverAboveTheMinimum) {
  std::uint64_t seed = 100;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    Random random(++seed);
    for (int n = 0; n < test::cases(3000); ++n) {
      const Corners t = triangle_near(outline, random);
      TriangleSearch one(runs), search(runs);
      search_all(search, t);
      ASSERT_LE(one.bound(t), search.least().distance + 1e-9) << n;
    }
  }
}

TEST(OutlineRuns, HaveTheOutlinesDistances) {
  std::uint64_t seed = 200;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    std::vector<OutlineRuns::RunAt> of(runs.size());
    Random random(++seed);
    for (int n = 0; n < 5000; ++n) {
      const Vec3 p = place_near(outline, random);
      const double rho = std::hypot(p.x, p.y);
      const tool::Outline::Nearest expected = outline.nearest(rho, p.z);
      ASSERT_NEAR(runs.at({rho, p.z}, of.data()).distance, expected.distance, 1e-12);
    }
  }
}

/// A triangle that is mostly in a tool: its depth is that of where several of the tool's surfaces are equally near.
Corners triangle_through(const tool::Outline& outline, Random& random) {
  const Vec2 top = outline.edges().back().to;
  const Vec3 p(0, 0, random.uniform(0, top.y)), u = random.direction(), v = random.direction();
  return {p + 9.0 * u, p + 9.0 * v, p - 9.0 * u - 9.0 * v};
}

TEST(TriangleSearch, TakesFewCellsForTwoEquallyNearSidesOfAHolder) {
  // Where the top and the side of a holder are equally near, a plane of the nearer side alone left 50 000 cells open.
  const tool::Outline outline(cutters::ball(6, 22).with_holder({{42, 13, 70, 16}}));
  const OutlineRuns runs(outline.edges());
  Random random(500);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = Vec3(0, 0, random.uniform(55.5, 57)) + 0.2 * random.direction();
    const Vec3 u = random.direction(), v = random.direction();
    const Corners t{p + 9.0 * u, p + 9.0 * v, p - 9.0 * u - 9.0 * v};
    TriangleSearch search(runs);
    search_all(search, t);
    ASSERT_LE(search.low(), sampled(outline, t, random) + 1e-9) << n;
    ASSERT_NEAR(search.low(), search.least().distance, 1e-9) << n;
    EXPECT_LT(search.cells(), 5000U) << n;
  }
}

TEST(TriangleSearch, DepthsInHollowsAreMinimalThoughTheToolExtendsBehindTheirEnds) {
  // A level disc that closes a hollow is not a surface: bounds from it stopped searches up to 1e-4 mm above the least.
  const Tool tool = cutters::profile({{{3, 0}, {}}, {{5, 2}, Vec2(5, 0)}, {{2.5, 10}, {}}}, 20);
  const tool::Outline outline(tool);
  const OutlineRuns runs(outline.edges());
  Random random(400);
  for (int n = 0; n < test::cases(300); ++n) {
    const Corners t = triangle_through(outline, random);
    TriangleSearch search(runs);
    search_all(search, t);
    const double sample = sampled(outline, t, random);
    ASSERT_LE(search.low(), sample + 1e-9) << n;
    ASSERT_GE(search.low(), search.least().distance - 1e-5) << n;
    TriangleSearch one(runs);
    ASSERT_LE(one.bound(t), sample + 1e-9) << n;
  }
}

TEST(TriangleSearch, StopsAtTheDeadlineWithABoundThatHolds) {
  const Tool tool = cutters::profile({{{3, 0}, {}}, {{5, 2}, Vec2(5, 0)}, {{2.5, 10}, {}}}, 20);
  const tool::Outline outline(tool);
  const OutlineRuns runs(outline.edges());
  Random random(401);
  for (int n = 0; n < 100; ++n) {
    const Corners t = triangle_through(outline, random);
    TriangleSearch whole(runs), some(runs);
    search_all(whole, t);
    Deadline passed{Deadline::Clock::now()};
    some.search(t, some.bound(t), passed);
    EXPECT_LE(some.cells(), 200U);
    EXPECT_LE(some.low(), whole.least().distance + 1e-9);
  }
}

TEST(OutlineRuns, OutlineAndLanesAgreeToRoundingAtTheTipOfABall) {
  // There heights on the circle differ by less than rounding: judged by them, the foot was the tip, as far off as ρ.
  for (const Tool& tool : {cutters::taper(0.5, 0.2, 8, 40, true), cutters::taper(1, 0.4, 8, 40, true),
                           cutters::ball(6, 30), cutters::ball(0.7, 30), cutters::taper(0.2, 0.2, 2, 8, true)}) {
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    const std::vector<LaneEdge> lanes(outline.edges().begin(), outline.edges().end());
    std::vector<OutlineRuns::RunAt> of(runs.size());
    const tool::OutlineEdge& ball = outline.edges().front();
    const double r = ball.bulge;
    if (!(r > 0)) continue;
    Random random(402);
    for (int n = 0; n < 2000; ++n) {
      const double angle = random.power_of_ten(-12, -6), off = random.sign() * random.power_of_ten(-17, -15);
      const Vec2 p(r * std::sin(angle), off + 2 * r * std::sin(0.5 * angle) * std::sin(0.5 * angle));
      EXPECT_NEAR(outline.nearest(p.x, p.y).distance, 0, 1e-14 * (1 + r));
      EXPECT_NEAR(runs.at(p, of.data()).distance, 0, 1e-14 * (1 + r));
      SphereGroup group;
      group.put(0, {{p.x, 0, p.y}, 0});
      double distance[base::kLanes];
      centre_distances(lanes, ToolFrame({{0, 0, 0}, {0, 0, 1}}), group, distance);
      EXPECT_NEAR(distance[0], 0, 1e-14 * (1 + r));
    }
  }
}

TEST(OutlineLanes, HaveTheOutlinesDistances) {
  std::uint64_t seed = 300;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    std::vector<LaneEdge> edges(outline.edges().begin(), outline.edges().end());
    Random random(++seed);
    for (int n = 0; n < 1000; ++n) {
      const ToolFrame frame({10.0 * random.direction(), random.direction()});
      SphereGroup group;
      for (int k = 0; k < base::kLanes; ++k) group.put(k, {frame.to_part(place_near(outline, random)), 0});
      double distance[base::kLanes];
      centre_distances(edges, frame, group, distance);
      for (int k = 0; k < base::kLanes; ++k)
        ASSERT_NEAR(distance[k], distance_at(outline, frame.to_tool(group.sphere(k).centre)), 1e-12);
    }
  }
}

/// Eight triangles in the part's frame, with spheres round them.
struct Group {
  std::vector<Corners> triangles;
  SphereGroup spheres;
  double distance[base::kLanes], low[base::kLanes];

  Group(const tool::Outline& outline, const ToolFrame& frame, const std::function<Corners()>& make) {
    const OutlineRuns runs(outline.edges());
    const std::vector<LaneEdge> edges(outline.edges().begin(), outline.edges().end());
    for (int k = 0; k < base::kLanes; ++k) {
      const Corners t = make();
      triangles.push_back({frame.to_part(t.a), frame.to_part(t.b), frame.to_part(t.c)});
      spheres.put(k, round_triangle(triangles[k].a, triangles[k].b, triangles[k].c));
    }
    centre_distances(edges, frame, spheres, distance);
    triangle_bounds(runs, edges, frame, spheres, triangles.data(), nullptr, distance, low);
  }
  Corners in_tool(int k, const ToolFrame& frame) const {
    const Corners& t = triangles[static_cast<std::size_t>(k)];
    return {frame.to_tool(t.a), frame.to_tool(t.b), frame.to_tool(t.c)};
  }
};

TEST(OutlineLanes, BoundsOfTrianglesAreNeverAboveTheMinimum) {
  std::uint64_t seed = 500;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    Random random(++seed);
    for (int n = 0; n < test::cases(300, 12); ++n) {
      const ToolFrame frame({10.0 * random.direction(), random.direction()});
      const Group group(outline, frame, [&] { return triangle_near(outline, random); });
      for (int k = 0; k < base::kLanes; ++k) {
        ASSERT_LE(group.low[k], sampled(outline, group.in_tool(k, frame), random) + 1e-9) << n;
        ASSERT_GE(group.low[k], group.distance[k] - group.spheres.radius[k]);
      }
    }
  }
}

/// Boxes in the part's frame, around points near a tool.
OrientedBoxes boxes_near(const tool::Outline& outline, const ToolFrame& frame, Random& random) {
  OrientedBoxes out;
  out.axis[0] = random.direction(), out.axis[1] = random.square_to(out.axis[0]);
  out.axis[2] = glm::cross(out.axis[0], out.axis[1]);
  for (int k = 0; k < base::kLanes; ++k) {
    const Vec3 p = frame.to_part(place_near(outline, random));
    out.x[k] = p.x, out.y[k] = p.y, out.z[k] = p.z;
    for (int i = 0; i < 3; ++i) out.half[i][k] = random.one_in(4) ? 0 : random.power_of_ten(-3, 1.5);
  }
  return out;
}

/// The smallest distance that many points of a box find, the last of them near the best.
double sampled(const tool::Outline& outline, const ToolFrame& frame, const OrientedBoxes& boxes, int k,
               Random& random) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 best(0);
  const auto look = [&](const Vec3& s) {
    Vec3 p(boxes.x[k], boxes.y[k], boxes.z[k]);
    for (int i = 0; i < 3; ++i) p += s[i] * boxes.half[i][k] * boxes.axis[i];
    if (const double d = distance_at(outline, frame.to_tool(p)); d < least) least = d, best = s;
  };
  for (int n = 0; n < 27; ++n) look(Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
  for (int n = 0; n < 100; ++n) look(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  for (double step = 0.3; step > 1e-9; step *= 0.9) look(glm::clamp(best + step * random.direction(), -1.0, 1.0));
  return least;
}

TEST(OutlineLanes, BoundsOfBoxesAreNeverAboveTheMinimumNorBelowTheSpheres) {
  std::uint64_t seed = 550;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    const std::vector<LaneEdge> edges(outline.edges().begin(), outline.edges().end());
    Random random(++seed);
    for (int n = 0; n < test::cases(100); ++n) {
      const ToolFrame frame({10.0 * random.direction(), random.direction()});
      const OrientedBoxes boxes = boxes_near(outline, frame, random);
      double low[base::kLanes], high[base::kLanes];
      box_bounds(runs, edges, frame, boxes, nullptr, low, high);
      for (int k = 0; k < base::kLanes; ++k) {
        const double least = sampled(outline, frame, boxes, k, random);
        ASSERT_LE(low[k], least + 1e-9) << n;
        const Vec3 half(boxes.half[0][k], boxes.half[1][k], boxes.half[2][k]),
            centre(boxes.x[k], boxes.y[k], boxes.z[k]);
        ASSERT_GE(low[k], distance_at(outline, frame.to_tool(centre)) - 4 * glm::length(half) - 1e-9) << n;
        ASSERT_GE(high[k], least - 1e-9) << n;
      }
    }
  }
}

TEST(OutlineRuns, PointsWithFeetBeyondAnEndAreNoDeeperThanSaid) {
  // Each point lies in one run's solid: its depth is at most that of the run's planes, or that beyond its ends.
  std::uint64_t seed = 560;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    std::vector<OutlineRuns::RunAt> of(runs.size());
    Random random(++seed);
    for (int n = 0; n < test::cases(5000); ++n) {
      const Vec3 p = place_near(outline, random);
      const double rho = std::hypot(p.x, p.y), distance = distance_at(outline, p);
      runs.at({rho, p.z}, of.data());
      for (std::size_t run = 0; run < runs.size(); ++run) {
        if (!of[run].inside || of[run].hollow) continue;
        const double slack = random.power_of_ten(-6, 0);  // of the region that the point is known to lie in
        const double beyond = runs.beyond_ends(run, rho - slack, p.z - slack, p.z + slack);
        ASSERT_LE(std::min(of[run].behind[0].distance, beyond), distance + 1e-9) << n;
      }
    }
  }
}

TEST(OutlineLanes, BoundsOfMostTrianglesOutsideAreOfSecondOrderInTheirSize) {
  // Lines of equal distance bend by at most one in the distance. Beside the ends of a run its planes are flatter.
  std::uint64_t seed = 600;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    const OutlineRuns runs(outline.edges());
    if (std::any_of(runs.all().begin(), runs.all().end(), [](const auto& run) { return std::isfinite(run.reach); }))
      continue;  // hollows: their balls are of use within them only
    Random random(++seed);
    std::size_t looked = 0, sharp = 0;
    for (int n = 0; n < test::cases(1500); ++n) {
      const ToolFrame frame({10.0 * random.direction(), random.direction()});
      const Group group(outline, frame, [&] {
        const Vec3 p = place_near(outline, random);
        const auto corner = [&] { return p + 0.02 * random.direction(); };
        return Corners{corner(), corner(), corner()};
      });
      for (int k = 0; k < base::kLanes; ++k) {
        const double radius = group.spheres.radius[k];
        if (group.distance[k] < 1) continue;
        ++looked;
        sharp += group.low[k] >= sampled(outline, group.in_tool(k, frame), random) - radius * radius;
      }
    }
    EXPECT_GT(looked, static_cast<std::size_t>(test::cases(300)));
    EXPECT_GT(static_cast<double>(sharp), 0.7 * static_cast<double>(looked));
  }
}

}  // namespace
}  // namespace riffler::collide::triangle_search_test
