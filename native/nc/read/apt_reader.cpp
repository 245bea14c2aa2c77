#include "nc/read/apt_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "nc/apt_cutter.hpp"
#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/post_options.hpp"
#include "nc/read/apt_cycle.hpp"
#include "nc/read/apt_lexer.hpp"
#include "nc/read/apt_statements.hpp"
#include "nc/read/apt_system.hpp"
#include "nc/read/arc.hpp"
#include "nc/read/tool_diameters.hpp"

namespace riffler::nc {

namespace {

constexpr std::size_t kMaxListed = 20;
constexpr std::uint64_t kStatementsAReport = 1024;

class AptReader {
 public:
  AptReader(std::string_view text, const std::string& file, const ReadOptions& options)
      : place_{file, 0, {}}, lexer_(text, place_), progress_(options.progress) {
    OptionReader taken(options.options, "machine " + options.machine);
    make_machine(options.machine, taken);
    take_post_options(taken);  // reading and writing share these options
    chord_tolerance_ = taken.positive("chord_tolerance").value_or(0.002);
    skip_unknown_ = taken.word("unknown", {"error", "skip"}, "error") == "skip";
    compensation_ = take_compensation_rule(taken);
    taken.done();
    if (chord_tolerance_ < 1e-6) throw std::invalid_argument("option chord_tolerance must be at least 1e-6 mm");
    program_.provenance.emplace_back("source", file);
  }

  Program run() {
    for (std::uint64_t n = 0; lexer_.next(s_) && s_.major != "FINI"; ++n) {
      if (n % kStatementsAReport == 0) base::report(progress_, lexer_.share());
      const std::string shown = s_.major + (s_.text.empty() ? "" : "/" + s_.text);
      place_.line = s_.line, place_.text = shown;
      execute();
    }
    place_.text = {};
    if (circle_) place_.fail("CIRCLE without the GOTO of its end");
    std::string skipped;
    for (const Note& n : program_.notes)
      if (n.kind == "skipped")
        skipped += (skipped.empty() ? "line " : "; line ") + std::to_string(n.line) + ": " + n.message;
    if (!skipped.empty()) program_.provenance.emplace_back("skipped", skipped);
    return std::move(program_);
  }

 private:
  void execute() {
    const std::string& m = s_.major;
    if (m == "GOTO") return go_to(values(3, 6));
    if (m == "FROM") return from(values(3, 6));
    if (m == "GODLTA") return go_delta(values(1, 3));
    if (m == "RAPID") {
      rapid_ = true;
    } else if (m == "CIRCLE") {
      circle();
    } else if (m == "FEDRAT") {
      feed_rate();
    } else if (m == "SPINDL") {
      spindle();
    } else if (m == "TLAXIS") {
      axis_ = unit(values(3, 3), 0);
    } else if (m == "UNITS" || m == "UNIT") {
      const bool inches = word() == "INCHES" || word() == "INCH" || word() == "IN";
      unit_ = word() == "MM" ? 1 : inches ? kInch : fail_word("MM or INCHES");
    } else if (m == "GOHOME") {
      from(values(3, 3));
    } else if (m == "MSYS" || m == "CSYS" || m == "TRNTYP") {
      system();
    } else if (m == "TLDATA") {
      tool_data();
    } else if (m == "MULTAX") {
      if (!s_.words.empty() && word() != "ON" && word() != "OFF") fail_word("ON or OFF");
    } else if (m == "LOADTL" || m == "TURRET") {
      load_tool(word());
    } else if (m == "LOAD") {
      if (word() != "TOOL" || s_.words.size() < 2) fail_word("TOOL and its number");
      load_tool(s_.words[1]);
    } else if (m == "CUTTER") {
      cutter(values(1, 7));
    } else if (m == "CUTCOM") {
      compensation();
    } else if (m == "CYCLE") {
      cycle_ = apt_cycle(s_, lexer_, unit_, place_);
    } else if (m == "INSERT") {
      list("INSERT " + s_.text);
    } else if (!apt_says_nothing(m)) {
      if (apt_moves(m))
        place_.fail(m + " is not read: it would move the tool or what follows; have the CAM system write GOTOs");
      if (!skip_unknown_)
        place_.fail("unknown statement " + m + ": correct it, or read with options {'unknown': 'skip'}");
      list(m);
    }
  }

