#include "plan/valley.hpp"

#include <algorithm>

#include "base/functions.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr double kLongestStep = 0.5;  // radii
constexpr double kEventStep = 1e-3;   // tolerances: accuracy of ends and corners
constexpr double kOpposite = 1e-3;    // sine of the angle between the sides below which the valley has no direction
constexpr std::size_t kMaxStations = 100000;

double chord_angle(const Vec3& a, const Vec3& b) {
  return 2 * base::asin(std::min(1.0, 0.5 * glm::length(a - b)));
}

/// Unit vector along the valley; for sign = 1, side 0 is on the left, seen along side 1's normal.
Vec3 along(const Station& s, double sign) {
  return sign * glm::normalize(glm::cross(s.feet[0].away, s.feet[1].away));
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0;
  return glm::length(p - a - t * ab);
}

}  // namespace

/// Whether the gap to the bottom is wide enough. Between two planes at an angle θ it is R (1 / sin(θ/2) − 1), and the
/// ball's lowest point is R (1 − sin(θ/2)) from both: the gap times sin(θ/2). Facets of a hollow that the ball nearly
/// fills leave less, however large the angle between the directions to the two contacts.
bool ValleyTracer::is_deep(const Station& s) const {
  const Vec3 up = s.feet[0].away + s.feet[1].away;
  const double length = glm::length(up);
  if (!(rules_.least_gap > 0 && length > 0)) return true;
  const double sine = 0.5 * length;
  return !ball_.part().within(s.centre - (ball_.radius() / length) * up, rules_.least_gap * sine);
}

/// Makes a station of a seat, with its sides ordered as in `like`.
ValleyTracer::Event ValleyTracer::accept(const RollingBall::Seat& seat, const Station* like, Station& to) const {
  std::array<Foot, 2> feet{seat.feet[0], seat.feet[1]};
  if (like) {
    const auto turn = [&](int i, int j) {
      return std::max(chord_angle(feet[i].away, like->feet[0].away), chord_angle(feet[j].away, like->feet[1].away));
    };
    if (turn(1, 0) < turn(0, 1)) std::swap(feet[0], feet[1]);
    if (turn(0, 1) > rules_.jump) return Event::Jump;
  }
  const double angle = chord_angle(feet[0].away, feet[1].away);
  if (glm::length(glm::cross(feet[0].away, feet[1].away)) < kOpposite) return Event::TooFlat;
  if (angle < rules_.least_angle) return Event::TooFlat;
  to.centre = seat.centre, to.feet = feet;
  for (int side = 0; side < 2; ++side) {
    const std::optional<Vec3> normal = ball_.faced(feet[side]);
    if (!normal) return Event::NoFace;
    to.normals[side] = *normal;
  }
  return is_deep(to) ? Event::None : Event::TooFlat;
}

ValleyTracer::Event ValleyTracer::advance(const Station& from, double sign, double length, Station& to) const {
  const Vec3 way = along(from, sign);
  const Vec3 push = from.feet[0].away + from.feet[1].away;
  RollingBall::Seat seat;
  if (ball_.press(from.centre + length * way, {push, way, ball_.radius(), 0.1 * length, length}, seat) !=
      RollingBall::Stop::Seated)
    return Event::Jump;
  return accept(seat, &from, to);
}

