#include "nc/reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>

#include "geom/io.hpp"
#include "nc/arc.hpp"
#include "nc/lexer.hpp"
#include "nc/limits.hpp"
#include "nc/machines.hpp"
#include "nc/post.hpp"
#include "nc/words.hpp"

namespace riffler {

namespace {

constexpr double kInch = 25.4;
/// Rows that chords may make of one block, and of a program: a bound on memory against damaged numbers.
constexpr int kMaxChords = 1'000'000;
constexpr std::size_t kMaxRows = 20'000'000;

enum class Mode : std::uint8_t { None, Rapid, Feed, Clockwise, Counter };

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const ReadOptions& options)
      : taken_(options.options, "machine " + options.machine),
        machine_(make_machine(options.machine, taken_)),
        lexer_(text, file),
        words_(machine_->axes(), lexer_) {
    chord_tolerance_ = taken_.positive("chord_tolerance").value_or(0.002);
    axis_tolerance_ = taken_.positive("axis_tolerance");
    take_post_options(taken_);  // the same options write and read
    taken_.done();
    if (chord_tolerance_ < 1e-6) throw std::invalid_argument("option chord_tolerance must be at least 1e-6 mm");
    if (axis_tolerance_ && *axis_tolerance_ < 1e-6)
      throw std::invalid_argument("option axis_tolerance must be at least 1e-6 rad");
    program_.provenance.emplace_back("source", file);
  }

  Program run() {
    NcBlock block;
    while (lexer_.next(block)) {
      line_ = block.line;
      if (block.percent) {
        percent();
        continue;
      }
      if (ended_) lexer_.fail("text after the end of the program");
      words_.collect(block);
      execute();
      started_ = true;
    }
    return std::move(program_);
  }

 private:
  void percent() {
    // The first frames the start, the second the end.
    if (!started_ && !percent_)
      percent_ = true;
    else
      ended_ = true;
  }

  // --- What the block does, in the order in which a control does it ---

  void execute() {
    if (words_.has('N')) words_.whole('N');
    if (words_.has('O')) {
      if (started_) lexer_.fail("O is read as the number of the program only, before everything else");
      words_.whole('O');
    }
    modes();
    feed_and_speed();
    tool();
    dwell_and_offsets();
    motion();
    words_.check_all_used();
    if (words_.code(NcGroup::Stop) == 20 || words_.code(NcGroup::Stop) == 300) ended_ = true;
  }

  void modes() {
    const int plane = words_.code(NcGroup::Plane);
    if (plane == 170) plane_ = {0, 1, 2};
    if (plane == 180) plane_ = {2, 0, 1};
    if (plane == 190) plane_ = {1, 2, 0};
    if (words_.code(NcGroup::Units) >= 0) unit_ = words_.code(NcGroup::Units) == 200 ? kInch : 1;
    if (words_.code(NcGroup::Distance) >= 0) absolute_ = words_.code(NcGroup::Distance) == 900;
    if (words_.code(NcGroup::ArcDistance) >= 0) absolute_centre_ = words_.code(NcGroup::ArcDistance) == 901;
    if (words_.code(NcGroup::FeedMode) >= 0) {
      const bool inverse = words_.code(NcGroup::FeedMode) == 930;
      if (inverse != inverse_time_) feed_ = 0;
      inverse_time_ = inverse;
    }
    const int motion = words_.code(NcGroup::Motion);
    if (motion == 0) mode_ = Mode::Rapid;
    if (motion == 10) mode_ = Mode::Feed;
    if (motion == 20) mode_ = Mode::Clockwise;
    if (motion == 30) mode_ = Mode::Counter;
    if (motion == 800) mode_ = Mode::None;
  }

  void feed_and_speed() {
    if (inverse_time_) feed_ = 0;  // F counts for its own block only
    if (words_.has('F')) {
      feed_ = words_.value('F', kMaxFeed / kInch) * (inverse_time_ ? 1 : unit_);
      if (!(feed_ > 0)) lexer_.fail("F must be positive");
    }
    if (words_.has('S')) {
      speed_ = words_.value('S', kMaxSpindle);
      if (speed_ < 0) lexer_.fail("S is negative");
    }
    const int spindle = words_.code(NcGroup::Spindle);
    if (spindle == 30) turning_ = 1;
    if (spindle == 40) turning_ = -1;
    if (spindle == 50) turning_ = 0;
  }

