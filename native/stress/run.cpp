#include "stress/run.hpp"

#include <algorithm>
#include <exception>
#include <sstream>

#include "riffler/tool/cutters.hpp"
#include "stress/thread_count.hpp"

namespace riffler::stress {

namespace {

constexpr std::size_t kSessionsKept = 20;
constexpr int kRepeatEvery = 4;  // moves between two that are carved a second time
constexpr std::uint64_t kJudge = 0x6A75646765;

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
  return out << v.x << " " << v.y << " " << v.z;
}

std::string describe(const Stage& stage, const Move& move) {
  std::ostringstream out;
  out.precision(17);
  out << "  move: " << name(move.kind) << ", " << name(stage.setting) << ", tolerance " << move.tolerance
      << "\n  stock: " << stage.frame.box.lower << " … " << stage.frame.box.upper << ", pitch " << stage.frame.pitch
      << ", " << stage.frame.directions << "\n  tool: " << stage.tool.kind();
  for (const auto& [key, value] : stage.tool.parameters()) out << ", " << key << " " << value;
  for (const tool::ProfileSegment& s : stage.tool.profile().segments()) {
    out << "\n    to " << s.to.x << " " << s.to.y;
    if (s.centre) out << " about " << s.centre->x << " " << s.centre->y;
  }
  out << "\n  from " << move.from.tip << " axis " << move.from.axis << "\n  to   " << move.to.tip << " axis "
      << move.to.axis;
  return out.str();
}

/// The tool as JSON for Python's Tool.from_dict.
std::string to_json(const Tool& tool) {
  std::ostringstream out;
  out.precision(17);
  out << "{\"name\": \"\", \"kind\": \"" << tool.kind() << "\"";
  for (const auto& [key, value] : tool.parameters()) {
    out << ", \"" << key << "\": ";
    is_flag(tool, key) ? out << (value != 0 ? "true" : "false") : out << value;
  }
  if (tool.kind() == "profile") {
    const char* between = ", \"segments\": [";
    for (const tool::ProfileSegment& s : tool.profile().segments()) {
      out << between << '[' << s.to.x << ", " << s.to.y;
      if (s.centre) out << ", " << s.centre->x << ", " << s.centre->y;
      out << ']', between = ", ";
    }
    out << ']';
  }
  out << '}';
  return out.str();
}

class CarvingSession {
 public:
  CarvingSession(const Options& options, const std::string& cutter, std::uint64_t number, std::uint64_t stream)
      : options_(options),
        judge_(options.seed ^ kJudge, stream, number),
        random_(options.seed, stream, number),
        stage_(draw_stage_for(options, random_, cutter)),
        volume_(Volume::block(stage_.frame)),
        full_(volume_.volume()) {}

  /// Draws and carves one move and checks it.
  Problem step(Tally& tally) {
    if (volume_.volume() < 0.1 * full_) volume_ = Volume::block(stage_.frame);
    moves_.push_back(draw());
    ++tally.moves;
    const Move& move = moves_.back();
    const bool again = random_.one_in(kRepeatEvery);
    const Volume before = volume_;
    Problem p = carve_checked(move);
    if (p.empty() && again) p = repeat(move);
    Random random(judge_.bits());
    if (p.empty() && options_.compare_every > 0 && random.one_in(options_.compare_every)) {
      const Comparison c = compare_with_reference(random, stage_, move, before, volume_, options_.compared_rays);
      ++tally.compared, tally.ends += c.ends, tally.points += c.points;
      tally.normals += c.normals;
      tally.worst = std::max(tally.worst, c.worst);
      tally.worst_normal = std::max(tally.worst_normal, c.worst_normal);
      tally.turned = std::max(tally.turned, c.turned);
      p = c.problem;
    }
    return p;
  }

  /// Carves all moves and the moves between them in one call; 1 and 4 threads must give the same bytes.
  Problem check_threads() const {
    std::vector<Pose> poses;
    for (const Move& m : moves_) {
      if (m.kind == Kind::FarOutside || m.kind == Kind::LongWay)
        continue;  // skip: moves there would take most of the time
      if (!poses.empty() && glm::dot(poses.back().axis, m.from.axis) < -0.999) continue;
      poses.push_back(m.from), poses.push_back(m.to);
    }
    if (poses.size() < 2) return {};
    sweep::CarveOptions options = options_for(moves_.front());
    options.tolerance = std::max(options.tolerance, 0.02 * stage_.tool.profile().max_radius());
    options.dt.assign(poses.size() - 1, 0.001);
    Volume volumes[] = {Volume::block(stage_.frame), Volume::block(stage_.frame)};
    sweep::Cut cuts[2];
    for (int k = 0; k < 2; ++k) {
      const ThreadCount threads(k == 0 ? "1" : "4");
      cuts[k] = sweep::carve(volumes[k], stage_.tool, poses, options);
    }
    if (cuts[0].removed != cuts[1].removed || cuts[0].force != cuts[1].force || cuts[0].torque != cuts[1].torque)
      return "4 threads give other forces or volumes than 1";
    if (Problem p = check_spans(volumes[0]); !p.empty()) return "in one call: " + p;
    const Problem p = check_same_bytes(volumes[0], volumes[1]);
    return p.empty() ? p : "4 threads give other bytes than 1: " + p;
  }

