#include "riffler/plan/surface_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "plan/operation_moves.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/lift.hpp"

namespace riffler::plan {

namespace {

constexpr double kTouches = 5e-7;  // mm: the collider's own error is up to 1e-6
constexpr double kSteep = 0.3;     // below this component of the normal along the axis, poses move square to the axis
constexpr double kNearlyLevel = 0.95;
constexpr double kChords = 0.9;     // share of the tolerance for moves; the rest is for rounding
constexpr double kExplained = 1.5;  // factor on the deviation, which is measured, not proven
constexpr int kRounds = 40;
constexpr int kMaxHalvings = 14;
constexpr double kFarther = 4;                     // a pose moves by at most so many times its distance
constexpr double kProbe = 1e-5, kMaxProbe = 1e-2;  // mm: step for the distance's derivative

constexpr double kForceSpacing = 10;  // mm: no force is asked of fixtures

enum class Result : unsigned char { Fitted, Away, Raised, Kept };

struct Place {
  Pose pose;
  Result result = Result::Away;
  double before = 0, after = 0;  // distance of the tool from its place, mm; negative in the surface
};

class Fitter {
 public:
  Fitter(const Tool& tool, const collide::Collider& exact, const collide::Collider* fixtures,
         const SurfaceFitRule& rule)
      : assembly_(tool), exact_(exact), fixtures_(fixtures), rule_(rule) {}

  /// The distance of the tool from its place.
  double distance(const Pose& pose) const { return exact_.clearance(assembly_, pose) - rule_.clearance; }

  /// `cuts`: whether the tool shall touch the surface; otherwise it is only raised out of it.
  Place place(const Pose& pose, bool cuts) const {
    base::still_wanted();
    const collide::Collider::Nearest nearest = exact_.nearest(assembly_, pose);
    Place out{pose};
    out.before = out.after = nearest.distance - rule_.clearance;
    if (!cuts && out.before >= -kChords * rule_.tolerance) return out;
    if (!cuts) return raised(out);
    if (out.before > contact()) return out;
    out.result = Result::Fitted;
    if (std::abs(out.before) <= kTouches) return out;
    const double step = std::clamp(std::abs(out.before), kProbe, kMaxProbe);
    const double up = std::clamp((distance(moved(pose, pose.axis, step)) - out.before) / step, 0.0, 1.0);
    Vec3 aside = pose.tip - nearest.point;
    aside -= glm::dot(aside, pose.axis) * pose.axis;
    const double size = glm::length(aside);
    const bool sideways_first = rule_.level ? up < kNearlyLevel : up < kSteep;
    for (const bool sideways : {sideways_first, !sideways_first}) {
      if (sideways && !(size > kProbe)) continue;
      const Vec3 direction = sideways ? aside / size : pose.axis;
      const std::optional<double> at =
          root(pose, direction, out.before, sideways ? std::sqrt(std::max(0.0, 1 - up * up)) : up);
      if (!at) continue;
      const Pose found = moved(pose, direction, *at);
      if (!keeps_off(pose, found)) continue;
      out.pose = found, out.after = distance(found);
      return out;
    }
    return raised(out);
  }

  /// Appends the poses that the move between two poses needs between them.
  void divide(const Pose& a, const Pose& b, bool cuts, int halvings, std::vector<Place>& out, double& worst) const {
    if (halvings == 0 || glm::length(b.tip - a.tip) <= 0.5 * rule_.tolerance) return;
    const Pose middle{0.5 * (a.tip + b.tip), a.axis};
    const double off = distance(middle), enough = kChords * rule_.tolerance;
    if (off >= -enough && (!cuts || off <= enough || off > contact())) {
      if (off < 0 || (cuts && off <= contact())) worst = std::max(worst, std::abs(off));
      return;
    }
    const Place found = place(middle, cuts);
    if (found.result == Result::Away) return;
    if (glm::length(found.pose.tip - middle.tip) <= kTouches) {  // no better place
      if (off < 0) out.push_back(found);
      return;
    }
    divide(a, found.pose, cuts, halvings - 1, out, worst);
    out.push_back(found);
    divide(found.pose, b, cuts, halvings - 1, out, worst);
  }

 private:
  /// The largest distance of a tool that touches the triangles.
  double contact() const { return kExplained * rule_.deviation + 2 * rule_.tolerance; }

  static Pose moved(const Pose& pose, const Vec3& direction, double by) {
    return {pose.tip + by * direction, pose.axis};
  }

  /// Where along a direction the distance is 0: secants, within the bracket once there is one. `slope`: derivative at
  /// 0.
  std::optional<double> root(const Pose& pose, const Vec3& direction, double at_0, double slope) const {
    const double farthest = kFarther * std::abs(at_0) + kProbe;
    double last = 0, value = at_0;
    std::optional<double> inside, outside;
    (at_0 < 0 ? inside : outside) = 0.0;
    double s = std::clamp(slope > 0.1 ? -at_0 / slope : -3 * at_0, -farthest, farthest);
    for (int round = 0; round < kRounds; ++round) {
      const double f = distance(moved(pose, direction, s));
      if (std::abs(f) <= kTouches) return s;
      (f < 0 ? inside : outside) = s;
      double next = f != value ? s - f * (s - last) / (f - value) : s;
      if (inside && outside) {
        const auto [low, high] = std::minmax(*inside, *outside);
        const double room = 0.01 * (high - low);
        if (!(next > low && next < high) || round % 4 == 3) next = 0.5 * (low + high);
        next = std::clamp(next, low + room, high - room);
        if (high - low < 1e-9) return *outside;
      } else {
        if (std::abs(s) >= farthest) return {};
        next = std::clamp(next, -farthest, farthest);
        if (next == s) return {};
      }
      last = s, value = f, s = next;
    }
    return {};
  }

