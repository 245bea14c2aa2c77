#include "plan/finish/surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "plan/operation_moves.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr double kRows = 0.9;  // share of the tolerance for rows; the rest is for rounding, also in the program's text
constexpr double kRolling = 0.5;        // rad between a face's normal and the tool's where the tool rolls over its edge
constexpr double kSlopeSlack = 1e-6;    // rad
constexpr double kCrease = 0.2;         // rad between faces
constexpr double kLevelContact = 1e-7;  // mm
constexpr std::size_t kMaxPoints = 20'000'000;
constexpr const char* kBlocked[] = {"", "the shank meets the part", "the holder meets the part"};

double ball_at_tip(const Tool& tool) {
  const auto* round = std::get_if<tool::Round>(&tool.cutter().front());
  return round && round->e == 0 && round->z0 <= 0 ? round->r : 0;
}

}  // namespace

FinishSurface::FinishSurface(const Mesh& part, const std::vector<Mesh>& fixtures, const Tool& tool,
                             const FinishOptions& options, const std::vector<std::vector<Vec2>>& region)
    : mesh_(joined(part, fixtures)),
      part_triangles_(part.triangles.size()),
      drop_(mesh_, tool, {0, 0, 1}, options.allowance),
      options_(options),
      region_(region),
      tolerance_(kRows * options.tolerance),
      low_(mesh::bounds(mesh_).lower.z - 1) {
  if (const double r = ball_at_tip(tool); r > 0) ball_ = r + options.allowance;
  if (const auto* round = std::get_if<tool::Round>(&tool.cutter().front()); round && round->e >= 0) round_ = *round;
  const auto* end = std::get_if<tool::Frustum>(&tool.cutter().front());
  level_end_ = end ? end->r0 : round_ ? round_->e : 0;
  if (tool.kind() == "taper")
    for (const auto& [name, value] : tool.parameters())
      if (name == "half_angle") flank_ = value;
  if (!options.faces.empty()) chosen_.assign(part_triangles_, 0);
  for (const int face : options.faces) {
    if (face < 0 || static_cast<std::size_t>(face) >= part_triangles_)
      throw std::invalid_argument("region: triangle " + std::to_string(face) + " is none of the part's " +
                                  std::to_string(part_triangles_));
    chosen_[static_cast<std::size_t>(face)] = 1;
  }
  for (const tool::ToolPiece& p : tool.assembly()) low_ -= std::max(0.0, tool::top(p.piece));
  normals_.reserve(part_triangles_);
  for (const Vec3i& t : part.triangles) {
    const Vec3 n = glm::cross(part.vertices[t.y] - part.vertices[t.x], part.vertices[t.z] - part.vertices[t.x]);
    const double size = glm::length(n);
    normals_.push_back(size > 0 ? (n.z < 0 ? -n : n) / size : Vec3(0, 0, 1));
  }
}

SurfacePoint FinishSurface::at(const Vec2& p) const {
  drops_.fetch_add(1, std::memory_order_relaxed);
  SurfacePoint out{Vec3(p, low_), drop_(Vec3(p, 0))};
  if (out.landing.touches) out.tip.z = out.landing.height;
  return out;
}

/// The share at which to divide a piece of a row; none if the piece is within the tolerance. Points that it needs
/// between its ends are then added to `out`.
std::optional<double> FinishSurface::split(const SurfacePoint& a, const SurfacePoint& b,
                                           std::vector<SurfacePoint>& out) const {
  const double length = geom::hypot(b.tip.x - a.tip.x, b.tip.y - a.tip.y);
  const bool fine = length <= 0.5 * tolerance_;
  const auto inside = [](double s) { return std::clamp(s, 0.02, 0.98); };
  if (!a.landing.touches || !b.landing.touches) {
    if (fine) return {};
    if (a.landing.touches || b.landing.touches) return 0.5;
    const DropCutter::Rise found = drop_.rise(a.tip, b.tip, 0);
    if (!(found.above > 0)) return {};
    return inside(found.at);
  }
  const DropCutter::Rise over = drop_.rise(a.tip, b.tip, tolerance_);
  if (over.above > tolerance_) {
    if (!fine) return inside(over.at);
    const double top = std::max(a.tip.z, b.tip.z);
    const Vec3 from(a.tip.x, a.tip.y, top), to(b.tip.x, b.tip.y, top);
    const double z = top + drop_.rise(from, to, 0).above;
    out.push_back({Vec3(a.tip.x, a.tip.y, z), a.landing}), out.push_back({Vec3(b.tip.x, b.tip.y, z), b.landing});
    return {};
  }
  if (fine) return {};
  // Below the move: the surface is nowhere lower than the concave surface of each end's triangle alone.
  const double at_b = b.tip.z - drop_.height_on(a.landing, b.tip), at_a = a.tip.z - drop_.height_on(b.landing, a.tip);
  const bool far_b = !std::isfinite(at_b), far_a = !std::isfinite(at_a);
  if (far_a && far_b) return 0.5;
  const double depth = far_a ? at_b : far_b ? at_a : at_a + at_b > 0 ? at_a * at_b / (at_a + at_b) : 0;
  if (depth <= tolerance_) return {};
  return far_a || far_b ? 0.5 : inside(at_a / (at_a + at_b));
}

