#include "nc/links.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::nc {

namespace {

/// After this many evaluations, a move counts as not clear.
constexpr std::size_t kMaxEvaluations = 200'000;
constexpr const char* kRemedy =
    "tilt the tool differently there (another key), let it stick out further, take a slimmer holder or move the "
    "fixture";

std::string at_place(const Vec3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.3f %.3f %.3f]", p.x + 0.0, p.y + 0.0, p.z + 0.0);
  return text;
}

Pose moved(const Pose& pose, const Vec3& by) {
  return {pose.tip + by, pose.axis};
}

}  // namespace

void validate(const LinkRule& rule) {
  const auto positive = [](const std::optional<double>& x, const char* name) {
    if (x && !(std::isfinite(*x) && *x > 0))
      throw std::invalid_argument(std::string(name) + " must be positive and finite");
  };
  positive(rule.tolerance, "contact_tolerance");
  positive(rule.retract, "retract");
  positive(rule.lead_in, "lead_in");
  if (rule.direction && !(std::abs(glm::length(*rule.direction) - 1) < 1e-6))
    throw std::invalid_argument("direction must be a unit vector");
}

std::string meeting(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose) {
  constexpr const char* kNames[] = {"cutter", "shank", "holder"};
  const collide::Collider::Nearest found = collider.nearest(assembly, pose);
  const double height = std::max(0.0, glm::dot(found.point - pose.tip, pose.axis));
  const auto part = found.touch == collide::Touch::Fixture ? static_cast<std::size_t>(assembly.part_at(height))
                                                           : static_cast<std::size_t>(found.touch);
  char deep[48];
  std::snprintf(deep, sizeof deep, ", %.3g mm deep, at ", std::max(0.0, -found.distance));
  return std::string("the ") + kNames[part] + " meets " +
         (found.touch == collide::Touch::Fixture ? "a fixture" : "the part") + deep + at_place(found.point) +
         " (tip at " + at_place(pose.tip) + ")";
}

Pose deepest_pose(const collide::Collider& collider, const collide::Assembly& assembly, const Motion& motion) {
  constexpr int kSamples = 24;
  Pose worst = motion.from();
  double least = collider.nearest(assembly, worst).distance;
  for (int k = 1; k <= kSamples; ++k) {
    const Pose pose = motion.at(static_cast<double>(k) / kSamples);
    if (const double d = collider.nearest(assembly, pose).distance; d < least) least = d, worst = pose;
  }
  return worst;
}

LinkFinder::LinkFinder(const Tool& tool, const ClearanceZone& space, const LinkRule& rule)
    : space_(space),
      rule_(rule),
      assembly_(tool),
      reach_(&tool),
      around_(rule.collider->bounds().grown(rule.tolerance)) {}

bool LinkFinder::clear(const Pose& from, const Pose& to) const {
  if (!reach_.swept_box(from, to).overlaps(around_)) return true;
  const collide::Swept found = rule_.collider->sweep(assembly_, Motion(from, to), -rule_.tolerance, kMaxEvaluations);
  return found.answer == collide::Swept::Answer::Clear;
}

Pose LinkFinder::above(const Pose& pose) const {
  return {{pose.tip.x, pose.tip.y, std::max(space_.top, pose.tip.z)}, pose.axis};
}

Link LinkFinder::find(const Pose& pose) const {
  if (!rule_.collider->keeps(assembly_, pose, -rule_.tolerance))
    throw std::invalid_argument(
        "the cut itself stands where " + meeting(*rule_.collider, assembly_, pose) +
        ": find its cutter locations with this collider (plan.cutter_locations), or let the tool stick "
        "out further");
  const std::vector<Pose> direct = retract_path(pose, reach_, space_);
  if (!rule_.retract && !rule_.direction) {
    bool free = true;
    const Pose* from = &pose;
    for (const Pose& to : direct) free = free && clear(*from, to), from = &to;
    if (free) return {direct, true};
  }
  const Vec3 up(0, 0, 1), &o = pose.axis;
  std::vector<Vec3> directions{rule_.direction ? *rule_.direction : o};
  if (!rule_.direction) {
    directions.push_back(up);
    if (o.z > -0.9) directions.push_back(glm::normalize(o + up));
  }
  for (const Vec3& direction : directions)
    if (auto link = from_stretch(pose, direction)) return *std::move(link);
  std::vector<Pose> way = direct;
  if (rule_.direction || rule_.retract) {
    const double d = rule_.retract.value_or(reach_.radius);
    const Pose end = moved(pose, d * directions.front());
    way = {end, above(end)};
  }
  way.insert(way.begin(), pose);
  throw std::invalid_argument(met(way) + ", and the same on every other path out: " + kRemedy);
}

/// A move along `direction`, then straight up, or sideways and then up.
std::optional<Link> LinkFinder::from_stretch(const Pose& pose, const Vec3& direction) const {
  const double r = 0.5 * assembly_.tool().diameter();
  std::vector<double> lengths{0.25 * r, r, 2 * r, 4 * r, 8 * r, 16 * r};
  if (rule_.retract) lengths = {*rule_.retract};
  std::vector<Pose> reached;
  for (const double length : lengths) {
    const Pose end = moved(pose, length * direction);
    if (!clear(reached.empty() ? pose : reached.back(), end)) break;
    reached.push_back(end);
    if (clear(end, above(end))) return Link{{end, above(end)}, false};
    if (end.tip.z > space_.top) break;
  }
  constexpr int kAround = 12;
  for (const double aside : {1.0, 2.0, 4.0})
    for (const Pose& from : reached)
      for (const double rise : {1.0, 0.0})
        for (int k = 0; k < kAround; ++k) {
          const double a = 2 * kPi * k / kAround;
          const Vec3 way = glm::normalize(Vec3(base::cos(a), base::sin(a), rise));
          const Pose end = moved(from, aside * reach_.radius * way);
          if (clear(from, end) && clear(end, above(end))) return Link{{from, end, above(end)}, false};
        }
  return {};
}

/// Describes the collision at the worst place of a path.
std::string LinkFinder::met(const std::vector<Pose>& way) const {
  Pose worst = way.front();
  double least = 0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    if (clear(way[k - 1], way[k])) continue;
    const Pose pose = deepest_pose(*rule_.collider, assembly_, Motion(way[k - 1], way[k]));
    if (const double d = rule_.collider->nearest(assembly_, pose).distance; d < least) least = d, worst = pose;
  }
  return meeting(*rule_.collider, assembly_, worst);
}

}  // namespace riffler::nc
