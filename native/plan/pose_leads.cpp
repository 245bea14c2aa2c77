#include "plan/pose_leads.hpp"

#include <algorithm>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "plan/operation_moves.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::plan {

namespace {

constexpr double kPin = 0.01;      // mm, smallest radius of the lower end of a shank
constexpr double kFlattest = 0.2;  // smallest sine of a lead's slope
constexpr double kLean = kPi / 6;  // rad between the axis and leads on its sides
constexpr int kSides = 8;
constexpr double kNear = 0.05;  // mm within which a height above the stock is found
constexpr int kSteps = 200;
constexpr std::size_t kEvaluations = 50'000;

/// Directions of leads in order of preference.
std::vector<Vec3> directions(const Vec3& axis, const Vec3& up) {
  std::vector<Vec3> out{axis};
  if (glm::dot(axis, up) < 1 - 1e-12) out.push_back(glm::normalize(axis + up)), out.push_back(up);
  const CcFrame frame = cc_frame(up, axis);
  for (int k = 0; k < kSides; ++k) {
    const double turn = geom::kTwoPi * k / kSides;
    out.push_back(base::cos(kLean) * axis + base::sin(kLean) * (base::cos(turn) * frame.x + base::sin(turn) * frame.y));
  }
  return out;
}

/// Whether no piece is narrower than those below it: of the whole tool, or of shank and holder.
bool widens(const Tool& tool, bool whole) {
  double widest = 0;
  bool out = true;
  const auto piece = [&](double r0, double r1) {
    out = out && r0 >= widest - 1e-9 && r1 >= r0 - 1e-9;
    widest = std::max({widest, r0, r1});
  };
  double from = 0;
  if (whole)
    for (const tool::ProfileSegment& s : tool.profile().segments()) piece(from, s.to.x), from = s.to.x;
  std::vector<tool::Frustum> above = tool.shank();
  above.insert(above.end(), tool.holder().begin(), tool.holder().end());
  std::sort(above.begin(), above.end(), [](const auto& a, const auto& b) { return a.z0 < b.z0; });
  for (const tool::Frustum& f : above) piece(f.r0, f.r1);
  return out;
}

}  // namespace

std::optional<std::pair<Tool, double>> body_of(const Tool& tool) {
  std::vector<tool::Frustum> shank = tool.shank(), holder = tool.holder();
  const tool::Frustum* lowest = nullptr;
  for (const std::vector<tool::Frustum>* pieces : {&shank, &holder})
    for (const tool::Frustum& piece : *pieces)
      if (!lowest || piece.z0 < lowest->z0) lowest = &piece;
  if (!lowest) return {};
  const tool::Frustum first = *lowest;
  for (std::vector<tool::Frustum>* pieces : {&shank, &holder})
    for (tool::Frustum& piece : *pieces) piece.z0 -= first.z0, piece.z1 -= first.z0;
  const Tool end = cutters::flat(2 * std::max(kPin, std::min(first.r0, first.r1)), first.z1 - first.z0);
  return std::pair(end.with_shank(shank).with_holder(holder), first.z0);
}

double depth_below_tip(const Tool& tool, double tilt) {
  double depth = 0;
  const auto ring = [&](double radius, double height) {
    depth = std::max(depth, radius * base::sin(tilt) - height * base::cos(tilt));
  };
  Vec2 from{0, 0};
  for (const tool::ProfileSegment& s : tool.profile().segments())  // boxes around the segments
    ring(std::max(from.x, s.to.x), std::min(from.y, s.to.y)), from = s.to;
  for (const auto& pieces : {tool.shank(), tool.holder()})
    for (const tool::Frustum& f : pieces) ring(std::max(f.r0, f.r1), std::min(f.z0, f.z1));
  return depth;
}

PoseLeads::PoseLeads(const LeadScene& scene, const Tool& tool)
    : scene_(scene), tool_(tool), widens_(widens(tool, true)), body_widens_(widens(tool, false)) {
  if (!scene.stock || !scene.check_stock) return;
  if (const auto body = body_of(tool)) body_.emplace(body->first), body_height_ = body->second;
}

std::optional<Lead> PoseLeads::find(const Pose& pose, double level, bool in) const {
  for (const Vec3& direction : directions(pose.axis, scene_.up))
    if (const std::optional<Lead> found = along(pose, direction, level, in)) return found;
  return {};
}

std::optional<Lead> PoseLeads::along(const Pose& pose, const Vec3& direction, double level, bool in) const {
  const double slope = glm::dot(direction, scene_.up), rise = level - glm::dot(pose.tip, scene_.up);
  if (slope < kFlattest || !(rise > 0)) return {};
  const double length = rise / slope;
  const Pose top{pose.tip + length * direction, pose.axis};
  const auto clear = [&](const collide::Collider& of, const collide::Assembly& what, double raised, double wanted) {
    const Vec3 by = raised * pose.axis;
    const Motion motion({pose.tip + by, pose.axis}, {top.tip + by, pose.axis});
    return of.sweep(what, motion, wanted, kEvaluations).answer == collide::Swept::Answer::Clear;
  };
  if (!clear(scene_.part, tool_, 0, scene_.distance - scene_.tolerance)) return {};
  if (scene_.fixtures && !clear(*scene_.fixtures, tool_, 0, scene_.fixture_distance - scene_.tolerance)) return {};
  const bool own = direction == pose.axis;
  if (!scene_.stock || (!in && own && widens_)) return Lead{top.tip, pose.tip};
  if (body_ && !(!in && own && body_widens_) && !clear(*scene_.stock, *body_, body_height_, 0)) return {};
  return Lead{top.tip, pose.tip + free_of_stock(pose, direction, length) * direction};
}

/// How far (mm) along the lead from a pose, at most `length`, the tool is that comes down along it, `kAbove` or a
/// little more from the stock all along.
double PoseLeads::free_of_stock(const Pose& pose, const Vec3& direction, double length) const {
  double at = length;
  for (int k = 0; k < kSteps && at > 0; ++k) {
    const double room =
        scene_.stock->nearest(tool_, {pose.tip + at * direction, pose.axis}).distance - kAbove;  // falls by 1 mm a mm
    if (!(room > kNear)) break;
    at -= std::min(room, at);
  }
  return at;
}

}  // namespace riffler::plan