ValleyTracer::Found ValleyTracer::start(const Unreached& from, Station& station) const {
  // The largest ball at this point that enters nothing, found by shrinking (Ma, Bae and Choi, Vis. Comput. 28 (2012)
  // 7).
  const double full = ball_.radius(), rise = 1e-6 * full;
  double radius = full;
  Vec3 other(0);
  for (int round = 0; round < 40; ++round) {
    const mesh::Closest::Hit hit =
        ball_.part().above(from.point + radius * from.normal, radius * (1 - 1e-9), {from.point, from.normal, rise, 1});
    if (hit.triangle < 0) break;
    const Vec3 v = hit.point - from.point;
    const double height = glm::dot(v, from.normal), next = glm::dot(v, v) / (2 * height);
    if (!(height > 0) || !(next < radius)) break;
    radius = next, other = hit.point;
  }
  if (!(radius < full) || radius < 1e-4 * full) return Found::NoSeat;
  RollingBall::Seat seat;
  seat.centre = from.point + radius * from.normal;
  seat.feet[0].away = from.normal, seat.feet[1].away = glm::normalize(seat.centre - other);
  // Grown in steps, because a ball is pressed among everything within a step of it. Between two planes it moves exactly
  // as predicted; while it does, steps become longer.
  constexpr double kFirst = 0.1, kShort = 0.03, kLongest = 0.5;
  double longest = kFirst * full;
  while (radius < full) {
    const Vec3 push = seat.feet[0].away + seat.feet[1].away, across = glm::cross(seat.feet[0].away, seat.feet[1].away);
    if (glm::length(across) < 1e-6 || glm::length(push) < 1e-6) return Found::NoSeat;
    const double rate = 2 / glm::length(push);  // rate of the centre in a valley of two planes
    const double move = std::min(longest, (full - radius) * rate), next = std::min(full, radius + move / rate);
    const bool set = move < 0.5 * radius;  // otherwise it might pass a wall
    const Vec3 ahead = set ? seat.centre + move * glm::normalize(push) : seat.centre;
    const RollingBall::Press how{push, glm::normalize(across), next, (set ? 0.1 : 1.1) * move, 4 * move};
    if (ball_.press(ahead, how, seat) == RollingBall::Stop::Seated) {
      radius = next;
      const bool straight = set && glm::length(seat.centre - ahead) < 0.05 * move;
      longest = straight ? std::min(2 * longest, kLongest * full) : std::min(longest, kFirst * full);
    } else if (longest > kShort * full) {
      longest = longest > kFirst * full ? kFirst * full : kShort * full;
    } else {
      return Found::NoSeat;
    }
  }
  switch (accept(seat, nullptr, station)) {
    case Event::None:
      return Found::Valley;
    case Event::TooFlat:
      return Found::TooFlat;
    default:
      return Found::NoFace;
  }
}

std::optional<Station> ValleyTracer::leave(const Vec3& corner, const Foot& a, const Foot& b, const Vec3& way) const {
  Station from, to;
  from.centre = corner, from.feet = {a, b};
  const double sign = glm::dot(glm::cross(a.away, b.away), way) < 0 ? -1 : 1;
  if (advance(from, sign, 1e-3 * ball_.radius(), to) != Event::None) return {};
  return to;
}

std::vector<Station> ValleyTracer::branches(const Vec3& corner) const {
  const std::vector<Foot> feet = ball_.feet(corner, ball_.radius() * (1 + 1e-7) + 100 * ball_.rounding());
  std::vector<Station> out;
  for (std::size_t i = 0; i < feet.size(); ++i)
    for (std::size_t j = i + 1; j < feet.size(); ++j) {
      const Vec3 cross = glm::cross(feet[i].away, feet[j].away);
      if (glm::length(cross) < kOpposite || chord_angle(feet[i].away, feet[j].away) < rules_.least_angle) continue;
      for (const double sign : {1.0, -1.0}) {
        const Vec3 way = sign * glm::normalize(cross);
        if (std::any_of(feet.begin(), feet.end(), [&](const Foot& f) { return glm::dot(f.away, way) < -1e-6; }))
          continue;
        if (const auto station = leave(corner, feet[i], feet[j], way)) out.push_back(*station);
      }
    }
  return out;
}