std::vector<SurfacePoint> FinishSurface::follow(const Vec2& from, const Vec2& to) const {
  std::vector<SurfacePoint> out{at(from)};
  if (from == to) return out;
  std::vector<SurfacePoint> ahead{at(to)};
  SurfacePoint here = out.front();
  while (!ahead.empty()) {
    if (const auto share = split(here, ahead.back(), out)) {
      if (ahead.size() + out.size() > kMaxPoints)
        throw std::invalid_argument("tolerance: a row of more than twenty million points; take a larger one");
      if (out.size() % 256 == 0) base::still_wanted();
      ahead.push_back(at(glm::mix(Vec2(here.tip), Vec2(ahead.back().tip), *share)));
      continue;
    }
    SurfacePoint next = ahead.back();
    ahead.pop_back();
    next.gap = !here.landing.touches || !next.landing.touches;
    out.push_back(next);
    here = next;
  }
  return out;
}

std::vector<SurfacePoint> FinishSurface::follow(const std::vector<Vec2>& line) const {
  std::vector<SurfacePoint> out;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const std::vector<SurfacePoint> more = follow(line[k - 1], line[k]);
    out.insert(out.end(), more.begin() + (out.empty() ? 0 : 1), more.end());
  }
  return out;
}

std::vector<SurfacePoint> FinishSurface::sampled(const std::vector<SurfacePoint>& points, double step) const {
  if ((region_.empty() && chosen_.empty()) || points.empty()) return points;
  std::vector<SurfacePoint> out{points.front()};
  for (std::size_t k = 1; k < points.size(); ++k) {
    const Vec2 from(points[k - 1].tip), to(points[k].tip);
    const int pieces =
        points[k].gap ? 1 : static_cast<int>(std::ceil(geom::hypot(to.x - from.x, to.y - from.y) / step));
    for (int i = 1; i < pieces; ++i) {
      if (i % 256 == 0) base::still_wanted();
      out.push_back(at(glm::mix(from, to, static_cast<double>(i) / pieces)));
      out.back().sample = true;
    }
    out.push_back(points[k]);
  }
  return out;
}

bool FinishSurface::meant_slope(double slope) const {
  return slope >= options_.min_slope - kSlopeSlack && slope <= options_.max_slope + kSlopeSlack;
}

const char* FinishSurface::blocked(const SurfacePoint& p) const {
  if (!p.landing.touches) return nullptr;
  if (static_cast<std::size_t>(p.landing.triangle) >= part_triangles_) return "the tool meets a fixture";
  const auto part = static_cast<std::size_t>(p.landing.part);
  return part ? kBlocked[part] : nullptr;
}

bool FinishSurface::wanted(const SurfacePoint& p) const {
  if (!p.landing.touches || blocked(p)) return false;
  return wanted_face(p.landing.triangle, p.landing.point, rested_slope(p));
}

double FinishSurface::rested_slope(const SurfacePoint& p) const {
  const Vec3 off = p.landing.point - p.tip;  // at the rim the cutter may rest on any slope
  const bool level = geom::hypot(off.x, off.y) < level_end_ - kLevelContact &&
                     std::abs(p.tip.z - options_.allowance - p.landing.point.z) <= kLevelContact;
  return level ? 0.0 : face_slope(p.landing.triangle);
}

bool FinishSurface::wanted_face(int triangle, const Vec3& point, double slope) const {
  return (chosen_.empty() || chosen_[static_cast<std::size_t>(triangle)]) && meant_slope(slope) &&
         (region_.empty() || region_.holds(Vec2(point)));
}

bool FinishSurface::creased(const SurfacePoint& a, const SurfacePoint& b) const {
  if (!a.landing.touches || !b.landing.touches || blocked(a) || blocked(b)) return false;
  return glm::dot(normals_[static_cast<std::size_t>(a.landing.triangle)],
                  normals_[static_cast<std::size_t>(b.landing.triangle)]) < base::cos(kCrease);
}

double FinishSurface::face_slope(int triangle) const {
  const Vec3& n = normals_[static_cast<std::size_t>(triangle)];
  return base::atan2(geom::hypot(n.x, n.y), n.z);
}

double FinishSurface::touched_slope(const SurfacePoint& p) const {
  if (!round_) return rested_slope(p);
  const Vec3 off = p.landing.point - p.tip;
  return base::atan2(std::max(0.0, geom::hypot(off.x, off.y) - round_->e), std::max(0.0, round_->zc - off.z));
}

