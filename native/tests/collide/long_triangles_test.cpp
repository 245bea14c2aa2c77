// Contact on parts as CAD programs write them: long triangles, needles, few large ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/contact_parts.hpp"
#include "bench/contact_scene.hpp"
#include "collide/lowest_places.hpp"
#include "collide/oriented_boxes.hpp"
#include "collide/outline_lanes.hpp"
#include "collide/pieces.hpp"
#include "collide/surface.hpp"
#include "collide/tools.hpp"
#include "geom/math.hpp"
#include "reference/surface_distance.hpp"
#include "riffler/collide/collider.hpp"
#include "stress/contact_scenes.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"

namespace riffler::collide::long_triangles_test {
namespace {

using stress::ContactScene;
using stress::Random;

constexpr std::array kScenes{ContactScene::Bore, ContactScene::Prism, ContactScene::Needles};

std::vector<reference::Corners> all_corners(const Mesh& mesh) {
  std::vector<reference::Corners> out;
  for (const Vec3i& t : mesh.triangles) out.push_back({mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]});
  return out;
}

TEST(LongTriangles, ClearanceLiesWithinTheReferencesBracket) {
  Random random(3);
  for (const ContactScene scene : kScenes)
    for (int n = 0; n < test::cases(3); ++n) {
      const Mesh part = draw_part(random, scene);
      const Tool tool = stress::draw_tool(random);
      const Collider collider(part);
      const Assembly assembly(tool);
      const Pose pose = draw_pose(random, part, tool);
      const double clearance = collider.clearance(assembly, pose);
      const reference::SurfaceBracket truth =
          reference::least_distance(all_corners(part), reference::AssemblyDistance(tool), pose, 1e-3, 100'000);
      EXPECT_LE(clearance, truth.upper + 1e-3) << name(scene) << ' ' << n;
      EXPECT_GE(clearance, truth.lower - 1e-9) << name(scene) << ' ' << n;
      const Contact contact = collider.query(assembly, pose);
      EXPECT_NEAR(contact.depth, std::max(0.0, -clearance), contact.missed_depth_bound + 1e-9)
          << name(scene) << ' ' << n;
    }
}

TEST(LongTriangles, ABallAlongABoreTakesFewSteps) {
  // Every point of a facet's middle line is equally deep: a search that halves triangles has thousands of equal places.
  Random random(1);
  const Mesh bore = draw_part(random, ContactScene::Bore);
  const Collider collider(bore);
  const Assembly assembly(cutters::ball(6, 30));
  for (const double depth : {0.001, 0.05, 0.3}) {
    Counts counts;
    const Contact contact = collider.query(assembly, {{17 + depth, 0.01, 10}, {0, 0, 1}}, {}, counts);
    EXPECT_NEAR(contact.depth, depth, 0.01) << depth;
    EXPECT_LT(counts.triangles, 20U) << depth;  // examined one by one
    EXPECT_LT(counts.nodes, 2000U) << depth;
  }
}

TEST(LongTriangles, ALeaningBallInABoreNeedsNoSearchOfSingleTriangles) {
  // The lowest place is on the ball, 0.1 rad below its equator. Newton's method began on the cylinder above, whose
  // straight side it followed to the triangle's other end, and back.
  const Collider collider(bench::contact_mesh("bore"));
  const Assembly assembly(bench::contact_tools()[0].tool);
  for (const double z : {20.0, 30.0, 34.2, 37.0, 45.0})
    for (const double turn : {0.0, 0.3, 1.7}) {
      const Vec3 inward(-std::cos(turn), -std::sin(turn), 0), axis = glm::normalize(0.1 * inward + Vec3(0, 0, 1));
      Counts counts;
      const Contact contact = collider.query(assembly, {-17.2 * inward + Vec3(0, 0, z) - 3.0 * axis, axis}, {}, counts);
      EXPECT_NEAR(contact.depth, 0.2, 0.01);
      EXPECT_LE(counts.triangles, 2U) << z << ' ' << turn;
      EXPECT_LE(counts.cells, 40U) << z << ' ' << turn;
    }
}

TEST(LongTriangles, NeedlesUnderAShankAndAHolderOpenFewBoxes) {
  // Half a box's length is more than the cutter's radius and less than the holder's: bounds from its middle say
  // nothing.
  const bench::ContactPart part = bench::contact_part("needles", bench::contact_tools()[0].tool, 10, 1);
  const Collider collider(part.mesh);
  const Assembly assembly(bench::contact_tools()[0].tool);
  for (const Pose& pose : part.poses) {
    Counts counts;
    collider.query(assembly, pose, {}, counts);
    EXPECT_LE(counts.triangles, 2U);
    EXPECT_LE(counts.nodes, 1000U);
  }
}

TEST(LongTriangles, AVertexInTheCornerOfAShankNeedsNoSearchOfSingleTriangles) {
  // A fan of long triangles around a point that pokes into the corner where the shank becomes a cone: each reaches
  // heights below the cone, where no point is in it.
  const Tool tool = bench::contact_tools()[0].tool;
  const Assembly assembly(tool);
  Mesh fan;
  const Vec3 tip(2.5, 0, 40.3);
  fan.vertices.push_back(tip);
  constexpr int kBlades = 16;
  for (int k = 0; k < kBlades; ++k) {
    const double a = 2 * kPi * k / kBlades;
    fan.vertices.push_back(tip + Vec3(12, 6 * std::cos(a), 6 * std::sin(a)));
  }
  for (int k = 0; k < kBlades; ++k) fan.triangles.push_back({0, 1 + k, 1 + (k + 1) % kBlades});
  const Collider collider(fan);
  Counts counts;
  const Contact contact = collider.query(assembly, {{0, 0, 0}, {0, 0, 1}}, {}, counts);
  EXPECT_NEAR(contact.depth, -tool::Outline(tool).nearest(tip.x, tip.z).distance, 1e-9);
  EXPECT_LE(counts.cells, 100U);
}

TEST(LongTriangles, AToolOutOfReachVisitsOneGroup) {
  Random random(2);
  for (const ContactScene scene :
       {ContactScene::Bore, ContactScene::Prism, ContactScene::Needles, ContactScene::Sheet}) {
    const Collider collider(draw_part(random, scene));
    const Assembly assembly(cutters::ball(6, 30));
    Counts counts;
    const Contact contact = collider.query(assembly, {{0, 0, 1000}, {0, 0, 1}}, {}, counts);
    EXPECT_EQ(contact.depth, 0);
    EXPECT_LT(contact.missed_depth_bound, 1e-9);
    EXPECT_LE(counts.nodes, 8U);
    EXPECT_EQ(counts.triangles + counts.cells + counts.points, 0U) << name(scene);
  }
}

TEST(LongTriangles, PiecesCoverATriangleAndAreShort) {
  Random random(4);
  for (int n = 0; n < test::cases(200); ++n) {
    const double size = random.power_of_ten(-3, 3);
    const Vec3 a = size * random.direction(), b = size * random.direction();
    const Vec3 c =
        random.one_in(2) ? a + random.power_of_ten(-9, -1) * size * random.direction() : size * random.direction();
    const double most = size * random.uniform(0.05, 0.5);
    Vec3 area(0), moment(0);
    cut_into_pieces(Piece({a, b, c}), most, 0, 1e300, [&](const Piece& piece) {
      const auto& [i, j] = piece.ends();
      EXPECT_LE(glm::length(piece.points()[i] - piece.points()[j]), most);
      area += piece.area(), moment += glm::length(piece.area()) * piece.centroid();
    });
    const Vec3 whole = 0.5 * glm::cross(b - a, c - a);
    EXPECT_LT(glm::length(area - whole), 1e-12 * size * size);
    EXPECT_LT(glm::length(moment - glm::length(whole) / 3 * (a + b + c)), 1e-11 * size * size * size);
  }
}

TEST(LongTriangles, BoxesHoldTheirTriangles) {
  Random random(5);
  for (const ContactScene scene :
       {ContactScene::Bore, ContactScene::Needles, ContactScene::Soup, ContactScene::FarAway}) {
    const Mesh part = draw_part(random, scene);
    const Surface surface(part);
    const SphereTree& tree = surface.tree();
    for (std::size_t g = 0; !tree.holds_items(g); ++g)
      for (int k = 0; k < base::kLanes; ++k) {
        if (tree.group(g).radius[k] < 0) continue;
        const OrientedBoxes& boxes = surface.boxes(g);
        const std::size_t child = tree.first_child(g) + static_cast<std::size_t>(k), first = tree.first_under(child);
        for (std::size_t t = first; t < first + tree.under(child); ++t)
          for (const Vec3& p : {surface.corners(t).a, surface.corners(t).b, surface.corners(t).c})
            for (int i = 0; i < 3; ++i)
              ASSERT_LE(std::abs(glm::dot(p - Vec3(boxes.x[k], boxes.y[k], boxes.z[k]), boxes.axis[i])),
                        boxes.half[i][k])
                  << name(scene) << " group " << g;
      }
  }
}

TEST(SphereTree, IsAtLeastHalfFullAndEveryGroupKnowsItsParent) {
  Random random(6);
  for (const int n : {1, 8, 9, 16, 17, 64, 65, 500, 512, 513, 4096, 4097, 5000}) {
    Mesh mesh;
    for (int t = 0; t < n; ++t) {
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(random.uniform(0, 50) * random.direction());
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const Surface surface(mesh);
    const SphereTree& tree = surface.tree();
    std::size_t leaves = 0, items = 0;
    for (std::size_t g = 0; g < tree.groups(); ++g) {
      if (tree.holds_items(g)) ++leaves, items += tree.under(g);
      if (g == 0) continue;
      const auto [above, child] = tree.parent(g);
      EXPECT_EQ(tree.first_child(above) + static_cast<std::size_t>(child), g);
      EXPECT_GE(tree.group(above).radius[child], 0);
    }
    EXPECT_EQ(items, static_cast<std::size_t>(n));
    EXPECT_TRUE(n <= 8 || 2 * items >= leaves * base::kLanes) << n;
  }
}

TEST(OutlineLanes, LowestPlacesAreLowestOnConvexToolsAndNeverBelowTheirBound) {
  Random random(7);
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const Assembly assembly(tool);
    const ToolFrame frame({{10, -20, 30}, random.direction()});
    int finished = 0, all = 0;
    for (int n = 0; n < test::cases(40); ++n) {
      Corners t[2 * base::kLanes];
      for (Corners& c : t) {
        const Vec3 p = frame.to_part({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-2, 40)});
        const double size = random.power_of_ten(-2, 1);
        c = {p, p + size * random.direction(), p + random.power_of_ten(-3, 1) * random.direction()};
      }
      LanePlaces places;
      std::fill(std::begin(places.low), std::end(places.low), -1e300);
      lowest_places(assembly.runs(), assembly.lane_edges(), frame, t, 1e300, 1e-9, places);
      for (int k = 0; k < base::kLanes; ++k) {
        TriangleSearch search(assembly.runs());
        Deadline none;
        search.search({frame.to_tool(t[k].a), frame.to_tool(t[k].b), frame.to_tool(t[k].c)}, -1e300, none);
        const double truth = search.least().distance;
        EXPECT_LE(places.low[k], truth + 1e-9);
        EXPECT_GE(places.distance[k], search.low() - 1e-9);
        finished += places.distance[k] - places.low[k] < 1e-8, ++all;
      }
    }
    const auto is_hollow = [](const OutlineRuns::Run& run) { return std::isfinite(run.reach); };
    const bool hollow = std::any_of(assembly.runs().all().begin(), assembly.runs().all().end(), is_hollow);
    EXPECT_TRUE(hollow || finished > all / 2) << finished << " of " << all;
  }
}

}  // namespace
}  // namespace riffler::collide::long_triangles_test
