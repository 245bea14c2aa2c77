#include "plan/rolling_ball.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "plan/half_spaces.hpp"
#include "riffler/mesh/smooth.hpp"

namespace riffler::plan {

namespace {

constexpr double kSameWay = 1e-6;        // rad: directions that differ by less count as one
constexpr int kMaxPresses = 60;          // steps until a ball is seated: each a Newton step within the trust radius
constexpr std::size_t kMaxNormals = 16;  // normals at one contact

/// The frame in which a ball is pressed: motion only along `columns`, the first against the push, which is orthogonal
/// to `across`.
struct Frame {
  Vec3 e[3];
  int columns;
};

Frame frame_of(const Vec3& push, const Vec3& across) {
  const bool flat = across != Vec3(0);
  Frame frame;
  frame.columns = flat ? 2 : 3;
  frame.e[0] = glm::normalize(push);
  frame.e[2] = flat ? across : geom::any_perpendicular(frame.e[0]);
  frame.e[1] = glm::cross(frame.e[2], frame.e[0]);
  return frame;
}

template <class Vector>
Vector in_frame(const Frame& frame, const Vec3& v) {
  Vector out;
  for (int k = 0; k < Vector::length(); ++k) out[k] = glm::dot(v, frame.e[k]);
  return out;
}

}  // namespace

Station exchanged(const Station& s) {
  return {s.centre, {s.feet[1], s.feet[0]}, {s.normals[1], s.normals[0]}};
}

RollingBall::RollingBall(const Mesh& part, double radius, double touch)
    : radius_(radius), touch_(touch), closest_(part), normals_(part.triangles.size()) {
  const Box3 box = bounds(part);
  const double largest = glm::length(glm::max(glm::abs(box.lower), glm::abs(box.upper)));
  rounding_ = 1e-11 * radius + 4e-16 * largest;
  for (std::size_t t = 0; t < normals_.size(); ++t) {
    const Vec3i& v = part.triangles[t];
    const Vec3 n = glm::cross(part.vertices[v.y] - part.vertices[v.x], part.vertices[v.z] - part.vertices[v.x]);
    const double length = glm::length(n);
    normals_[t] = length > 0 && std::isfinite(length) ? n / length : Vec3(0);
  }
}

namespace {

/// One step: the ball's new position and what it meets there, by a linear program. A triangle is convex, so its
/// distance is a convex function of the centre and lies above its tangent: a centre in all these half-spaces enters
/// nothing, however long the step.
template <class Vector>
struct BallStep {
  Vec3 move{0};
  std::array<int, 3> active{-1, -1, -1};  // indices of hits

  static std::optional<BallStep> solve(const std::vector<mesh::Closest::Hit>& hits, const Vec3& centre,
                                       const Frame& frame, double radius, double trust, double slack) {
    thread_local std::vector<HalfSpace<Vector>> spaces;
    thread_local std::vector<int> order;
    order.clear(), spaces.clear();
    for (std::size_t k = 0; k < hits.size(); ++k) {
      const mesh::Closest::Hit& hit = hits[k];
      if (hit.distance > radius + trust) continue;
      if (!(hit.distance > 1e-9 * radius)) return {};
      spaces.push_back({in_frame<Vector>(frame, (centre - hit.point) / hit.distance), radius - hit.distance});
      order.push_back(static_cast<int>(k));
    }
    Vector up(0);
    up[0] = 1;
    const double reach = trust / std::sqrt(static_cast<double>(Vector::length()));
    const auto found = lowest(std::span<const HalfSpace<Vector>>(spaces), up, reach, slack);
    if (!found) return {};
    BallStep step;
    for (int k = 0; k < Vector::length(); ++k) {
      step.move += found->point[k] * frame.e[k];
      step.active[k] = found->active[k] < 0 ? -1 : order[found->active[k]];
    }
    return step;
  }