double FinishSurface::steepest_meant() const {
  double most = -1;
  for (std::size_t k = 0; k < part_triangles_; ++k) {
    if (!chosen_.empty() && !chosen_[k]) continue;
    const double slope = face_slope(static_cast<int>(k));
    if (meant_slope(slope)) most = std::max(most, slope);
  }
  return most;
}

double FinishSurface::above(const Vec3& from, const Vec3& to) const {
  const double found = drop_.rise(from, to, tolerance_).above;
  return found > tolerance_ ? found : 0;
}

/// Whether a ball, or the flank of a taper, rests on an edge: its normal there is far from the face's normal.
bool FinishSurface::rolls(const SurfacePoint& p) const {
  if (!p.landing.touches || blocked(p)) return false;
  const auto on_edge = [&](const Vec3& normal) {
    return glm::dot(normal, normals_[static_cast<std::size_t>(p.landing.triangle)]) < base::cos(kRolling);
  };
  const Vec2 off = Vec2(p.tip) - Vec2(p.landing.point);
  const double across = geom::hypot(off.x, off.y);
  const auto flank_on_edge = [&] {
    return flank_ && across > level_end_ && on_edge(Vec3(base::cos(*flank_) / across * off, base::sin(*flank_)));
  };
  if (!(ball_ > 0)) return flank_on_edge();
  const Vec3 towards = p.tip + Vec3(0, 0, ball_ - options_.allowance) - p.landing.point;
  const double size = glm::length(towards);
  if (size > ball_ * (1 + 1e-6) + 2 * tolerance_) return flank_on_edge();  // the contact is above the ball
  return size > 0 && on_edge(towards / size);
}

/// The row's end between a selected point `in` and another point `out`, within the tolerance. At a riser the line
/// between both is far from the surface, so the end gets the surface's own height there, if the move to it is free.
Vec3 FinishSurface::border(const SurfacePoint& in, const SurfacePoint& out) const {
  double low = 0, high = 1;
  const double length = glm::length(out.tip - in.tip);
  while ((high - low) * length > tolerance_) {
    const double middle = 0.5 * (low + high);
    (wanted(at(Vec2(glm::mix(in.tip, out.tip, middle)))) ? low : high) = middle;
  }
  if (low == 0) return in.tip;
  const Vec3 end = glm::mix(in.tip, out.tip, low), tip = at(Vec2(end)).tip;
  if (std::abs(tip.z - end.z) <= tolerance_) return end;
  return above(in.tip, tip) > 0 ? in.tip : tip;
}

std::vector<std::vector<Vec3>> FinishSurface::meant_pieces(const std::vector<SurfacePoint>& points,
                                                           std::vector<BlockedPlace>& blocked_places) const {
  const std::size_t n = points.size();
  std::vector<char> keep(n), rolling(n);
  for (std::size_t k = 0; k < n; ++k) keep[k] = wanted(points[k]), rolling[k] = rolls(points[k]);
  // Keep a run that rolls over an edge only if it is between selected faces.
  for (std::size_t k = 0; k < n;) {
    if (!rolling[k]) {
      ++k;
      continue;
    }
    std::size_t end = k;
    while (end < n && rolling[end] && (end == k || !points[end].gap)) ++end;
    const bool before = k > 0 && !points[k].gap && keep[k - 1] && !rolling[k - 1];
    const bool after = end < n && !points[end].gap && keep[end] && !rolling[end];
    for (std::size_t i = k; i < end; ++i) keep[i] = before && after;
    k = end;
  }
  std::vector<std::vector<Vec3>> out;
  std::vector<Vec3> piece;
  const auto finish_piece = [&] {
    if (piece.size() > 1) out.push_back(piece);
    piece.clear();
  };
  for (std::size_t k = 0; k < n; ++k) {
    const bool leads = k > 0 && !points[k].gap;
    if (!leads) finish_piece();
    if (leads && keep[k] && !keep[k - 1]) piece = {border(points[k], points[k - 1])};
    if (leads && !keep[k] && keep[k - 1]) piece.push_back(border(points[k - 1], points[k])), finish_piece();
    if (keep[k] && !points[k].sample && (piece.empty() || piece.back() != points[k].tip))
      piece.push_back(points[k].tip);
    if (const char* reason = leads ? blocked(points[k]) : nullptr) {
      const auto same = std::find_if(blocked_places.begin(), blocked_places.end(),
                                     [&](const BlockedPlace& b) { return b.reason == reason; });
      const double length = glm::length(points[k].tip - points[k - 1].tip);
      if (same == blocked_places.end())
        blocked_places.push_back({reason, points[k].tip, length});
      else
        same->length += length;
    }
  }
  finish_piece();
  return out;
}

}  // namespace riffler::plan