  /// Whether the tool is no nearer to fixtures than before, or far enough.
  bool keeps_off(const Pose& before, const Pose& after) const {
    if (!fixtures_) return true;
    const double now = fixtures_->clearance(assembly_, after);
    return now >= rule_.clearance || now >= fixtures_->clearance(assembly_, before) - kTouches;
  }

  /// The place raised along the axis until the tool is free, if it is not.
  Place raised(Place out) const {
    if (out.before >= -kTouches) {
      out.result = Result::Kept;
      return out;
    }
    LiftRule how;
    how.clearance = rule_.clearance, how.tolerance = 2 * kTouches;
    how.max_lift = 10 * (contact() - out.before);
    const Lift found = lift(exact_, assembly_, out.pose, how);
    out.result = found.free ? Result::Raised : Result::Kept;
    if (found.free)
      out.pose = moved(out.pose, out.pose.axis, found.height), out.after = found.clearance - how.clearance;
    return out;
  }

  const collide::Assembly assembly_;
  const collide::Collider& exact_;
  const collide::Collider* fixtures_;
  const SurfaceFitRule rule_;
};

void count(const Place& place, SurfaceFit& fit) {
  switch (place.result) {
    case Result::Fitted:
      ++fit.fitted;
      fit.before = std::max(fit.before, std::abs(place.before));
      fit.after = std::max(fit.after, std::abs(place.after));
      break;
    case Result::Raised:
      ++fit.raised;
      break;
    case Result::Kept:
      ++fit.kept;
      if (-place.after > fit.kept_depth) fit.kept_depth = -place.after, fit.kept_at = place.pose.tip;
      break;
    case Result::Away:
      break;
  }
}

}  // namespace

SurfaceFit fit_to_surface(Operation& moves, const Tool& tool, const collide::Collider& exact,
                          const std::vector<Mesh>& fixtures, const SurfaceFitRule& rule, const Progress& progress) {
  base::require_not_negative(rule.clearance, "clearance", base::kFiniteAndNotNegative);
  base::require_not_negative(rule.deviation, "deviation", base::kFiniteAndNotNegative);
  base::require_tolerance(rule.tolerance);
  std::optional<collide::Collider> obstacles;
  if (!fixtures.empty()) {
    collide::Collider::Settings settings;
    settings.spacing = kForceSpacing;
    obstacles.emplace(joined({}, fixtures), std::vector<Volume>(), settings);
  }
  const Fitter fitter(tool, exact, obstacles ? &*obstacles : nullptr, rule);
  const std::size_t n = moves.poses.size();
  const auto at_feed = [&](std::size_t k) { return moves.kinds[k] != MoveKind::Rapid; };
  const auto cuts = [&](std::size_t k) {
    const MoveKind kind = moves.kinds[k];
    return kind == MoveKind::Cut || kind == MoveKind::Link ||
           (kind == MoveKind::Lead && k + 1 < n && moves.kinds[k + 1] == MoveKind::Cut);
  };
  std::vector<Place> places(n);
  base::parallel_for(
      n, 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          places[k] = at_feed(k) ? fitter.place(moves.poses[k], cuts(k)) : Place{moves.poses[k]};
      },
      base::part(progress, 0, 0.5));
  std::vector<std::vector<Place>> between(n);
  std::vector<double> worst(n);
  base::parallel_for(
      n, 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = std::max<std::size_t>(begin, 1); k < end; ++k)
          if (at_feed(k))
            fitter.divide(places[k - 1].pose, places[k].pose, moves.kinds[k] != MoveKind::Lead, kMaxHalvings,
                          between[k], worst[k]);
      },
      base::part(progress, 0.5, 1));
  SurfaceFit fit;
  Operation out;
  out.blocked = std::move(moves.blocked), out.reason = std::move(moves.reason);
  const auto write = [&](const Place& place, std::size_t k) {
    count(place, fit);
    out.poses.push_back(place.pose), out.kinds.push_back(moves.kinds[k]), out.feeds.push_back(moves.feeds[k]);
  };
  for (std::size_t k = 0; k < n; ++k) {
    for (const Place& place : between[k]) write(place, k);
    fit.inserted += between[k].size();
    fit.after = std::max(fit.after, worst[k]);
    write(places[k], k);
  }
  if (fit.kept_depth > rule.tolerance)
    out.blocked.push_back({"the exact surface: no free place near that of the triangles", fit.kept_at, 0});
  moves = std::move(out);
  return fit;
}

}  // namespace riffler::plan
