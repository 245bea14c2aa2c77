#include "riffler/plan/contact_location.hpp"

#include <gtest/gtest.h>

#include "cutters.hpp"
#include "reference/cutter_distance.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "stress/random.hpp"

namespace riffler::plan::contact_location_test {
namespace {

double distance(const reference::CutterDistance& cutter, const Pose& pose, const Vec3& p) {
  const Vec3 d = p - pose.tip;
  const double z = glm::dot(d, pose.axis);
  return cutter.distance(glm::length(glm::cross(d, pose.axis)), z);
}

struct Case {
  Vec3 contact, normal, axis, feed;
};

/// Axes on the normal's side, from the normal itself to square to it.
Case draw(stress::Random& random, int n) {
  Case c{random.direction() * random.uniform(0, 50), random.direction(), {}, random.direction()};
  if (n % 7 == 0) c.contact *= 2000.0;
  if (n % 5 == 0) c.normal = {0, 0, 1}, c.feed = {1, 0, 0};
  const double angles[] = {0, 1e-13, 1e-9, 1e-5, 0.2, 0.4, 0.7, 1.5707963267948966};
  const double angle = random.one_in(2) ? random.one_of(angles) : random.uniform(0, 1.55);
  c.axis = glm::normalize(std::cos(angle) * c.normal + std::sin(angle) * random.square_to(c.normal));
  if (angle == 0) c.axis = c.normal;
  return c;
}

TEST(ContactLocation, TouchesTheTangentPlaneAndStaysOutsideOfIt) {
  stress::Random random(1);
  for (const Tool& tool : named_cutters()) {
    SCOPED_TRACE(tool.name());
    const CutterSupport cutter(tool);
    const reference::CutterDistance reference(tool.profile());
    for (int n = 0; n < 4000; ++n) {
      const Case c = draw(random, n);
      const Pose pose = location_of_contact(cutter, c.contact, c.normal, c.axis, c.feed);
      const double scale = 1e-9 * std::max(1.0, 1e-3 * glm::length(c.contact));
      ASSERT_NEAR(distance(reference, pose, c.contact), 0, scale) << n;
      const CcFrame frame = cc_frame(c.feed, c.normal);
      for (int i = 0; i < 8; ++i) {
        const double way = random.uniform(0, 6.3), off = random.power_of_ten(-4, 1.2);
        const Vec3 p = c.contact + off * (std::cos(way) * frame.x + std::sin(way) * frame.y);
        ASSERT_GT(distance(reference, pose, p), -scale) << n << " " << off;
      }
    }
  }
}

TEST(ContactLocation, TouchesSpheresAndCylindersAtTheContact) {
  stress::Random random(2);
  for (const Tool& tool : named_cutters()) {
    SCOPED_TRACE(tool.name());
    const CutterSupport cutter(tool);
    const reference::CutterDistance reference(tool.profile());
    for (int n = 0; n < 2000; ++n) {
      const Case c = draw(random, n);
      const Pose pose = location_of_contact(cutter, c.contact, c.normal, c.axis, c.feed);
      const double radius = random.power_of_ten(-1, 2), scale = 1e-9 * std::max(1.0, 1e-3 * glm::length(c.contact));
      const Vec3 centre = c.contact - radius * c.normal;
      ASSERT_NEAR(distance(reference, pose, centre), radius, scale) << n;
      const Vec3 along = random.square_to(c.normal);
      for (int i = 0; i < 8; ++i)
        ASSERT_GT(distance(reference, pose, centre + random.uniform(-20, 20) * along), radius - scale) << n;
    }
  }
}

TEST(ContactLocation, OfAFilletIsTheSourcesFormulaWithItsSignPutRight) {
  stress::Random random(3);
  const Tool tool = cutters::fillet(8, 1, 30);
  const CutterSupport cutter(tool);
  const double e = 3, r = 1;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 normal = random.direction();
    const Vec3 axis = glm::normalize(normal * random.uniform(0.1, 3) + random.square_to(normal));
    const Vec3 contact = 10.0 * random.direction(), across = normal - glm::dot(normal, axis) * axis;
    const Vec3 tip = contact + r * normal + e * glm::normalize(across) - r * axis;
    EXPECT_LT(glm::length(location_of_contact(cutter, contact, normal, axis, {1, 0, 0}).tip - tip), 1e-12);
  }
}

TEST(ContactLocation, LiesAheadInTheFeedWhereTheContactCircleIsFree) {
  const CutterSupport fillet(cutters::fillet(8, 1, 30)), flat(cutters::flat(6, 30));
  const Vec3 up(0, 0, 1), feed(0, 2, 0), contact(1, 2, 3);
  EXPECT_LT(glm::length(location_of_contact(fillet, contact, up, up, feed).tip - Vec3(1, -1, 3)), 1e-15);
  EXPECT_LT(glm::length(location_of_contact(flat, contact, up, up, feed).tip - Vec3(1, -1, 3)), 1e-15);
  // It is the limit of leaning forward, and without any feed it is still one place.
  const Vec3 leaning = glm::normalize(Vec3(0, 1e-6, 1));
  EXPECT_LT(glm::length(location_of_contact(fillet, contact, up, leaning, feed).tip - Vec3(1, -1, 3)), 1e-5);
  EXPECT_TRUE(geom::finite(location_of_contact(fillet, contact, up, up, {0, 0, 0}).tip));
}

TEST(ContactLocation, RefusesAnAxisIntoThePart) {
  const Vec3 up(0, 0, 1);
  EXPECT_THROW(location_of_contact(CutterSupport(cutters::flat(6, 30)), {0, 0, 0}, up, -up, {1, 0, 0}),
               std::invalid_argument);
  // The back of a disc on a neck cuts from below.
  const CutterSupport disc(cutters::profile({{{6, 0}, {}}, {{6, 2}, {}}, {{2, 2}, {}}}, 20));
  const Vec3 axis = glm::normalize(Vec3(1, 0, -0.05));
  const Pose pose = location_of_contact(disc, {0, 0, 0}, up, axis, {0, 1, 0});
  EXPECT_GT(pose.tip.z, 5.5);
}

/// A valley of two planes along y with the ball's path in it.
PencilPath valley(double half_angle, double radius) {
  PencilPath p;
  p.radius = radius;
  const Vec3 n0(std::cos(half_angle), 0, std::sin(half_angle)), n1(-n0.x, 0, n0.z);
  for (int k = 0; k < 5; ++k) {
    const Vec3 centre(0, k, radius / std::sin(half_angle));
    p.centres.push_back(centre);
    p.contacts.push_back({centre - radius * n0, centre - radius * n1});
    p.normals.push_back({n0, n1});
  }
  return p;
}

/// Points of a profile, densely, from the angles of its arcs.
std::vector<Vec2> dense_profile(const tool::Profile& profile) {
  std::vector<Vec2> out{{0, 0}};
  Vec2 from{0, 0};
  for (const tool::ProfileSegment& s : profile.segments()) {
    for (int i = 1; i <= 4000; ++i) {
      const double t = i / 4000.0;
      if (s.centre) {
        const Vec2 a = from - *s.centre, b = s.to - *s.centre;
        const double start = std::atan2(a.y, a.x),
                     turn = std::remainder(std::atan2(b.y, b.x) - start, 6.283185307179586);
        out.push_back(*s.centre + glm::length(a) * Vec2(std::cos(start + t * turn), std::sin(start + t * turn)));
      } else {
        out.push_back(glm::mix(from, s.to, t));
      }
    }
    from = s.to;
  }
  return out;
}

TEST(ContactLocation, InAValleyTouchesBothWallsAndEntersNeither) {
  stress::Random random(4);
  for (const Tool& tool : named_cutters()) {
    SCOPED_TRACE(tool.name());
    const CutterSupport cutter(tool);
    const std::vector<Vec2> profile = dense_profile(tool.profile());
    for (int n = 0; n < 100; ++n) {
      const PencilPath path = valley(random.uniform(0.5, 1.4), 3);
      const Vec3 axis = glm::normalize(Vec3(0, 0, 1) + random.uniform(0, 0.4) * random.direction());
      const Pose pose = location_on_path(cutter, path, 2, axis);
      for (int side = 0; side < 2; ++side) {
        const Vec3 normal = path.normals[2][side];
        const double up = glm::dot(normal, axis), out = glm::length(glm::cross(normal, axis));
        double least = 1e9;
        for (const Vec2& p : profile) least = std::min(least, p.y * up - p.x * out);
        EXPECT_NEAR(glm::dot(normal, pose.tip - path.contacts[2][side]) + least, 0, 1e-6) << n;
      }
      if (tool.kind() == "ball") {
        EXPECT_EQ(pose.tip, path.centres[2] - 3.0 * axis);
      }
    }
  }
}

TEST(ContactLocation, OfABallByBothPlanesIsThatOfItsCentre) {
  const PencilPath path = valley(0.8, 3);
  const Vec3 axis = glm::normalize(Vec3(0.1, 0.2, 1));
  const Pose by_centre = location_on_path(CutterSupport(cutters::ball(6, 30)), path, 2, axis);
  // A cutter of the same shape whose profile does not begin with the ball's arc.
  const Tool same = cutters::profile({{{1e-9, 0}, {}}, {{3, 3}, Vec2(0, 3)}}, 30);
  EXPECT_LT(glm::length(location_on_path(CutterSupport(same), path, 2, axis).tip - by_centre.tip), 1e-8);
}

}  // namespace
}  // namespace riffler::plan::contact_location_test