  session::Journal journal() const {
    session::Journal out;
    out.set_stock({stage_.frame.box, stage_.frame.pitch, stage_.frame.directions, ""});
    out.add_tool(1, to_json(stage_.tool));
    for (const Move& m : moves_) out.add_stroke({1, m.tolerance, name(m.kind), {m.from, m.to}, {}});
    return out;
  }

  const Stage& stage() const { return stage_; }
  const Move& last() const { return moves_.back(); }
  int moves() const { return static_cast<int>(moves_.size()); }

 private:
  static Stage draw_stage_for(const Options& options, Random& random, const std::string& cutter) {
    Stage stage = draw_stage(random, cutter);
    if (options.straight) stage.frame.directions = "xyz";
    return stage;
  }

  Move draw() {
    for (;;) {
      const Move move = draw_move(random_, stage_, volume_, moves_);
      if (!options_.straight || Motion(move.from, move.to).angle() == 0) return move;
    }
  }

  static sweep::CarveOptions options_for(const Move& move) {
    sweep::CarveOptions options;
    options.tolerance = move.tolerance;
    options.dt = {0.001};
    return options;
  }

  Problem carve_checked(const Move& move) {
    const Volume before = volume_;
    const sweep::Cut cut = sweep::carve(volume_, stage_.tool, std::vector<Pose>{move.from, move.to}, options_for(move));
    Problem p = check_spans(volume_, &before);
    if (p.empty()) p = check_removed(before, volume_, cut);
    if (p.empty() && out_of_reach(stage_, move) && (volume_.revision() != before.revision() || cut.removed[0] != 0))
      p = "a tool out of reach changed the volume";
    return p;
  }

  /// Repeats a move, which must remove almost nothing.
  Problem repeat(const Move& move) {
    const double before = volume_.volume();
    if (Problem p = carve_checked(move); !p.empty()) return "repeated: " + p;
    const Vec3 size = stage_.frame.box.size();
    const double area = std::max({size.x * size.y, size.y * size.z, size.z * size.x});
    const double again = before - volume_.volume(), most = area * allowed_error(stage_, move).error;
    if (again <= most) return {};
    return "repeated, it removed " + std::to_string(again) + " mm³ more; allowed are " + std::to_string(most);
  }

  const Options& options_;
  Random judge_, random_;  // two streams, so that comparisons do not change what is carved
  Stage stage_;
  Volume volume_;
  double full_;
  std::vector<Move> moves_;
};

std::uint64_t stream_of(const std::string& cutter) {
  const auto names = cutter_names();
  return static_cast<std::uint64_t>(std::find(names.begin(), names.end(), cutter) - names.begin());
}

}  // namespace

Tally& Tally::operator+=(const Tally& o) {
  moves += o.moves, compared += o.compared, ends += o.ends, points += o.points, failures += o.failures;
  normals += o.normals;
  worst = std::max(worst, o.worst);
  worst_normal = std::max(worst_normal, o.worst_normal), turned = std::max(turned, o.turned);
  return *this;
}

Tally Results::total() const {
  Tally sum;
  for (const Tally& t : kinds) sum += t;
  return sum;
}

void run_session(const Options& options, const std::string& cutter, std::uint64_t session, Results& out) {
  CarvingSession s(options, cutter, session, stream_of(cutter));
  const auto guarded = [](const auto& check) -> Problem {
    try {
      return check();
    } catch (const std::exception& e) {
      return std::string("an exception: ") + e.what();
    }
  };
  Problem problem;
  while (problem.empty() && s.moves() < kMovesInSession) {
    Tally tally;
    problem = guarded([&] { return s.step(tally); });
    tally.failures = !problem.empty();
    out.kinds[static_cast<std::size_t>(s.last().kind)] += tally;
    out.settings[static_cast<std::size_t>(s.stage().setting)] += tally;
  }
  if (problem.empty() && options.threads_every > 0 && session % static_cast<unsigned>(options.threads_every) == 0) {
    ++out.thread_checks;
    problem = guarded([&] { return s.check_threads(); });
    if (!problem.empty()) ++out.kinds[static_cast<std::size_t>(s.last().kind)].failures;
  }
  if (!problem.empty() && out.failures.size() < kSessionsKept)
    out.failures.push_back({cutter, options.straight, options.seed, session, s.moves() - 1, s.last().kind,
                            problem + "\n" + describe(s.stage(), s.last())});
}

session::Journal session_journal(const Options& options, const std::string& cutter, std::uint64_t session) {
  CarvingSession s(options, cutter, session, stream_of(cutter));
  Tally tally;
  while (s.moves() < kMovesInSession && s.step(tally).empty()) {
  }
  return s.journal();
}

Results run(const Options& options, const std::string& cutter, long moves,
            const std::function<bool(const Results&)>& progress) {
  Results out;
  for (std::uint64_t session = options.first_session; out.total().moves < moves; ++session) {
    run_session(options, cutter, session, out);
    if (progress && !progress(out)) break;
  }
  return out;
}

std::string reproducer(const Failure& failure) {
  return std::string("riffler_stress ") + (failure.straight ? "--straight " : "") + "--cutter " + failure.cutter +
         " --seed " + std::to_string(failure.seed) + " --session " + std::to_string(failure.session);
}

}  // namespace riffler::stress
