#include "nc/write/arc_fit.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "riffler/nc/read/reader.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::nc::arc_fit_test {
namespace {

using test::error_of;

using Points = std::vector<Vec3>;

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double square = glm::dot(way, way);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0.0;
  return glm::length(p - a - t * way);
}

double to_polyline(const Vec3& p, std::span<const Vec3> line) {
  double best = glm::length(p - line.front());
  for (std::size_t k = 0; k + 1 < line.size(); ++k) best = std::min(best, to_segment(p, line[k], line[k + 1]));
  return best;
}

/// A piece as a control draws it from what a block says: start, end, centre and sense.
struct Drawn {
  FittedPiece piece;
  Vec3 a, b, c;
  double start, sweep;

  Drawn(const FittedPiece& given, const Vec3& from, const Vec3& to)
      : piece(given),
        a(to_local(piece.normal, from)),
        b(to_local(piece.normal, to)),
        c(to_local(piece.normal, piece.centre)) {
    start = std::atan2(a.y - c.y, a.x - c.x);
    sweep = std::atan2(b.y - c.y, b.x - c.x) - start;
    while (sweep <= 0) sweep += 2 * kPi;
    if (piece.clockwise) sweep -= 2 * kPi;
    if (piece.arc) {
      EXPECT_LT(std::abs(sweep), kPi);
    }
  }
  Vec3 at(double t) const {
    if (!piece.arc) return to_world(piece.normal, a + t * (b - a));
    const double r0 = std::hypot(a.x - c.x, a.y - c.y), r1 = std::hypot(b.x - c.x, b.y - c.y);
    const double angle = start + t * sweep, r = r0 + t * (r1 - r0);
    return to_world(piece.normal, {c.x + r * std::cos(angle), c.y + r * std::sin(angle), a.z + t * (b.z - a.z)});
  }
  /// By samples, and a search by thirds between the nearest one's neighbours.
  double distance(const Vec3& p) const {
    constexpr int kParts = 64;
    const auto off = [&](double t) { return glm::length(at(t) - p); };
    int best = 0;
    for (int k = 1; k <= kParts; ++k)
      if (off(k / 64.0) < off(best / 64.0)) best = k;
    double low = std::max(0, best - 1) / 64.0, high = std::min(kParts, best + 1) / 64.0;
    for (int k = 0; k < 60; ++k) {
      const double left = low + (high - low) / 3, right = high - (high - low) / 3;
      if (off(left) < off(right))
        high = right;
      else
        low = left;
    }
    return off((low + high) / 2);
  }
};

/// The largest distance of either from the other, piece by piece, sampled densely.
double hausdorff(std::span<const Vec3> points, const std::vector<FittedPiece>& pieces) {
  double worst = 0;
  std::size_t at = 0;
  for (const FittedPiece& piece : pieces) {
    const auto run = points.subspan(at, piece.last - at + 1);
    const Drawn path(piece, run.front(), run.back());
    const int parts = static_cast<int>(8 * run.size());
    for (int k = 0; k <= parts; ++k) worst = std::max(worst, to_polyline(path.at(k / double(parts)), run));
    for (std::size_t k = 0; k + 1 < run.size(); ++k)
      for (const double t : {0.0, 0.23, 0.5, 0.77})
        worst = std::max(worst, path.distance(run[k] + t * (run[k + 1] - run[k])));
    at = piece.last;
  }
  return worst;
}

void expect_whole(std::span<const Vec3> points, const std::vector<FittedPiece>& pieces) {
  std::size_t at = 0;
  for (const FittedPiece& piece : pieces) {
    EXPECT_GT(piece.last, at);
    if (piece.arc) {
      EXPECT_GE(piece.last - at, kMinArcMoves);
    }
    at = piece.last;
  }
  EXPECT_EQ(at + 1, points.size());
}

std::size_t arcs(const std::vector<FittedPiece>& pieces) {
  return static_cast<std::size_t>(std::count_if(pieces.begin(), pieces.end(), [](const auto& p) { return p.arc; }));
}