  // --- Words ---

  const std::string& word() const {
    if (s_.words.empty()) place_.fail(s_.major + " without a word");
    return s_.words[0];
  }

  [[noreturn]] double fail_word(const std::string& expected) const {
    place_.fail(s_.major + ": expected " + expected + ", not " + word());
  }

  /// All words as numbers, `least` to `most` of them.
  std::vector<double> values(std::size_t least, std::size_t most) const {
    std::vector<double> out;
    for (const std::string& word : s_.words) {
      const std::optional<double> value = lexer_.number(word);
      if (!value) place_.fail(s_.major + ": expected a number, not '" + word + "'");
      out.push_back(*value);
    }
    if (out.size() < least || out.size() > most)
      place_.fail(s_.major + " takes " + std::to_string(least) + (least < most ? " to " + std::to_string(most) : "") +
                  " numbers, not " + std::to_string(out.size()));
    return out;
  }

  Vec3 point(const std::vector<double>& v) const {
    const Vec3 p = unit_ * Vec3(v[0], v[1], v[2]);
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(p[k]) <= kMaxLength)) place_.fail("a coordinate is out of range");
    return p;
  }

  /// A direction as printed, with fewer digits than a double.
  Vec3 unit(const std::vector<double>& v, std::size_t first) const {
    const Vec3 d(v[first], v[first + 1], v[first + 2]);
    const double length = glm::length(d);
    if (!(std::abs(length - 1) < 1e-3)) place_.fail("a direction that is not a unit vector");
    return d / length;
  }

  void list(const std::string& what) {
    if (program_.notes.size() < kMaxListed) program_.notes.push_back({"skipped", s_.line, what});
  }

  // --- Feed, speed, tools ---

  void feed_rate() {
    double number = -1;
    for (const std::string& word : s_.words) {
      if (const std::optional<double> value = lexer_.number(word))
        number = *value;
      else if (word == "MMPM" || word == "IPM" || word == "PERMIN")
        feed_unit_ = word == "MMPM" ? 1 : word == "IPM" ? kInch : 0, per_turn_ = false;
      else if (word == "MMPR" || word == "IPR" || word == "PERREV")
        feed_unit_ = word == "MMPR" ? 1 : word == "IPR" ? kInch : 0, per_turn_ = true;
      else if (word == "RAPID")
        rapid_ = true;
      else
        place_.fail("FEDRAT: unknown word " + word);
    }
    if (number < 0) {
      if (rapid_ || s_.words.empty()) return;
      place_.fail("FEDRAT without a positive number");
    }
    feed_ = number * (feed_unit_ > 0 ? feed_unit_ : unit_);
    if (!(feed_ > 0 && feed_ <= kMaxFeed)) place_.fail("FEDRAT is out of range");
  }

  void spindle() {
    for (const std::string& word : s_.words) {
      if (const std::optional<double> value = lexer_.number(word)) {
        speed_ = *value;
        if (!(speed_ >= 0 && speed_ <= kMaxSpindle)) place_.fail("SPINDL is out of range");
        if (turning_ == 0) turning_ = 1;
      } else if (word == "CLW" || word == "ON") {
        turning_ = 1;
      } else if (word == "CCLW") {
        turning_ = -1;
      } else if (word == "OFF") {
        turning_ = 0;
      } else if (word != "RPM" && word != "RANGE") {
        place_.fail("SPINDL: unknown word " + word);
      }
    }
  }

  void load_tool(const std::string& given) {
    const std::optional<double> number = lexer_.number(given);
    if (!number || !(*number >= 0 && *number <= kMaxNumber && *number == std::floor(*number)))
      place_.fail(s_.major + " needs the tool's number");
    tool_ = static_cast<int>(*number), loads_ = true;
    use_cutter();
  }

  /// An unknown shape stays unknown, with a note.
  void cutter(const std::vector<double>& v) {
    cutter_ = apt_cutter(v, unit_, place_);
    cutter_waits_ = true;
    if (!cutter_) list("CUTTER of a shape that is not known");
  }