  void tool() {
    if (words_.has('T')) next_tool_ = words_.whole('T');
    if (words_.code(NcGroup::ToolChange) == 60) tool_ = next_tool_;
  }

  /// What moves nothing but has words of its own.
  void dwell_and_offsets() {
    if (words_.code(NcGroup::NonModal) == 40) {
      if (!words_.has('P')) lexer_.fail("G4 needs P");
      if (words_.value('P', 1e6) < 0) lexer_.fail("P is negative");
    }
    if (words_.code(NcGroup::PathControl) == 640)
      for (const char letter : {'P', 'Q'})
        if (words_.has(letter)) words_.value(letter, kMaxLength);
    if (words_.has('H')) {
      const int offset = words_.code(NcGroup::ToolLength);
      if (offset != 430 && offset != 434) lexer_.fail("H without G43 or G43.4");
      words_.whole('H');
    }
  }

  void motion() {
    bool axis_words = false;
    for (const char letter : machine_->axes()) axis_words |= words_.has(letter);
    const bool centre_words = words_.has('I') || words_.has('J') || words_.has('K');
    const bool arc = mode_ == Mode::Clockwise || mode_ == Mode::Counter;
    const bool arc_code = words_.code(NcGroup::Motion) == 20 || words_.code(NcGroup::Motion) == 30;
    if (!axis_words && !(arc && centre_words)) {
      if (arc_code) lexer_.fail("an arc without an end or a centre");
      return;
    }
    if (words_.code(NcGroup::NonModal) == 40) lexer_.fail("axis words beside G4");
    if (mode_ == Mode::None) lexer_.fail("axis words without a motion (G0, G1, G2, G3)");
    if (mode_ != Mode::Rapid && !(feed_ > 0))
      lexer_.fail(inverse_time_ ? "a feed move without F: under G93 every block needs its own"
                                : "a feed move without F");
    const Joints to = target();
    if (arc)
      arc_to(to);
    else
      line_to(to);
  }

  Joints target() {
    Joints to = at_;
    for (const char letter : machine_->axes()) {
      if (!words_.has(letter)) continue;
      const std::size_t k = joint_index(letter);
      const double limit = k < 3 ? kMaxLength : kMaxAngle;
      const double word = words_.value(letter, limit) * (k < 3 ? unit_ : 1);
      to[k] = absolute_ ? word : at_[k] + word;
      if (!(std::abs(to[k]) <= limit)) lexer_.fail(std::string(1, letter) + " is out of range");
    }
    return to;
  }

  // --- Rows ---

  void row(const Pose& pose, double feed) {
    if (program_.size() >= kMaxRows) lexer_.fail("more rows than can be held");
    program_.append({pose, feed, turning_ * speed_, tool_, line_, mode_ == Mode::Rapid});
  }

  /// mm/min of a block whose tip goes `way` mm.
  double feed_over(double way) const {
    if (mode_ == Mode::Rapid) return 0;
    return inverse_time_ ? std::min(way * feed_, kMaxFeed) : feed_;
  }

  void line_to(const Joints& to) {
    const Pose from = machine_->pose(at_), end = machine_->pose(to);
    const int parts = machine_->joint_words() || (mode_ == Mode::Feed && axis_tolerance_) ? rotary_parts(to) : 1;
    double way = glm::length(end.tip - from.tip);
    if (parts > 1) {
      way = 0;
      for (int i = 1; i <= parts; ++i) way += glm::length(between(to, i, parts).tip - between(to, i - 1, parts).tip);
    }
    for (int i = 1; i < parts; ++i) row(between(to, i, parts), feed_over(way));
    row(end, feed_over(way));
    at_ = to;
  }

  Pose between(const Joints& to, int i, int parts) const {
    Joints joints;
    for (std::size_t k = 0; k < joints.size(); ++k) joints[k] = at_[k] + (to[k] - at_[k]) * i / parts;
    return machine_->pose(joints);
  }

