#include "plan/cut_lines.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "plan/operation_moves.hpp"
#include "plan/pose_leads.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/axis_rule.hpp"
#include "riffler/plan/cutter_locations.hpp"

namespace riffler::plan {

namespace {

constexpr double kTurn = kPi / 18;    // rad, largest turn between two rapids
constexpr double kSlack = 1e-6;       // rad
constexpr std::size_t kEntries = 32;  // parts of a piece between which the tool may come down
constexpr double kAllOfIt = 1e-6;
constexpr double kShortest = 0.25;  // mm, up to which a move that meets a fixture is divided
constexpr std::size_t kEvaluations = 100'000;

void check(const CutAlongOptions& o) {
  base::require(std::isfinite(o.distance), "distance", "must be finite");
  base::require(std::isfinite(o.fixture_distance.value_or(0)), "fixture_distance", "must be finite");
  base::require_tolerance(o.tolerance);
  base::require_not_negative(o.max_lift, "max_lift", base::kFiniteAndNotNegative);
  base::require_positive(o.feed, "feed", base::kPositiveAndFinite);
  base::require_positive(o.plunge, "plunge", base::kPositiveAndFinite);
}

void check(const std::vector<CutLine>& lines, const Vec3& up) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const CutLine& line = lines[k];
    const std::string name = "line " + std::to_string(k);
    if (line.poses.size() < 2) throw std::invalid_argument(name + " has fewer than two poses");
    if (!line.kinds.empty() && line.kinds.size() != line.poses.size())
      throw std::invalid_argument(name + " has another number of kinds than of poses");
    for (std::size_t i = 0; i < line.poses.size(); ++i) {
      const std::string place = name + ", pose " + std::to_string(i);
      if (!geom::finite(line.poses[i].tip)) throw std::invalid_argument(place + " is not finite");
      unit_axis(line.poses[i].axis, place + ": the axis");
      if (geom::angle_between(line.poses[i].axis, up) > kMaxTilt + kSlack)
        throw std::invalid_argument(place +
                                    ": the tool leans by more than 80° from the set-up's axis; plan it along "
                                    "another orientation");
    }
  }
}

/// A part of a line that is free, with the leads to it and from it.
struct Piece {
  std::vector<Pose> poses;
  std::vector<MoveKind> kinds;
  Lead in, out;
};

/// The reason of a row without the figures of its own place, so that equal ones can be counted together.
std::string short_reason(const std::string& reason) {
  return reason.substr(0, reason.find(','));
}

void block(std::vector<BlockedPlace>& all, const std::string& reason, const Vec3& place, double length) {
  const auto same = std::find_if(all.begin(), all.end(), [&](const BlockedPlace& b) { return b.reason == reason; });
  if (same == all.end())
    all.push_back({reason, place, length});
  else
    same->length += length;
}

double length_of(const std::vector<Pose>& poses) {
  double out = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) out += glm::length(poses[k].tip - poses[k - 1].tip);
  return out;
}

/// Adds a run of rows without the links at its ends, if any cut is left.
void add_run(Piece&& run, std::vector<Piece>& out) {
  std::size_t first = 1, last = run.poses.size();
  while (first < last && run.kinds[first] != MoveKind::Cut) ++first;
  while (last > first && run.kinds[last - 1] != MoveKind::Cut) --last;
  if (first >= last) return;
  const auto at = [](auto& v, std::size_t k) { return v.begin() + static_cast<std::ptrdiff_t>(k); };
  Piece& piece = out.emplace_back();
  piece.poses.assign(at(run.poses, first - 1), at(run.poses, last));
  piece.kinds.assign(at(run.kinds, first - 1), at(run.kinds, last));
}