/// The place near `last` where a third side stops the ball, as a station with its two sides.
std::optional<Station> ValleyTracer::corner_near(const Station& last, double sign, double within) const {
  const Vec3 way = along(last, sign);
  const double reach = 4 * within + 100 * ball_.rounding();
  const Vec3& u = last.feet[0].away;
  const Vec3& v = last.feet[1].away;
  for (const Foot& third : ball_.feet(last.centre, ball_.radius() + reach)) {
    if (glm::dot(third.away, way) > -1e-6) continue;
    if (std::min(chord_angle(third.away, u), chord_angle(third.away, v)) < 0.5 * rules_.jump) continue;
    RollingBall::Seat seat;
    const double roam = 1e-3 * ball_.radius();
    if (ball_.press(last.centre, {u + v + third.away, Vec3(0), ball_.radius(), reach, roam}, seat) !=
        RollingBall::Stop::Seated)
      continue;
    Station corner = last;
    corner.centre = seat.centre;
    // The feet of the corner that continue the two sides.
    for (int side = 0; side < 2; ++side) {
      double least = rules_.jump;
      for (const Foot& foot : seat.feet)
        if (const double turn = chord_angle(foot.away, last.feet[side].away); turn < least)
          least = turn, corner.feet[side] = foot;
      if (const auto normal = ball_.faced(corner.feet[side])) corner.normals[side] = *normal;
    }
    return corner;
  }
  return {};
}

/// Whether the step from `last` to `next` returns to `seed`, after the trace has left it or turned around.
bool ValleyTracer::is_home(const Station& seed, double sign, const Station& last, const Station& next,
                           bool& has_left) const {
  const double home = distance_to_segment(seed.centre, last.centre, next.centre);
  const Vec3 way = along(seed, sign);
  has_left = has_left || home > 3 * rules_.tolerance || glm::dot(along(next, sign), way) < 0;
  if (!has_left || home > rules_.tolerance || glm::dot(next.centre - last.centre, way) <= 0) return false;
  return chord_angle(next.feet[0].away, seed.feet[0].away) < 2 * rules_.jump &&
         chord_angle(next.feet[1].away, seed.feet[1].away) < 2 * rules_.jump;
}

/// For a step without a predecessor: the deviation from a straight line over two such steps, four times that of one.
double ValleyTracer::bend_of_first(const Station& from, double sign, double step, const Station& to) const {
  Station middle;
  if (advance(from, sign, 0.5 * step, middle) != Event::None) return 0;
  return 4 * distance_to_segment(middle.centre, from.centre, to.centre);
}

// Follows the valley from `seed` to its end. Steps are as long as the bend of the polyline allows. Where a step meets
// an event, shorter steps locate it or show that the step was only too long.
ValleyEnd ValleyTracer::follow(const Station& seed, double sign, std::vector<Station>& out, std::size_t& steps) const {
  const double tolerance = rules_.tolerance, radius = ball_.radius();
  const double longest = kLongestStep * radius, shortest = std::max(kEventStep * tolerance, 1e-9 * radius);
  double step = 0.25 * longest;
  double bracket = 0;  // mm: length of a failed step; 0: none
  int calm = 0;        // steps since then
  bool has_left = false;
  Event event = Event::None;
  Station before = seed, last = seed, next;
  for (std::size_t n = 0; n < kMaxStations; ++n) {
    ++steps;
    base::still_wanted();
    const Event met = advance(last, sign, step, next);
    if (met != Event::None) {
      event = met, bracket = step, step *= 0.5, calm = 0;
      if (bracket > (event == Event::TooFlat ? 0.1 * tolerance : shortest)) continue;
      // A mesh defect shorter than the tolerance does not end a valley.
      if (event == Event::NoFace && advance(last, sign, tolerance, next) == Event::None) {
        out.push_back(next), before = last, last = next, bracket = 0, step = tolerance, calm = 0;
        continue;
      }
      if (event == Event::TooFlat) return ValleyEnd::TooFlat;
      if (event == Event::NoFace) return ValleyEnd::Part;
      if (const auto corner = corner_near(last, sign, 2 * bracket)) {
        out.push_back(*corner);
        return ValleyEnd::Corner;
      }
      return ValleyEnd::Part;
    }
    const double bend = out.empty() ? bend_of_first(seed, sign, step, next)
                                    : distance_to_segment(last.centre, before.centre, next.centre);
    if (bend > 0.5 * tolerance && step > tolerance) {
      step *= 0.5, bracket = 0, calm = 0;
      continue;
    }
    if (is_home(seed, sign, last, next, has_left)) return ValleyEnd::Loop;
    out.push_back(next), before = last, last = next;
    if (bracket > step) {
      bracket -= step, step = bracket;
    } else {
      // Past the place where a longer step failed: that step was only too long.
      bracket = 0;
      if (++calm > 2 && bend < 0.125 * tolerance) step = std::min(2 * step, longest);
    }
  }
  return ValleyEnd::Cut;
}

