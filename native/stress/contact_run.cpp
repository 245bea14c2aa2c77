#include "stress/contact_run.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>

#include "reference/surface_distance.hpp"
#include "riffler/collide/collider.hpp"

namespace riffler::stress {

namespace {

constexpr std::size_t kPosesKept = 100;
constexpr std::uint64_t kContactStream = 0x636F6E74;
constexpr double kBracket = 1e-3;  // mm, of the reference
constexpr double kLeftOut = 1e-3;  // mm, without a budget: see Contact::missed_depth_bound
constexpr double kPoints = 4000;   // of the force: the default number takes far longer to prepare than to use

NamedPart part_of(Random& random, const ContactOptions& options, std::uint64_t number) {
  if (!options.parts.empty()) return options.parts[number % options.parts.size()];
  const auto scene = static_cast<ContactScene>(number % static_cast<std::uint64_t>(ContactScene::kCount));
  return {name(scene), draw_part(random, scene)};
}

/// Fixtures near the origin in one of eight sessions; none for the part that is far away, which no tool would reach.
std::vector<Volume> fixtures_of(Random& random, const NamedPart& part) {
  if (part.name == name(ContactScene::FarAway) || !random.one_in(8)) return {};
  const Vec3 low{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-8, 0)};
  return {Volume::block({{low, low + Vec3(10, 8, 6)}, 1.0, "z"})};
}

double spacing_of(const Mesh& part) {
  double area = 0;
  for (const Vec3i& t : part.triangles) {
    const Vec3 &a = part.vertices[t.x], &b = part.vertices[t.y], &c = part.vertices[t.z];
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return std::sqrt(area / kPoints);
}

/// Part, tool and reference of one session.
struct ContactSession {
  Random random;
  NamedPart part;
  Tool tool;
  collide::Collider collider;
  collide::Assembly assembly;
  reference::AssemblyDistance reference;
  std::vector<reference::Corners> corners;

  ContactSession(const ContactOptions& options, std::uint64_t number)
      : random(options.seed, kContactStream, number),
        part(part_of(random, options, number)),
        tool(draw_tool(random)),
        collider(part.mesh, fixtures_of(random, part), {.spacing = spacing_of(part.mesh)}),
        assembly(tool),
        reference(tool) {
    for (const Vec3i& t : part.mesh.triangles)
      corners.push_back({part.mesh.vertices[t.x], part.mesh.vertices[t.y], part.mesh.vertices[t.z]});
  }
};

/// Checks the results at one pose. An empty text means no fault.
class PoseCheck {
 public:
  PoseCheck(ContactSession& session, const Pose& pose, ContactTally& tally) : s_(session), pose_(pose), tally_(tally) {
    const Vec3 tip = glm::abs(pose.tip);
    // Rounding of coordinates, through a handful of operations.
    rounding_ = 1e-9 + 1e-14 * std::max({tip.x, tip.y, tip.z, 1e3});
  }

  std::string operator()(bool judged) {
    const collide::Contact whole = s_.collider.query(s_.assembly, pose_);
    const collide::Collider::Nearest nearest = s_.collider.nearest(s_.assembly, pose_);
    const double clearance = s_.collider.clearance(s_.assembly, pose_);
    tally_.touching += whole.depth > 0;
    check_shape(whole, "query");
    if (!std::isfinite(clearance) || !std::isfinite(nearest.distance) || !geom::finite(nearest.point))
      say() << "distance " << clearance << ", nearest " << nearest.distance;
    if (nearest.distance > clearance + rounding_)
      say() << "nearest " << nearest.distance << " is farther than the distance of the part alone, " << clearance;
    if (nearest.touch != collide::Touch::Fixture &&
        std::abs(s_.reference(nearest.point, pose_) - nearest.distance) > rounding_)
      say() << "nearest " << nearest.distance << " is not that of its point, " << s_.reference(nearest.point, pose_);
    if (std::abs(whole.depth - std::max(0.0, -nearest.distance)) > rounding_)
      say() << "depth " << whole.depth << " at distance " << nearest.distance;
    left_out_ = rounding_ + whole.missed_depth_bound;
    if (whole.missed_depth_bound > rounding_ + kLeftOut || whole.checked != 1)
      say() << "without a budget " << whole.missed_depth_bound << " left out, checked " << whole.checked;
    check_budget(whole.depth);
    if (judged) judge(clearance);
    return text_.str();
  }

 private:
  std::ostringstream& say() {
    if (text_.tellp() > 0) text_ << "; ";
    return text_;
  }

  void check_shape(const collide::Contact& c, const char* which) {
    if (!geom::finite(c.force) || !geom::finite(c.torque) || !std::isfinite(c.depth) || c.depth < 0)
      say() << which << ": not finite";
    if (c.points.size() != c.touches.size() || c.points.empty() != (c.depth == 0))
      say() << which << ": " << c.points.size() << " points, " << c.touches.size() << " touches, depth " << c.depth;
    if (c.depth == 0 && (c.force != Vec3(0) || c.torque != Vec3(0))) say() << which << ": force without depth";
    if (!(c.checked >= 0 && c.checked <= 1)) say() << which << ": checked " << c.checked;
    if (!(c.missed_depth_bound >= 0)) say() << which << ": bound " << c.missed_depth_bound;
  }

  void check_budget(double depth) {
    const double budget = s_.random.one_in(8) ? 0 : s_.random.power_of_ten(-7, -4);
    const collide::Contact some = s_.collider.query(s_.assembly, pose_, budget);
    check_shape(some, "budget");
    const double missed = depth - some.depth;
    tally_.cut_short += some.missed_depth_bound > 0;
    tally_.missed = std::max(tally_.missed, missed);
    if (missed > rounding_ && some.missed_depth_bound > 0)
      tally_.share = std::max(tally_.share, missed / some.missed_depth_bound);
    if (missed < -left_out_) say() << "budget: deeper by " << -missed;
    if (missed > some.missed_depth_bound + rounding_)
      say() << "budget of " << budget << " s: " << missed << " missed, bound " << some.missed_depth_bound;
  }

  void judge(double clearance) {
    ++tally_.judged;
    const reference::SurfaceBracket at = reference::least_distance(s_.corners, s_.reference, pose_, kBracket, 200'000);
    if (clearance > at.upper + left_out_ || clearance < at.lower - rounding_)
      say() << "clearance " << clearance << " is outside of " << at.lower << " … " << at.upper;
  }

  ContactSession& s_;
  const Pose& pose_;
  ContactTally& tally_;
  double rounding_, left_out_ = 0;
  std::ostringstream text_;
};

}  // namespace

ContactTally ContactResults::total() const {
  ContactTally sum;
  for (const auto& [scene, t] : scenes) {
    sum.poses += t.poses, sum.touching += t.touching, sum.judged += t.judged;
    sum.cut_short += t.cut_short, sum.failures += t.failures;
    sum.missed = std::max(sum.missed, t.missed), sum.share = std::max(sum.share, t.share);
  }
  return sum;
}

void run_contact_session(const ContactOptions& options, std::uint64_t number, ContactResults& out) {
  ContactSession session(options, number);
  ContactTally& tally = out.scenes[session.part.name];
  for (long k = 0; k < options.poses; ++k) {
    const Pose pose = draw_pose(session.random, session.part.mesh, session.tool);
    const long count = static_cast<long>(number) * options.poses + k;
    ++tally.poses;
    std::string problem;
    try {
      problem = PoseCheck(session, pose, tally)(count % options.reference_every == 0);
    } catch (const std::exception& e) {
      problem = std::string("an exception: ") + e.what();
    }
    if (problem.empty()) continue;
    ++tally.failures;
    if (out.failures.size() < kPosesKept) out.failures.push_back({options.seed, number, session.part.name, k, problem});
  }
}

ContactResults run_contacts(const ContactOptions& options, long poses,
                            const std::function<bool(const ContactResults&)>& progress) {
  ContactResults out;
  for (long n = 0; n * options.poses < poses; ++n) {
    run_contact_session(options, static_cast<std::uint64_t>(n), out);
    if (progress && !progress(out)) break;
  }
  return out;
}

std::string reproducer(const ContactFailure& failure) {
  return "riffler_contact_stress --seed " + std::to_string(failure.seed) + " --session " +
         std::to_string(failure.session);
}

}  // namespace riffler::stress