/// The runs of a line's rows between places that are not free. Adds these to `out.blocked`.
std::vector<Piece> pieces_of(const CutLine& line, const CutterLocations& found, CutAlongResult& out) {
  const auto kind_at = [&](std::size_t point) { return line.kinds.empty() ? MoveKind::Cut : line.kinds[point]; };
  for (const BlockedPoint& one : found.blocked) {
    const Pose& pose = line.poses[one.point];
    const double before = one.point > 0 ? glm::length(pose.tip - line.poses[one.point - 1].tip) : 0;
    const double after = one.point + 1 < line.poses.size() ? glm::length(line.poses[one.point + 1].tip - pose.tip) : 0;
    block(out.blocked, short_reason(one.reason), pose.tip, 0.5 * (before + after));
  }
  std::vector<char> ends(found.rows.size(), 0);  // whether the move from a row to the next is left out
  for (const UnsafeWay& one : found.unsafe) ends[one.row] = 1;
  std::vector<Piece> pieces;
  Piece run;
  std::size_t last = 0;  // point of the row before, or of the one before that if it was inserted
  for (std::size_t k = 0; k < found.rows.size(); ++k) {
    const LocationRow& row = found.rows[k];
    std::size_t next = k;
    while (next + 1 < found.rows.size() && found.rows[next].point < 0) ++next;
    const auto point = static_cast<std::size_t>(found.rows[next].point);  // to which the move leads
    const bool gap = k > 0 && point > last + 1;                           // a blocked point lies between
    if (k > 0 && (ends[k - 1] || gap)) {
      if (ends[k - 1] && !gap)
        for (const UnsafeWay& one : found.unsafe)
          if (one.row == k - 1)
            block(out.blocked, short_reason(one.reason), found.rows[k - 1].pose.tip,
                  glm::length(row.pose.tip - found.rows[k - 1].pose.tip));
      add_run(std::move(run), pieces);
      run = {};
    }
    run.poses.push_back(row.pose), run.kinds.push_back(kind_at(point));
    out.lifted += row.lift > 0 ? 1 : 0;
    if (row.point >= 0) last = static_cast<std::size_t>(row.point);
  }
  add_run(std::move(run), pieces);
  return pieces;
}

/// The parts of a piece that keep a distance of `wanted` from the fixtures. Adds the others to `blocked`.
std::vector<Piece> clear_of_fixtures(const Piece& piece, const collide::Assembly& tool,
                                     const collide::Collider& fixtures, double wanted,
                                     std::vector<BlockedPlace>& blocked) {
  std::vector<Piece> out;
  Piece run;
  const auto begin_at = [&](const Pose& pose) { run = {{pose}, {MoveKind::Cut}, {}, {}}; };
  begin_at(piece.poses.front());
  for (std::size_t k = 1; k < piece.poses.size(); ++k) {
    std::vector<Pose> ahead{piece.poses[k]};  // the next on top: halves of the move
    while (!ahead.empty()) {
      const Pose here = run.poses.back(), next = ahead.back();
      const Motion motion(here, next);
      // A tool entirely inside a fixture touches none of its surface.
      const bool clear = fixtures.sweep(tool, motion, wanted, kEvaluations).answer == collide::Swept::Answer::Clear &&
                         !fixtures.inside_part(here.tip + 0.5 * tool.tool().length() * here.axis);
      if (clear) {
        run.poses.push_back(next), run.kinds.push_back(piece.kinds[k]);
        ahead.pop_back();
      } else if (const double length = glm::length(next.tip - here.tip); length > kShortest) {
        ahead.push_back(motion.at(0.5));
      } else {
        block(blocked, "the tool meets a fixture", here.tip, length);
        add_run(std::move(run), out);
        begin_at(next);
        ahead.pop_back();
      }
    }
  }
  add_run(std::move(run), out);
  return out;
}

/// The same for all pieces.
std::vector<Piece> clear_of_fixtures(const std::vector<Piece>& pieces, const collide::Assembly& tool,
                                     const collide::Collider& fixtures, double wanted, const Progress& progress,
                                     CutAlongResult& out) {
  std::vector<std::vector<Piece>> found(pieces.size());
  std::vector<std::vector<BlockedPlace>> blocked(pieces.size());
  base::parallel_for(
      pieces.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          found[k] = clear_of_fixtures(pieces[k], tool, fixtures, wanted, blocked[k]);
      },
      progress);
  std::vector<Piece> kept;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (Piece& one : found[k]) kept.push_back(std::move(one));
    for (const BlockedPlace& one : blocked[k]) block(out.blocked, one.reason, one.place, one.length);
  }
  return kept;
}

