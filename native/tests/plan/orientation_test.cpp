#include "riffler/plan/orientation.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "geom/directions.hpp"
#include "plan/smooth_axes.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "stress/random.hpp"

namespace riffler::plan::orientation_test {
namespace {

/// Points along x at the given places.
PencilPath line_path(const std::vector<double>& places, bool closed = false) {
  PencilPath p;
  p.radius = 1, p.closed = closed;
  for (const double x : places) {
    p.centres.emplace_back(x, 0, 1);
    p.contacts.push_back({Vec3(x, 0, 0), Vec3(x, 1, 1)});
    p.normals.push_back({Vec3(0, 0, 1), Vec3(0, -1, 0)});
  }
  return p;
}

PencilPath ring_path(int n) {
  PencilPath p = line_path(std::vector<double>(static_cast<std::size_t>(n), 0.0), true);
  for (int k = 0; k < n; ++k) p.centres[k] = {10 * std::cos(2 * kPi * k / n), 10 * std::sin(2 * kPi * k / n), 1};
  return p;
}

Vec3 leaning(double angle, double way = 0) {
  return {std::sin(angle) * std::cos(way), std::sin(angle) * std::sin(way), std::cos(angle)};
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "no error";
}

constexpr Interpolation kRules[] = {Interpolation::Linear, Interpolation::Slerp, Interpolation::Smooth};

TEST(Orientation, OfOneKeyIsTheSameEverywhere) {
  for (const bool closed : {false, true})
    for (const Interpolation rule : kRules)
      for (const Vec3& axis : oriented(line_path({0, 1, 2}, closed), {{1, leaning(0.3)}}, rule).axes)
        EXPECT_EQ(axis, leaning(0.3));
}

TEST(Orientation, IsTheKeysAtTheirPointsAndConstantOutsideOfThem) {
  const OrientationKeys keys{{1, leaning(0.2)}, {3, leaning(0.9, 1)}};
  for (const Interpolation rule : kRules) {
    const PencilPath p = oriented(line_path({0, 1, 2, 3, 4}), keys, rule);
    EXPECT_EQ(p.axes[0], leaning(0.2));
    EXPECT_EQ(p.axes[1], leaning(0.2));
    EXPECT_EQ(p.axes[3], leaning(0.9, 1));
    EXPECT_EQ(p.axes[4], leaning(0.9, 1));
    EXPECT_EQ(p.keys, keys);
    EXPECT_EQ(p.interpolation, name_of(rule));
  }
}

TEST(Orientation, LinearIsTheSourcesRuleByNumberOfPoints) {
  const Vec3 a = leaning(0), b = leaning(1.2);
  const PencilPath p = oriented(line_path({0, 5, 6, 10}), {{0, a}, {3, b}}, Interpolation::Linear);
  for (int i = 1; i < 3; ++i)
    EXPECT_LT(glm::length(p.axes[i] - glm::normalize(a + (b - a) * (i / 3.0))), 1e-15);  // (4.4), (4.5) with n = 2
}

TEST(Orientation, SlerpTurnsEvenlyByArcLength) {
  const PencilPath p = oriented(line_path({0, 5, 6, 10}), {{0, leaning(0)}, {3, leaning(1.2)}}, Interpolation::Slerp);
  EXPECT_LT(glm::length(p.axes[1] - leaning(0.6)), 1e-15);
  EXPECT_LT(glm::length(p.axes[2] - leaning(0.72)), 1e-15);
  const PencilPath still = oriented(line_path({2, 2, 2}), {{0, leaning(0)}, {2, leaning(1)}}, Interpolation::Slerp);
  EXPECT_LT(glm::length(still.axes[1] - leaning(0.5)), 1e-15) << "points that coincide: by number";
}

TEST(Orientation, GoesRoundALoop) {
  const OrientationKeys keys{{2, leaning(0.1)}, {6, leaning(0.5)}};
  for (const Interpolation rule : kRules) {
    const PencilPath p = oriented(ring_path(8), keys, rule);
    EXPECT_LT(glm::length(p.axes[0] - p.axes[4]), 1e-12) << "in the middle between keys, in both directions";
    EXPECT_LT(glm::length(p.axes[7] - p.axes[5]), 1e-12);
  }
}

TEST(Orientation, RefusesInvalidKeysAndNamesThePoint) {
  const PencilPath p = line_path({0, 1, 2, 3});
  const auto text = [&](const OrientationKeys& keys, Interpolation rule = Interpolation::Slerp) {
    return error_of([&] { oriented(p, keys, rule); });
  };
  const Vec3 up(0, 0, 1);
  EXPECT_EQ(text({}), "keys: at least one is needed");
  EXPECT_EQ(text({{4, up}}), "keys, point 4: the path has 4 points");
  EXPECT_EQ(text({{1, {0, 0, 2}}}), "keys, point 1: not a unit vector");
  EXPECT_EQ(text({{1, Vec3(0)}}), "keys, point 1: not a unit vector");
  EXPECT_EQ(text({{2, {std::numeric_limits<double>::quiet_NaN(), 0, 1}}}), "keys, point 2: not finite");
  for (const Interpolation rule : kRules)
    EXPECT_EQ(text({{0, up}, {3, -up}}, rule), "keys, point 3: opposite to the key at point 0");
  EXPECT_NE(error_of([&] {
              oriented(line_path({2, 2, 3}), {{0, up}, {1, leaning(1)}}, Interpolation::Smooth);
            }).find("keys, point 1: at the same place"),
            std::string::npos);
  EXPECT_EQ(error_of([] { interpolation_named("cubic"); }),
            "interpolation must be linear, slerp or smooth, not \"cubic\"");
}

TEST(Orientation, KeepsToTheMachinesConeOrNamesThePointBeyondIt) {
  const PencilPath p = line_path({0, 1, 2, 3, 4});
  const OrientationKeys keys{{0, leaning(0)}, {4, leaning(1)}};
  EXPECT_NE(
      error_of([&] { oriented(p, keys, Interpolation::Slerp, AxisLimit{{0, 0, 1}, 0.6}); }).find("limit, point 3"),
      std::string::npos);
  const PencilPath kept = oriented(p, keys, Interpolation::Slerp, AxisLimit{{0, 0, 1}, 0.6, true});
  EXPECT_LT(glm::length(kept.axes[2] - leaning(0.5)), 1e-15);
  EXPECT_LT(glm::length(kept.axes[3] - leaning(0.6)), 1e-15);
  EXPECT_NO_THROW(oriented(p, keys, Interpolation::Slerp, AxisLimit{{0, 0, 1}, 1}));
  EXPECT_NEAR(geom::angle_between(project({{0, 0, 1}, 0.4}, {0, 0, -1}), {0, 0, 1}), 0.4, 1e-15) << "straight opposite";
  EXPECT_EQ(project({{0, 0, 1}, 0}, leaning(1)), Vec3(0, 0, 1));
}

/// Keys at random, all spans of the given angle or less.
SmoothAxes random_curve(stress::Random& random, double widest, double period, std::vector<double>& places,
                        std::vector<Vec3>& axes) {
  places.clear(), axes.clear();
  const int n = 2 + random.below(6);
  double s = random.uniform(-5, 5);
  Vec3 a = random.direction();
  for (int k = 0; k < n; ++k) {
    places.push_back(s), axes.push_back(a);
    s += random.power_of_ten(-2, 1);
    const double angle = random.one_in(5) ? 0 : random.uniform(0, widest);
    a = glm::normalize(std::cos(angle) * a + std::sin(angle) * random.square_to(a));
  }
  return {places, axes, period > 0 ? s - places.front() : 0};
}

TEST(SmoothAxes, HasNoJumpInItsDerivativeAtKeys) {
  stress::Random random(11);
  std::vector<double> places;
  std::vector<Vec3> axes;
  for (int n = 0; n < 2000; ++n) {
    const bool loop = n % 2;
    const SmoothAxes curve = random_curve(random, loop ? 0.8 : 2.8, loop, places, axes);
    for (std::size_t k = 0; k < places.size(); ++k) {
      // One-sided differences: their difference goes to zero with the step, for any second derivatives.
      const auto jump = [&](double h) {
        const Vec3 before = (curve.at(places[k]) - curve.at(places[k] - h)) / h;
        return glm::length((curve.at(places[k] + h) - curve.at(places[k])) / h - before);
      };
      const double scale = 1e-2;  // the least distance of two keys
      const double coarse = jump(1e-3 * scale), fine = jump(1e-5 * scale);
      EXPECT_LT(fine, 0.02 * coarse + 1e-5 / scale) << n << " " << k;
      EXPECT_LT(glm::length(curve.at(places[k]) - axes[k]), 1e-15);
    }
  }
}

TEST(SmoothAxes, PassesEvenKeysOfOneGreatCircleAsSlerpDoes) {
  const SmoothAxes curve({0, 1, 2, 3}, {leaning(0), leaning(0.4), leaning(0.8), leaning(1.2)});
  for (double s = 1; s <= 2; s += 0.01) EXPECT_LT(glm::length(curve.at(s) - leaning(0.4 * s)), 1e-14);
}

/// Its largest rate in span k over that of slerp.
double peak_to_slerp(const SmoothAxes& curve, const std::vector<double>& places, const std::vector<Vec3>& axes,
                     std::size_t k) {
  const int n = 100;
  const double h = (places[k + 1] - places[k]) / n;
  double peak = 0;
  for (int i = 0; i < n; ++i)
    peak = std::max(peak, geom::angle_between(curve.at(places[k] + i * h), curve.at(places[k] + (i + 1) * h)) / h);
  return peak / (geom::angle_between(axes[k], axes[k + 1]) / (n * h));
}

TEST(SmoothAxes, TurnsAtMostAsFastAsItsHeaderStates) {
  stress::Random random(5);
  std::vector<double> places;
  std::vector<Vec3> axes;
  double worst = 0;
  for (int n = 0; n < 6000; ++n) {
    const SmoothAxes curve = random_curve(random, n % 2 ? 1.0 : 3.1, 0, places, axes);
    for (std::size_t k = 0; k + 1 < places.size(); ++k)
      if (geom::angle_between(axes[k], axes[k + 1]) > 1e-3)
        worst = std::max(worst, peak_to_slerp(curve, places, axes, k));
  }
  EXPECT_LT(worst, 1.7) << "times as fast as slerp in the same span";
  EXPECT_GT(worst, 1.5) << "it does start from standstill";
}

}  // namespace
}  // namespace riffler::plan::orientation_test