  /// NX: MILL, diameter, corner radius, length, and angles of flank and end.
  void tool_data() {
    std::vector<double> v;
    for (std::size_t k = 1; k < s_.words.size(); ++k)
      if (const std::optional<double> value = lexer_.number(s_.words[k])) v.push_back(*value);
    if (word() == "MILL" && v.size() >= 3 && std::all_of(v.begin() + 3, v.end(), [](double x) { return x == 0; }))
      return cutter({v[0], v[1], v[0] / 2 - v[1], v[1], 0, 0, v[2]});
    cutter_.reset();
    cutter_waits_ = true;
    list("TLDATA of a shape that is not known");
  }

  /// The cutter belongs to the tool loaded before or after it; if the file loads none, each cutter is a tool.
  void use_cutter() {
    if (!std::exchange(cutter_waits_, false)) return;
    if (!loads_) ++tool_;
    if (!cutter_) return;
    const auto [found, fresh] = program_.tools.emplace(tool_, *cutter_);
    if (!fresh && !(found->second.parameters() == cutter_->parameters() && found->second.kind() == cutter_->kind()))
      place_.fail("tool " + std::to_string(tool_) + " has two shapes");
    cutter_.reset();
  }

  // --- Coordinate systems ---

  /// A second, different CSYS or TRNTYP does not define where the part is.
  void system() {
    if (s_.major == "MSYS") {
      const std::vector<double> v = values(9, 9);
      const Vec3 here = system_.in_first(at_);
      system_.use(point(v), unit(v, 3), unit(v, 6), place_);
      at_ = system_.from_first(here), axis_ = {0, 0, 1};
      return;
    }
    std::string& known = s_.major == "CSYS" ? csys_ : trntyp_;
    std::string all;
    for (const std::string& word : s_.words) all += word + ',';
    if (!known.empty() && known != all)
      place_.fail(s_.major +
                  " of another system than before: where the one lies in the other is not read; write a program for "
                  "each");
    known = all;
  }

  void compensation() {
    if (word() == "OFF" || word() == "ON") return;
    if (compensation_ != CompensationRule::Ignore)
      place_.fail(
          "cutter radius compensation (CUTCOM) is for the control that the file is posted to: cutter location data are "
          "points of the tool's centre as a rule; where these are, read them with options {'cutter_compensation': "
          "'ignore'}");
    if (!std::exchange(compensation_noted_, true))
      program_.notes.push_back({"cutter compensation", s_.line, compensation_ignored("CUTCOM")});
  }

  // --- Moves ---

  void from(const std::vector<double>& v) {
    rapid_ = true;
    go_to(v);
  }

  void go_delta(const std::vector<double>& v) {
    if (v.size() == 2) place_.fail("GODLTA takes one number or three");
    const Vec3 by = v.size() == 1 ? v[0] * unit_ * axis_ : unit_ * Vec3(v[0], v[1], v[2]);
    move({at_ + by, axis_});
  }

  void go_to(const std::vector<double>& v) {
    if (v.size() != 3 && v.size() != 6) place_.fail(s_.major + " takes 3 or 6 numbers");
    const Pose to{point(v), v.size() == 6 ? unit(v, 3) : axis_};
    if (circle_)
      arc(to);
    else if (cycle_ && !rapid_)
      cycle_at(to);
    else
      move(to);
  }

  void cycle_at(const Pose& point) {
    const double feed = feed_;
    if (cycle_->feed > 0) feed_ = cycle_->feed;
    apt_cycle_moves(*cycle_, point, [&](const Pose& pose, bool rapid) {
      rapid_ = rapid;
      move(pose);
    });
    feed_ = feed;
  }