void add_arc(Points& out, const Vec2& centre, double r, double from, double to, int moves, double climb = 0) {
  const double z = out.empty() ? 0 : out.back().z;
  for (int k = out.empty() ? 0 : 1; k <= moves; ++k) {
    const double t = static_cast<double>(k) / moves, angle = from + t * (to - from);
    out.push_back({centre.x + r * std::cos(angle), centre.y + r * std::sin(angle), z + climb * t});
  }
}

void add_line(Points& out, const Vec3& to, int moves) {
  const Vec3 from = out.back();
  for (int k = 1; k <= moves; ++k) out.push_back(from + (to - from) * (static_cast<double>(k) / moves));
}

/// A frame of 40 × 20 with corners of radius 5, counter-clockwise.
Points rounded_frame(int moves) {
  Points out{{5, 0, 3}};
  add_line(out, {35, 0, 3}, moves);
  add_arc(out, {35, 5}, 5, -kPi / 2, 0, moves);
  add_line(out, {40, 15, 3}, moves);
  add_arc(out, {35, 15}, 5, 0, kPi / 2, moves);
  add_line(out, {5, 20, 3}, moves);
  add_arc(out, {5, 15}, 5, kPi / 2, kPi, moves);
  add_line(out, {0, 5, 3}, moves);
  add_arc(out, {5, 5}, 5, kPi, 1.5 * kPi, moves);
  return out;
}

Points placed(const Points& points, Axis normal, const Vec3& shift) {
  Points out;
  for (const Vec3& p : points) out.push_back(to_world(normal, p) + shift);
  return out;
}

TEST(ArcFit, LinesAndArcsOfAFrameAreFoundInEveryPlaneAndDirectionAndFarOut) {
  for (const Axis normal : {Axis::X, Axis::Y, Axis::Z})
    for (const double far : {0.0, 1e5})
      for (const bool turned : {false, true}) {
        Points points = placed(rounded_frame(30), normal, Vec3(far, -far, far));
        if (turned) std::reverse(points.begin(), points.end());
        const auto pieces = fit_arcs(points, 0.005);
        expect_whole(points, pieces);
        ASSERT_EQ(pieces.size(), 8U);
        std::size_t at = 0;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
          EXPECT_EQ(pieces[k].arc, turned == (k % 2 == 0)) << k;
          // A line may take the first point of the arc along, or leave its own last one to it.
          EXPECT_NEAR(static_cast<double>(pieces[k].last), 30.0 * static_cast<double>(k + 1), 1);
          if (pieces[k].arc) {
            EXPECT_EQ(pieces[k].normal, normal);
            EXPECT_EQ(pieces[k].clockwise, turned);
            EXPECT_NEAR(glm::length(points[at] - pieces[k].centre), 5, 0.02);
          }
          at = pieces[k].last;
        }
        EXPECT_LE(hausdorff(points, pieces), 0.005);
      }
}

TEST(ArcFit, ChordsOfACircleGiveThatCircle) {
  for (const double r : {0.05, 1.0, 30.0, 5000.0})
    for (const double turns : {0.3, 1.0, 2.5}) {
      Points points;
      add_arc(points, {7, -3}, r, 0.4, 0.4 + 2 * kPi * turns, static_cast<int>(std::ceil(360 * turns)));
      const auto pieces = fit_arcs(points, 1e-4 * std::max(1.0, r));
      expect_whole(points, pieces);
      // Arcs of at most 3.05 rad, whose ends are points of the run.
      const double each = std::floor(3.05 / (2 * kPi) * 360) / 360;
      EXPECT_EQ(pieces.size(), static_cast<std::size_t>(std::ceil(turns / each - 1e-9))) << r << ' ' << turns;
      for (const FittedPiece& piece : pieces) {
        ASSERT_TRUE(piece.arc);
        EXPECT_FALSE(piece.clockwise);
        EXPECT_LT(glm::length(piece.centre - Vec3(7, -3, 0)), 1e-7 * r);
      }
    }
}

