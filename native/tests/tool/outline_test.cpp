#include "riffler/tool/outline.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reference/cutter_distance.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"

namespace riffler::tool::outline_test {
namespace {

std::vector<Tool> tools() {
  return {cutters::ball(6, 30),
          cutters::flat(6, 30),
          cutters::fillet(8, 1, 30),
          cutters::taper(0.5, 0.2, 8, 40),
          cutters::taper(1, 0.4, 8, 40, true),
          cutters::cone_end(1.0, 1, 0.4, 8, 40),
          cutters::ball(6, 3),
          cutters::profile({{{1, 0}, {}}, {{1, 1}, {}}, {{4, 4}, Vec2(4, 1)}}, 12),  // a hollow
          cutters::profile({{{6, 0}, {}}, {{6, 2}, {}}, {{2, 2}, {}}}, 20)};         // a disc on a neck
}

/// Points of the half-plane round a tool: anywhere, near the surface, and at heights and radii that its corners have.
std::vector<Vec2> points(const Outline& outline, int count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  const double width = 30, height = outline.edges().back().to.y;
  std::vector<Vec2> out;
  for (int n = 0; n < count; ++n) {
    Vec2 p{share(random) * width, (1.6 * share(random) - 0.3) * height};
    const OutlineEdge& e = outline.edges()[random() % outline.edges().size()];
    if (n % 4 == 1) p = glm::mix(e.from, e.to, share(random)) + 1e-3 * Vec2(share(random) - 0.5, share(random) - 0.5);
    if (n % 4 == 2) p.x = e.to.x;
    if (n % 4 == 3) p.y = e.from.y;
    p.x = std::abs(p.x);
    out.push_back(p);
  }
  for (const OutlineEdge& e : outline.edges()) out.push_back(e.from), out.push_back({0, e.to.y});
  return out;
}

TEST(Outline, DistancesOfCuttersAreThoseOfTheReference) {
  for (const Tool& tool : tools()) {
    SCOPED_TRACE(tool.name());
    const Outline outline(tool);
    const reference::CutterDistance reference(tool.profile());
    for (const Vec2& p : points(outline, 4000)) {
      const auto expected = reference.nearest(p.x, p.y);
      const Outline::Nearest found = outline.nearest(p.x, p.y);
      ASSERT_NEAR(std::abs(found.distance), std::abs(expected.distance), 1e-12) << p.x << " " << p.y;
      if (std::abs(expected.distance) < 1e-12) continue;
      ASSERT_EQ(found.distance < 0, expected.distance < 0) << p.x << " " << p.y;
      EXPECT_NEAR(glm::length(found.normal), 1, 1e-12);
      EXPECT_LT(glm::length(p - found.distance * found.normal - found.point), 1e-9);
    }
  }
}

/// Pieces of which shank and holder overlap each other and the cutter in height, and cross.
Tool assembly() {
  return cutters::ball(6, 20)
      .with_shank({{18, 2, 30, 2}, {24, 0.5, 34, 6}})
      .with_holder({{28, 3, 33, 3.5}, {36, 10, 50, 14}});
}

bool in_pieces(const Tool& tool, const Vec2& p) {
  for (const ToolPiece& t : tool.assembly())
    if (bottom(t.piece) <= p.y && p.y <= top(t.piece) && p.x <= radius_at(t.piece, p.y)) return true;
  return false;
}

TEST(Outline, OfAnAssemblyIsThatOfTheUnionOfItsPieces) {
  const Tool tool = assembly();
  const Outline outline(tool);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> share(0, 1);
  for (const Vec2& p : points(outline, 4000)) {
    const Outline::Nearest found = outline.nearest(p.x, p.y);
    if (std::abs(found.distance) < 1e-9) continue;
    ASSERT_EQ(found.distance < 0, in_pieces(tool, p)) << p.x << " " << p.y;
    // No point of the other side is nearer than the foot, and next to the foot there are some.
    const auto other_side = [&](const Vec2& centre, double most) {
      const double angle = 6.3 * share(random), reach = most * share(random);
      const Vec2 q = centre + reach * Vec2(std::cos(angle), std::sin(angle));
      return in_pieces(tool, {std::abs(q.x), q.y}) != (found.distance < 0);
    };
    bool beside = false;
    for (int n = 0; n < 20; ++n)
      ASSERT_FALSE(other_side(p, (1 - 1e-9) * std::abs(found.distance))) << p.x << " " << p.y;
    for (int n = 0; n < 200 && !beside; ++n) beside = other_side(found.point, 1e-6);
    EXPECT_TRUE(beside) << p.x << " " << p.y;
  }
}

TEST(Outline, NamesTheNearestPart) {
  const Outline outline(cutters::ball(6, 20).with_shank({{20, 2, 30, 2}}).with_holder({{30, 10, 50, 14}}));
  EXPECT_EQ(outline.nearest(4, 10).part, Part::Cutter);
  EXPECT_EQ(outline.nearest(2.5, 19.9).part, Part::Cutter);
  EXPECT_EQ(outline.nearest(2.5, 20.9).part, Part::Shank);
  EXPECT_EQ(outline.nearest(8, 29).part, Part::Holder);
  EXPECT_EQ(outline.nearest(1, 60).part, Part::Holder);
}

TEST(Outline, OfAToolWithAGapReturnsToTheAxis) {
  const Outline outline(cutters::flat(6, 10).with_holder({{15, 10, 50, 10}}));
  EXPECT_NEAR(outline.nearest(0, 12).distance, 2, 1e-15);
  EXPECT_NEAR(outline.nearest(0, 13.5).distance, 1.5, 1e-15);
  EXPECT_EQ(outline.nearest(0, 13.5).part, Part::Holder);
  EXPECT_NEAR(outline.nearest(0, 9).distance, -1, 1e-15);
}

TEST(Outline, WithMarginsContainsAllPointsThatNearToShankAndHolder) {
  const Tool tool = cutters::ball(6, 20).with_shank({{20, 2, 30, 5}}).with_holder({{30, 14, 40, 9}, {40, 9, 60, 16}});
  const Outline grown(tool.with_margins(0.5, 2));
  stress::Random random(8);
  const auto inside = [&](const Frustum& f, double margin, bool ends) {
    const double share = random.uniform(), z = f.z0 + share * (f.z1 - f.z0), rho = f.r0 + share * (f.r1 - f.r0);
    const double angle = random.uniform(-1.57, 1.57), slope = (f.r1 - f.r0) / (f.z1 - f.z0);
    const Vec2 way = ends ? Vec2(std::cos(angle), std::sin(angle)) : glm::normalize(Vec2(1, -slope));
    const Vec2 p = Vec2(rho, z) + margin * random.uniform(0, 0.999) * way;
    return (!ends && (p.y < f.z0 || p.y > f.z1)) || grown.inside(p.x, p.y);
  };
  for (int n = 0; n < 2000; ++n) {
    EXPECT_TRUE(inside(tool.shank()[0], 0.5, false));
    EXPECT_TRUE(inside(tool.holder()[0], 2, true));
    EXPECT_TRUE(inside(tool.holder()[1], 2, true));
  }
  EXPECT_FALSE(grown.inside(3.01, 19.9)) << "the shank's margin is not the cutter's";
  EXPECT_FALSE(grown.inside(17, 27.9));
  EXPECT_THROW(tool.with_margins(-1, 0), std::invalid_argument);
  EXPECT_THROW(tool.with_margins(0, std::numeric_limits<double>::infinity()), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::tool::outline_test