  /// Equal parts after which each great circle keeps to the axis's true way, where that was asked, and each line to the
  /// tip's, where linear and rotary axes make it together.
  int rotary_parts(const Joints& to) const {
    if (at_[3] == to[3] && at_[4] == to[4] && at_[5] == to[5]) return 1;
    for (int parts = 1; parts <= kMaxChords; parts *= 2) {
      bool good = true;
      for (int i = 0; i < parts && good; ++i) {
        const Pose a = between(to, 4 * i, 4 * parts), b = between(to, 4 * i + 4, 4 * parts);
        // A chord between axes more than 120° apart says nothing about the way between them.
        good = glm::dot(a.axis, b.axis) > -0.5;
        const Motion straight(a, b);
        for (int k = 1; k < 4 && good; ++k) {
          const Pose is = between(to, 4 * i + k, 4 * parts);
          if (mode_ == Mode::Feed && axis_tolerance_)
            good = glm::length(is.axis - straight.axis(k / 4.0)) <= *axis_tolerance_;
          if (machine_->joint_words()) good = good && glm::length(is.tip - straight.tip(k / 4.0)) <= chord_tolerance_;
        }
      }
      // Two parts at least: a full turn begins and ends at the same axis.
      if (good && (parts > 1 || std::abs(to[3] - at_[3]) + std::abs(to[4] - at_[4]) + std::abs(to[5] - at_[5]) < 90))
        return parts;
    }
    lexer_.fail("rotary axes turn too far in one block for chord_tolerance or axis_tolerance");
  }

  void arc_to(const Joints& to) {
    const auto [u, v, w] = plane_;
    const Vec2 from(at_[u], at_[v]), end(to[u], to[v]);
    Arc arc{};
    try {
      arc = the_arc(from, end);
    } catch (const std::invalid_argument& e) {
      lexer_.fail(e.what());
    }
    const int chords = arc.chords(chord_tolerance_);
    if (chords > kMaxChords) lexer_.fail("an arc of too many chords");
    const double feed = feed_over(std::hypot(arc.length(), to[w] - at_[w]));
    Joints joints;
    for (int i = 1; i <= chords; ++i) {
      const double t = static_cast<double>(i) / chords;
      for (std::size_t k = 0; k < joints.size(); ++k) joints[k] = at_[k] + t * (to[k] - at_[k]);
      const Vec2 p = arc.at(t);
      joints[u] = p.x, joints[v] = p.y;
      row(machine_->pose(i < chords ? joints : to), feed);
    }
    at_ = to;
  }

  Arc the_arc(const Vec2& from, const Vec2& end) {
    const bool clockwise = mode_ == Mode::Clockwise;
    constexpr std::array<char, 3> kCentre{'I', 'J', 'K'};
    const auto [u, v, w] = plane_;
    if (words_.has(kCentre[w])) lexer_.fail(std::string(1, kCentre[w]) + " does not lie in the arc's plane");
    const bool offsets = words_.has(kCentre[u]) || words_.has(kCentre[v]);
    if (words_.has('R')) {
      if (offsets) lexer_.fail("an arc with both R and a centre");
      return arc_of_radius(from, end, words_.value('R', kMaxLength) * unit_, clockwise);
    }
    if (!offsets) lexer_.fail("an arc without a centre (I, J, K) or R");
    if (absolute_centre_ && !(words_.has(kCentre[u]) && words_.has(kCentre[v])))
      lexer_.fail(std::string("under G90.1 an arc needs both ") + kCentre[u] + " and " + kCentre[v]);
    Vec2 centre = absolute_centre_ ? Vec2(0, 0) : from;
    if (words_.has(kCentre[u])) centre.x += words_.value(kCentre[u], kMaxLength) * unit_;
    if (words_.has(kCentre[v])) centre.y += words_.value(kCentre[v], kMaxLength) * unit_;
    return arc_about(from, end, centre, clockwise);
  }

  OptionReader taken_;
  std::unique_ptr<Machine> machine_;
  NcLexer lexer_;
  NcWords words_;
  double chord_tolerance_ = 0;
  std::optional<double> axis_tolerance_;
  Program program_;

  int line_ = 0;

  // The control's state.
  Joints at_{};
  Mode mode_ = Mode::None;
  std::array<std::size_t, 3> plane_{0, 1, 2};  // joints of the plane's two axes and of its normal
  double unit_ = 1;
  bool absolute_ = true, absolute_centre_ = false, inverse_time_ = false;
  double feed_ = 0;  // mm/min, or 1/min under G93; 0: none
  double speed_ = 0;
  int turning_ = 0, tool_ = 0, next_tool_ = 0;
  bool percent_ = false, started_ = false, ended_ = false;
};

}  // namespace

Program parse_nc(std::string_view text, const std::string& file, const ReadOptions& options) {
  return Reader(text, file, options).run();
}

Program read_nc(const std::filesystem::path& path, const ReadOptions& options) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  return parse_nc({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.filename().string(), options);
}

}  // namespace riffler