TEST(ArcFit, HelicesRiseWithTheAngle) {
  for (const double climb : {0.01, 3.0, -400.0}) {
    Points points;
    add_arc(points, {0, 0}, 12, 0, -5, 400, climb);
    const auto pieces = fit_arcs(points, 0.002);
    EXPECT_EQ(pieces.size(), 2U) << climb;
    EXPECT_EQ(arcs(pieces), 2U);
    EXPECT_TRUE(pieces[0].clockwise);
    EXPECT_LE(hausdorff(points, pieces), 0.002);
  }
}

TEST(ArcFit, ACurveThatDoesNotRiseEvenlyIsNotAHelix) {
  Points points;
  add_arc(points, {0, 0}, 12, 0, 2, 200);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].z = 1e-4 * std::pow(static_cast<double>(k), 2);
  const auto pieces = fit_arcs(points, 0.01);
  EXPECT_GT(pieces.size(), 3U);
  EXPECT_LE(hausdorff(points, pieces), 0.01);
}

TEST(ArcFit, StraightRunsAreOneLine) {
  for (const double far : {0.0, 1e5}) {
    Points points{Vec3(far)};
    add_line(points, Vec3(far) + Vec3(30, -20, 7), 500);
    const auto pieces = fit_arcs(points, 1e-3);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_FALSE(pieces[0].arc);
  }
}

TEST(ArcFit, PolygonsAreNotCircles) {
  Points points;
  add_arc(points, {0, 0}, 10, 0, 2 * kPi, 6);
  const auto pieces = fit_arcs(points, 0.01);
  EXPECT_EQ(pieces.size(), 6U);
  EXPECT_EQ(arcs(pieces), 0U);
}