double largest_tilt(const std::vector<Piece>& pieces, const Vec3& up) {
  double out = 0;
  for (const Piece& piece : pieces)
    for (const Pose* pose : {&piece.poses.front(), &piece.poses.back()})
      out = std::max(out, geom::angle_between(pose->axis, up));
  return out;
}

/// The poses `first` … `last` of a piece, in this order, which may be descending.
Piece part_of(const Piece& piece, std::size_t first, std::size_t last) {
  Piece out;
  const bool back = last < first;
  for (std::size_t k = first;; back ? --k : ++k) {
    out.poses.push_back(piece.poses[k]);
    out.kinds.push_back(k == first ? MoveKind::Cut : piece.kinds[back ? k + 1 : k]);
    if (k == last) break;
  }
  return out;
}

/// The places of a piece where the tool may come down, best first: its ends, then places between them.
std::vector<std::size_t> entries(std::size_t last) {
  std::vector<std::size_t> out{0, last};
  for (std::size_t parts = 2; parts <= kEntries; parts *= 2)
    for (std::size_t k = 1; k < parts; k += 2) out.push_back(k * last / parts);
  return out;
}

/// A piece with its leads. Where the tool cannot come down at its beginning, it begins at its end, or in between and is
/// cut in two. Empty if no lead is free.
std::vector<Piece> with_leads(const Piece& piece, const PoseLeads& leads, double level) {
  const std::size_t last = piece.poses.size() - 1;
  for (const std::size_t k : entries(last)) {
    const auto in = leads.find(piece.poses[k], level, true);
    if (!in) continue;
    std::vector<Piece> out;
    for (const std::size_t end : {last, std::size_t{0}}) {
      if (end == k) continue;
      const auto away = leads.find(piece.poses[end], level, false);
      if (!away) continue;
      add_run(part_of(piece, k, end), out);
      if (out.empty() || out.back().poses.empty()) continue;
      Piece& made = out.back();
      made.in = *in, made.out = *away;
      // Links at the ends are gone: then the leads are those of other poses.
      if (made.poses.front().tip != piece.poses[k].tip || made.poses.back().tip != piece.poses[end].tip) {
        const auto other_in = leads.find(made.poses.front(), level, true);
        const auto other_out = leads.find(made.poses.back(), level, false);
        if (other_in && other_out)
          made.in = *other_in, made.out = *other_out;
        else
          out.pop_back();
      }
    }
    if (!out.empty()) return out;
  }
  return {};
}

/// The pieces with their leads. What no lead reaches is left out and listed in `out.blocked`.
std::vector<Piece> with_leads(const std::vector<Piece>& pieces, const PoseLeads& leads, double level,
                              const Progress& progress, CutAlongResult& out) {
  std::vector<std::vector<Piece>> found(pieces.size());
  base::parallel_for(
      pieces.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) found[k] = with_leads(pieces[k], leads, level);
      },
      progress);
  std::vector<Piece> kept;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    double cut = 0;
    for (Piece& one : found[k]) cut += length_of(one.poses), kept.push_back(std::move(one));
    const double whole = length_of(pieces[k].poses);
    if (cut < (1 - kAllOfIt) * whole)
      block(out.blocked, "part, fixtures or stock obstruct every lead", pieces[k].poses.front().tip, whole - cut);
  }
  return kept;
}

/// Appends poses to an operation.
class PoseWriter {
 public:
  PoseWriter(Operation& out, const CutAlongOptions& options) : out_(out), options_(options) {}