  void move(const Pose& to) {
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(to.tip[k]) <= kMaxLength)) place_.fail("a coordinate is out of range");
    row(to);
    rapid_ = false;
  }

  void row(const Pose& pose) {
    use_cutter();
    if (program_.size() >= kMaxRows) place_.fail("more rows than can be stored");
    if (!rapid_ && !(feed_ > 0) && program_.size() > 0) place_.fail("a feed move without FEDRAT");
    double feed = rapid_ ? 0 : feed_;
    if (per_turn_ && !rapid_) {
      if (!(speed_ > 0)) place_.fail("a feed per revolution without a spindle speed");
      feed *= speed_;
      if (!(feed <= kMaxFeed)) place_.fail("FEDRAT is out of range");
    }
    // The motion to the first point has an unknown start: it is not cut.
    const bool first = program_.empty();
    program_.append({{system_.in_first(pose.tip), system_.turned(pose.axis)},
                     first && !(feed > 0) ? 0 : feed,
                     turning_ * speed_,
                     tool_,
                     s_.line,
                     rapid_ || first});
    at_ = pose.tip, axis_ = pose.axis;
  }

  /// Centre, axis and, unless it follows from the start, radius; a word may reverse the direction.
  void circle() {
    bool clockwise = false;
    std::vector<std::string> words;
    turns_ = 1;
    for (std::size_t k = 0; k < s_.words.size(); ++k) {
      const std::string& word = s_.words[k];
      if (word == "TIMES") {
        const std::optional<double> turns = k + 1 < s_.words.size() ? lexer_.number(s_.words[k + 1]) : std::nullopt;
        if (!turns || !(*turns >= 1 && *turns <= 1000 && *turns == std::floor(*turns)))
          place_.fail("TIMES needs a whole number of turns");
        turns_ = static_cast<int>(*turns);
        break;
      }
      if (word == "CLOCKWISE" || word == "COUNTERCLOCKWISE")
        clockwise = word == "CLOCKWISE";
      else
        words.push_back(word);
    }
    s_.words = words;
    circle_ = values(6, 16);
    if (clockwise)
      for (std::size_t k = 3; k < 6; ++k) (*circle_)[k] = 0 - (*circle_)[k];
  }

  /// About the circle's axis, right-handed, with even motion along the axis.
  void arc(const Pose& to) {
    const std::vector<double> v = *std::exchange(circle_, std::nullopt);
    if (program_.empty()) place_.fail("CIRCLE before the first point");
    const Vec3 centre = point(v), n = unit(v, 3), from = at_;
    Vec3 x = from - centre - glm::dot(from - centre, n) * n;
    if (!(glm::length(x) > 0)) place_.fail("an arc of radius 0");
    x /= glm::length(x);
    const Vec3 y = glm::cross(n, x);
    const auto in_plane = [&](const Vec3& p) { return Vec2(glm::dot(p - centre, x), glm::dot(p - centre, y)); };
    const double low = glm::dot(from - centre, n), high = glm::dot(to.tip - centre, n);
    Arc round{};
    try {
      round = arc_about(in_plane(from), in_plane(to.tip), {0, 0}, false);
    } catch (const std::invalid_argument& e) {
      place_.fail(e.what());
    }
    if (v.size() > 6 && !(std::abs(round.r0 - v[6] * unit_) <= kArcMiss))
      place_.fail("the circle's radius is not the distance of its start");
    if (turns_ > 1 && std::abs(high - low) > kArcMiss)
      place_.fail("CIRCLE of several turns along its axis (TIMES) is not read: have the CAM system write the helix");
    round = round.with_turns(turns_);
    if (!(glm::dot(axis_, to.axis) > -1 + 1e-12)) place_.fail("the tool's axis turns to its opposite");
    const Motion turning({from, axis_}, to);
    const int chords = round.chords(chord_tolerance_);
    if (chords > kMaxChords) place_.fail("an arc with too many chords");
    for (int i = 1; i <= chords; ++i) {
      const double t = static_cast<double>(i) / chords;
      const Vec2 p = round.at(t);
      row(i == chords ? to : Pose{centre + p.x * x + p.y * y + (low + t * (high - low)) * n, turning.axis(t)});
    }
    rapid_ = false;
  }

  NcPlace place_;
  AptLexer lexer_;
  const Progress& progress_;
  AptStatement s_;
  double chord_tolerance_ = 0;
  bool skip_unknown_ = false, compensation_noted_ = false;
  CompensationRule compensation_ = CompensationRule::Error;
  Program program_;

  double unit_ = 1, feed_ = 0, feed_unit_ = 0, speed_ = 0;
  bool per_turn_ = false, rapid_ = false, loads_ = false, cutter_waits_ = false;
  int turning_ = 0, tool_ = 0;
  Vec3 at_{0}, axis_{0, 0, 1};
  std::optional<std::vector<double>> circle_;
  int turns_ = 1;  // turns of the circle
  std::optional<AptCycle> cycle_;
  AptSystem system_;
  std::string csys_, trntyp_;
  std::optional<Tool> cutter_;
};

}  // namespace

Program parse_apt(std::string_view text, const std::string& file, const ReadOptions& options) {
  return AptReader(text, file, options).run();
}

}  // namespace riffler::nc