Valley ValleyTracer::trace(const Station& seed, std::size_t& steps) const {
  Valley valley;
  std::vector<Station> forth, back;
  valley.ends[1] = follow(seed, 1, forth, steps);
  if (valley.ends[1] == ValleyEnd::Loop)
    valley.ends[0] = ValleyEnd::Loop;
  else
    valley.ends[0] = follow(seed, -1, back, steps);
  valley.stations.assign(back.rbegin(), back.rend());
  valley.stations.push_back(seed);
  valley.stations.insert(valley.stations.end(), forth.begin(), forth.end());
  return valley;
}

Valley laid_into(const Valley& valley, const RollingBall& ball) {
  Valley out;
  out.ends = valley.ends;
  for (const Station& wide : valley.stations) {
    const Vec3 push = wide.feet[0].away + wide.feet[1].away;
    RollingBall::Seat seat;
    const double radius = ball.radius();
    if (ball.press(wide.centre, {push, along(wide, 1), radius, 0.1 * radius, 20 * radius}, seat) !=
        RollingBall::Stop::Seated)
      continue;
    Station station{seat.centre, {seat.feet[0], seat.feet[1]}, {}};
    if (chord_angle(seat.feet[0].away, wide.feet[0].away) > chord_angle(seat.feet[0].away, wide.feet[1].away))
      std::swap(station.feet[0], station.feet[1]);
    const auto first = ball.faced(station.feet[0]), second = ball.faced(station.feet[1]);
    if (!first || !second) continue;
    station.normals = {*first, *second};
    out.stations.push_back(station);
  }
  return out;
}

void simplify(Valley& valley, double tolerance) {
  std::vector<Station>& s = valley.stations;
  if (s.size() < 3) return;
  std::vector<char> keep(s.size(), 0);
  keep.front() = keep.back() = 1;
  const auto error = [&](std::size_t i, std::size_t a, std::size_t b) {
    const Vec3 ab = s[b].centre - s[a].centre;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0 ? std::clamp(glm::dot(s[i].centre - s[a].centre, ab) / length2, 0.0, 1.0) : 0;
    double most = 4 * glm::length(s[i].centre - s[a].centre - t * ab);
    for (int side = 0; side < 2; ++side)
      most = std::max(most, glm::length(s[i].feet[side].point - s[a].feet[side].point -
                                        t * (s[b].feet[side].point - s[a].feet[side].point)));
    return most;
  };
  // Ramer, Comput. Graph. Image Process. 1 (1972) 244; Douglas and Peucker, Cartographica 10 (1973) 112.
  std::vector<std::pair<std::size_t, std::size_t>> stack;
  const std::size_t middle = s.size() / 2;
  keep[middle] = valley.closed() ? 1 : 0;
  if (valley.closed())
    stack = {{0, middle}, {middle, s.size() - 1}};
  else
    stack = {{0, s.size() - 1}};
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    double most = tolerance;
    std::size_t at = 0;
    for (std::size_t i = a + 1; i < b; ++i)
      if (const double e = error(i, a, b); e > most) most = e, at = i;
    if (at == 0) continue;
    keep[at] = 1;
    stack.emplace_back(a, at), stack.emplace_back(at, b);
  }
  std::size_t n = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    if (keep[i]) s[n++] = s[i];
  s.resize(n);
}

}  // namespace riffler::plan