  void to(const Pose& pose, MoveKind kind) {
    if (!out_.poses.empty() && out_.poses.back().tip == pose.tip && out_.poses.back().axis == pose.axis) return;
    const double feed = kind == MoveKind::Rapid ? 0 : kind == MoveKind::Lead ? options_.plunge : options_.feed;
    out_.poses.push_back(pose), out_.kinds.push_back(kind), out_.feeds.push_back(feed);
  }
  /// Rapids from the last pose to another at the same level, in turns of at most `kTurn`.
  void across(const Pose& pose) {
    const Motion motion(out_.poses.back(), pose);
    const int steps = std::max(1, static_cast<int>(std::ceil(motion.angle() / kTurn)));
    for (int k = 1; k < steps; ++k) to(motion.at(static_cast<double>(k) / steps), MoveKind::Rapid);
    to(pose, MoveKind::Rapid);
  }

 private:
  Operation& out_;
  const CutAlongOptions& options_;
};

void write(const std::vector<Piece>& pieces, const Vec3& up, PoseWriter& writer, CutAlongResult& out) {
  for (const Piece& piece : pieces) {
    const Pose &first = piece.poses.front(), &last = piece.poses.back();
    if (out.pieces++ == 0) writer.to({piece.in.top, up}, MoveKind::Rapid);
    writer.across({piece.in.top, first.axis});
    writer.to({piece.in.near, first.axis}, MoveKind::Rapid);
    writer.to(first, MoveKind::Lead);
    for (std::size_t k = 1; k < piece.poses.size(); ++k) writer.to(piece.poses[k], piece.kinds[k]);
    writer.to({piece.out.near, last.axis}, MoveKind::Lead);
    writer.to({piece.out.top, last.axis}, MoveKind::Rapid);
  }
  if (!pieces.empty()) writer.across({pieces.back().out.top, up});
  out.retracts = pieces.empty() ? 0 : pieces.size() - 1;
}

}  // namespace

CutAlongResult cut_lines(const SetupScene& scene, const Tool& tool, const std::vector<CutLine>& lines,
                         const CutAlongOptions& options, const collide::Collider& part, const Progress& progress) {
  check(options);
  const Vec3 up = unit_axis(scene.axis, "axis");
  check(lines, up);
  const double plane = turned(scene, 0).plane;
  CutAlongResult out;
  if (lines.empty()) return out;
  const collide::Assembly assembly(tool);
  const LocationRule rule{options.distance, options.tolerance, options.max_lift};
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double share = 0.7 / static_cast<double>(lines.size());
    const Progress here = base::part(progress, share * static_cast<double>(k), share * static_cast<double>(k + 1));
    for (Piece& piece : pieces_of(lines[k], cutter_locations(lines[k].poses, assembly, part, rule, here), out))
      pieces.push_back(std::move(piece));
  }
  std::unique_ptr<collide::Collider> fixtures;
  if (options.fixture_distance && !scene.fixtures.empty()) {
    fixtures = std::make_unique<collide::Collider>(joined({}, scene.fixtures));
    pieces = clear_of_fixtures(pieces, assembly, *fixtures, *options.fixture_distance - options.tolerance,
                               base::part(progress, 0.7, 0.8), out);
  }
  const Mesh left = turned_stock(scene, Mat3(1));
  const std::unique_ptr<collide::Collider> stock = left.empty() ? nullptr : std::make_unique<collide::Collider>(left);
  const double level = plane + depth_below_tip(tool, largest_tilt(pieces, up));
  const PoseLeads leads({part, stock.get(), up, options.distance, options.tolerance, fixtures.get(),
                         options.fixture_distance.value_or(0)},
                        tool);
  const Progress leading = base::part(progress, 0.8, 1);
  pieces = with_leads(pieces, leads, level, leading, out);
  PoseWriter writer(out, options);
  write(pieces, up, writer, out);
  if (out.poses.empty()) out.reason = out.blocked.empty() ? "there is nothing to cut" : out.blocked.front().reason;
  base::report(progress, 1);
  return out;
}

CutAlongResult cut_along(const SetupScene& scene, const Tool& tool, const std::vector<CutLine>& lines,
                         const CutAlongOptions& options, const Progress& progress) {
  const std::vector<Mesh> none;
  const collide::Collider part(joined(scene.part, options.fixture_distance ? none : scene.fixtures));
  return cut_lines(scene, tool, lines, options, part, progress);
}

}  // namespace riffler::plan