TEST(ArcFit, ReversalsAreNotSmoothedAway) {
  // There and back along a line, along an arc, and by less than the tolerance.
  Points there{{0, 0, 0}};
  add_line(there, {10, 0, 0}, 20);
  add_line(there, {0, 0, 0}, 20);
  EXPECT_EQ(fit_arcs(there, 0.01).size(), 2U);
  Points bow;
  add_arc(bow, {0, 0}, 10, 0, 1, 40);
  add_arc(bow, {0, 0}, 10, 1, 0, 40);
  const auto pieces = fit_arcs(bow, 0.01);
  EXPECT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].last, 40U);
  const Points jerk{{0, 0, 0}, {1, 0, 0}, {0.995, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(fit_arcs(jerk, 0.1).size(), 3U);
}

TEST(ArcFit, PointsThatStandStillCostNothing) {
  Points circle, points;
  add_arc(circle, {0, 0}, 10, 0, 2, 100);
  for (const Vec3& p : circle) points.insert(points.end(), {p, p, p});
  const auto pieces = fit_arcs(points, 0.01);
  EXPECT_EQ(pieces.size(), 1U);
  EXPECT_LE(hausdorff(points, pieces), 0.01);
  EXPECT_EQ(fit_arcs(Points(50, Vec3(1, 2, 3)), 0.01).size(), 1U);
  EXPECT_TRUE(fit_arcs({}, 0.01).empty());
  EXPECT_TRUE(fit_arcs(Points{{1, 2, 3}}, 0.01).empty());
  EXPECT_EQ(fit_arcs(Points{{1, 2, 3}, {1, 2, 3}}, 0.01).size(), 1U);
}

TEST(ArcFit, TinySweepsAndSizesAreLines) {
  for (const double sweep : {1e-12, 1e-9, 1e-6})
    for (const double r : {1.0, 1e3, 1e5}) {
      Points points;
      add_arc(points, {0, 0}, r, 0.3, 0.3 + sweep, 50);
      const auto pieces = fit_arcs(points, 1e-3);
      expect_whole(points, pieces);
      EXPECT_EQ(arcs(pieces), 0U);
      EXPECT_LE(hausdorff(points, pieces), 1e-3);
    }
}

TEST(ArcFit, BadInputIsNamed) {
  const Points nan{{0, 0, 0}, {1, NAN, 0}};
  EXPECT_EQ(error_of([&] { fit_arcs(nan, 0.01); }), "points, row 1: not finite");
  for (const double tolerance : {0.0, -1.0, 1e-6, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(error_of([&] { fit_arcs({}, tolerance); }), "tolerance must be finite and at least 0.00002 mm");
}

// --- Random runs ---

/// A smooth curve: sums of sines.
Points random_curve(stress::Random& random, int n) {
  Points out(static_cast<std::size_t>(n), Vec3(0));
  const bool level = random.one_in(2);
  for (int axis = 0; axis < (level ? 2 : 3); ++axis)
    for (int wave = 0; wave < 4; ++wave) {
      const double size = random.uniform(-20, 20) / (1 + wave), rate = random.uniform(0.2, 2 + wave);
      const double phase = random.uniform(0, 6);
      for (int k = 0; k < n; ++k) out[static_cast<std::size_t>(k)][axis] += size * std::sin(rate * k * 4 / n + phase);
    }
  return out;
}

Points random_run(stress::Random& random) {
  const int n = 20 + random.below(400);
  Points points;
  switch (random.below(4)) {
    case 0:
      add_arc(points, {random.uniform(-9, 9), random.uniform(-9, 9)}, random.power_of_ten(-1, 3), random.uniform(0, 6),
              random.uniform(-9, 9), n, random.one_in(2) ? 0 : random.uniform(-20, 20));
      break;
    case 1:
      points = random_curve(random, n);
      break;
    case 2:
      points = rounded_frame(1 + n / 8);
      break;
    default:  // a walk that turns anywhere
      points = {{0, 0, 0}};
      for (int k = 0; k < n; ++k) points.push_back(points.back() + random.power_of_ten(-3, 1) * random.direction());
  }
  const double noise = random.one_in(2) ? 0 : random.power_of_ten(-6, -2);
  for (Vec3& p : points) p += noise * random.uniform() * random.direction();
  const Axis axes[] = {Axis::X, Axis::Y, Axis::Z};
  return placed(points, random.one_of(axes), random.one_in(4) ? Vec3(1e5, -9e4, 1e5) : Vec3(0));
}

TEST(ArcFit, RandomRunsStayWithinTheToleranceInBothDirections) {
  stress::Random random(71);
  std::size_t found = 0;
  for (int round = 0; round < test::cases(400); ++round) {
    const Points points = random_run(random);
    const double tolerance = random.power_of_ten(-4, -0.7);
    const auto pieces = fit_arcs(points, tolerance);
    expect_whole(points, pieces);
    found += arcs(pieces);
    EXPECT_LE(hausdorff(points, pieces), tolerance) << round;
  }
  EXPECT_GT(found, static_cast<std::size_t>(test::cases(400)));
}

TEST(ArcFit, RoundedToFiveDecimalsTheEndIsOnTheCircle) {
  stress::Random random(72);
  const auto rounded = [](const Vec3& p) { return glm::round(p * 1e5) / 1e5; };
  double worst = 0;
  for (int round = 0; round < 300; ++round) {
    const Points points = random_run(random);
    std::size_t at = 0;
    for (const FittedPiece& piece : fit_arcs(points, random.power_of_ten(-4, -1))) {
      const Vec3 from = rounded(points[at]), to = rounded(points[piece.last]);
      const Vec3 centre = from + rounded(piece.centre - points[at]);  // as I J K
      const Vec3 a = to_local(piece.normal, from - centre), b = to_local(piece.normal, to - centre);
      if (piece.arc) worst = std::max(worst, std::abs(std::hypot(a.x, a.y) - std::hypot(b.x, b.y)));
      at = piece.last;
    }
  }
  EXPECT_GT(worst, 0);
  EXPECT_LT(worst, 5e-5);  // LinuxCNC allows 0.001 mm
}

/// G17, G18, G19 and G2, G3 as the reader understands them.
TEST(ArcFit, CodeMadeOfThePiecesFollowsTheRun) {
  stress::Random random(75);
  for (int round = 0; round < 60; ++round) {
    const Points points = random_run(random);
    const double tolerance = random.power_of_ten(-3, -1);
    const auto pieces = fit_arcs(points, tolerance);
    std::string code = "G21 G90 G94 G43 H1\nT1 M6\n";
    const auto add = [&](const char* format, const Vec3& v) {
      char text[96];
      std::snprintf(text, sizeof text, format, v.x, v.y, v.z);
      code += text;
    };
    add("G0 X%.5f Y%.5f Z%.5f\n", points[0]);
    std::size_t at = 0;
    for (const FittedPiece& piece : pieces) {
      const char* planes[] = {"G19 ", "G18 ", "G17 "};
      if (piece.arc) code += planes[static_cast<int>(piece.normal)];
      code += !piece.arc ? "G1" : piece.clockwise ? "G2" : "G3";
      add(" X%.5f Y%.5f Z%.5f", points[piece.last]);
      if (piece.arc) {
        const Vec3 c = piece.centre - points[at];
        char text[96];
        const int written = piece.normal == Axis::Z   ? std::snprintf(text, sizeof text, " I%.5f J%.5f", c.x, c.y)
                            : piece.normal == Axis::Y ? std::snprintf(text, sizeof text, " I%.5f K%.5f", c.x, c.z)
                                                      : std::snprintf(text, sizeof text, " J%.5f K%.5f", c.y, c.z);
        ASSERT_GT(written, 0);
        code += text;
      }
      code += " F100\n";
      at = piece.last;
    }
    const Program program = parse_nc(code + "M30\n", "p", {"3-axis", {{"chord_tolerance", 1e-4}}});
    Points read;
    for (const Pose& pose : program.poses()) read.push_back(pose.tip);
    double worst = 0;
    for (const Vec3& p : points) worst = std::max(worst, to_polyline(p, read));
    for (const Vec3& p : read) worst = std::max(worst, to_polyline(p, points));
    EXPECT_LE(worst, tolerance + 1e-4 + 3e-5) << round;
  }
}

/// The least number of pieces over all divisions of the run, each piece tried by itself.
std::size_t fewest(std::span<const Vec3> points, double tolerance) {
  std::vector<std::size_t> best(points.size(), points.size());
  best[0] = 0;
  for (std::size_t to = 1; to < points.size(); ++to)
    for (std::size_t from = 0; from < to; ++from)
      if (best[from] + 1 < best[to] && fit_arcs(points.subspan(from, to - from + 1), tolerance).size() == 1)
        best[to] = best[from] + 1;
  return best.back();
}

TEST(ArcFit, FewPiecesAreHardlyMoreThanTheFewest) {
  stress::Random random(73);
  std::size_t greedy = 0, least = 0;
  for (int round = 0; round < test::cases(60, 6); ++round) {
    Points points = random_curve(random, 60);
    const double noise = random.one_in(2) ? 0 : 1e-3;
    for (Vec3& p : points) p += noise * random.direction();
    const double tolerance = random.power_of_ten(-2.5, -0.5);
    greedy += fit_arcs(points, tolerance).size();
    least += fewest(points, tolerance);
  }
  RecordProperty("pieces", static_cast<int>(greedy));
  RecordProperty("fewest", static_cast<int>(least));
  EXPECT_GE(greedy, least);
  EXPECT_LE(static_cast<double>(greedy), 1.05 * static_cast<double>(least)) << least;
}

TEST(ArcFit, TimeGrowsHardlyFasterThanTheRun) {
  for (const int kind : {0, 1, 2}) {
    double each[2];
    for (int k = 0; k < 2; ++k) {
      const int n = k == 0 ? 2'000 : 64'000;
      stress::Random random(74);
      Points points;
      if (kind == 0) add_arc(points, {0, 0}, 50, 0, 6, n);
      if (kind == 1) add_line(points = {{0, 0, 0}}, {100, 50, 0}, n);
      if (kind == 2) points = random_curve(random, n);
      std::size_t looked_at = 0;
      fit_arcs(points, 0.01, &looked_at);
      each[k] = static_cast<double>(looked_at) / n;
    }
    EXPECT_LT(each[1], 2.5 * each[0]) << kind;
    EXPECT_LT(each[1], 150) << kind;
  }
}

}  // namespace
}  // namespace riffler::nc::arc_fit_test