  bool held() const {
    for (int k = 0; k < Vector::length(); ++k)
      if (active[k] < 0) return false;
    return true;
  }
};

template <class Vector>
RollingBall::Stop press_in(const RollingBall& ball, const Vec3& start, const RollingBall::Press& how,
                           RollingBall::Seat& seat) {
  using Stop = RollingBall::Stop;
  const Vec3 push = how.push - glm::dot(how.push, how.across) * how.across;
  if (!(glm::length(push) > 1e-6)) return Stop::Lost;  // opposite walls give no direction
  const Frame frame = frame_of(push, how.across);
  thread_local std::vector<mesh::Closest::Hit> hits;
  Vec3 centre = start;
  double trust = std::min(how.trust, how.roam);
  double gathered = -1, moved = 0;  // `hits` holds everything within `gathered` of the ball before it moved by `moved`
  for (int round = 0; round < kMaxPresses; ++round) {
    if (moved + trust > gathered || 3 * trust < gathered) {
      gathered = 1.5 * trust, moved = 0;
      hits.clear();
      ball.part().gather(centre, how.radius + gathered, hits);
    } else {
      for (mesh::Closest::Hit& hit : hits) hit = ball.part().on(hit.triangle, centre);
    }
    const auto step = BallStep<Vector>::solve(hits, centre, frame, how.radius, trust, 0.1 * ball.rounding());
    if (!step) {
      if (trust >= how.roam) return Stop::Blocked;
      trust = std::min(4 * trust, how.roam);
      continue;
    }
    const double length = glm::length(step->move);
    if (step->held() && length <= ball.rounding()) {
      seat.centre = centre;
      for (int k = 0; k < Vector::length(); ++k) {
        const mesh::Closest::Hit& hit = hits[step->active[k]];
        seat.feet[k] = {hit.point, (centre - hit.point) / hit.distance, hit.triangle};
      }
      return Stop::Seated;
    }
    centre += step->move, moved += length;
    if (glm::length(centre - start) > how.roam) return Stop::Lost;
    // A single flat plane cannot hold the ball at any distance.
    if (!step->held() && trust >= how.roam && length <= ball.rounding()) return Stop::Lost;
    trust = std::min(step->held() ? std::max(2 * length, 1e-7 * how.radius) : 2 * trust, how.roam);
  }
  return Stop::Lost;
}

}  // namespace

RollingBall::Stop RollingBall::press(const Vec3& centre, const Press& how, Seat& seat) const {
  return how.across != Vec3(0) ? press_in<Vec2>(*this, centre, how, seat) : press_in<Vec3>(*this, centre, how, seat);
}

namespace {

/// Whether `u` lies between those directions of `normals` that differ by less than kFeatureAngle.
bool between(const Vec3& u, const std::vector<Vec3>& normals) {
  const double mild = base::cos(mesh::kFeatureAngle);
  const std::size_t n = normals.size();
  const auto side = [&](const Vec3& a, const Vec3& b) {  // sine of the angle of u to the left of the arc from a to b
    const Vec3 c = glm::cross(a, b);
    const double length = glm::length(c);
    return length > 0 ? glm::dot(u, c) / length : 0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (glm::length(glm::cross(u, normals[i])) <= kSameWay) return true;
    for (std::size_t j = i + 1; j < n; ++j) {
      if (glm::dot(normals[i], normals[j]) < mild) continue;
      const Vec3 c = glm::cross(normals[i], normals[j]);
      if (std::abs(side(normals[i], normals[j])) <= kSameWay && glm::dot(glm::cross(normals[i], u), c) >= 0 &&
          glm::dot(glm::cross(u, normals[j]), c) >= 0)
        return true;
      for (std::size_t k = j + 1; k < n; ++k) {
        if (glm::dot(normals[i], normals[k]) < mild || glm::dot(normals[j], normals[k]) < mild) continue;
        const double a = side(normals[i], normals[j]), b = side(normals[j], normals[k]),
                     d = side(normals[k], normals[i]);
        if ((a >= 0 && b >= 0 && d >= 0) || (a <= 0 && b <= 0 && d <= 0)) return true;
      }
    }
  }
  return false;
}

}  // namespace

std::optional<Vec3> RollingBall::faced(const Foot& foot) const {
  const Vec3& own = normals_[foot.triangle];
  if (glm::dot(own, foot.away) > 0 && glm::length(glm::cross(own, foot.away)) <= kSameWay) return own;
  thread_local std::vector<mesh::Closest::Hit> hits;
  hits.clear();
  closest_.gather(foot.point, touch_, hits);
  std::vector<Vec3> normals;
  for (const mesh::Closest::Hit& hit : hits) {
    const Vec3& n = normals_[hit.triangle];
    if (glm::dot(n, foot.away) < base::cos(mesh::kFeatureAngle)) continue;
    if (std::none_of(normals.begin(), normals.end(), [&](const Vec3& m) { return glm::length(m - n) < 1e-9; }))
      normals.push_back(n);
  }
  std::sort(normals.begin(), normals.end(), [&](const Vec3& a, const Vec3& b) {
    const double x = glm::dot(a, foot.away), y = glm::dot(b, foot.away);
    if (x != y) return x > y;
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  });
  if (normals.size() > kMaxNormals) normals.resize(kMaxNormals);
  if (!between(foot.away, normals)) return {};
  return normals.front();
}

std::vector<Foot> RollingBall::feet(const Vec3& centre, double limit) const {
  std::vector<mesh::Closest::Hit> hits;
  closest_.gather(centre, limit, hits);
  std::sort(hits.begin(), hits.end(), [](const mesh::Closest::Hit& a, const mesh::Closest::Hit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
  std::vector<Foot> feet;
  for (const mesh::Closest::Hit& hit : hits) {
    const Vec3 away = (centre - hit.point) / hit.distance;
    if (std::none_of(feet.begin(), feet.end(), [&](const Foot& f) { return glm::length(f.away - away) < kSameWay; }))
      feet.push_back({hit.point, away, hit.triangle});
  }
  return feet;
}

}  // namespace riffler::plan
