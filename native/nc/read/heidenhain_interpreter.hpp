// Interprets Heidenhain programs block by block and produces rows.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "nc/read/arc.hpp"
#include "nc/read/cutter_compensation.hpp"
#include "nc/read/heidenhain_cycle.hpp"
#include "nc/read/heidenhain_frame.hpp"
#include "nc/read/heidenhain_text.hpp"
#include "nc/read/heidenhain_values.hpp"
#include "nc/read/heidenhain_words.hpp"
#include "nc/read/notes.hpp"
#include "nc/read/rows.hpp"
#include "nc/read/stand.hpp"
#include "nc/read/tool_diameters.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

class HeidenhainInterpreter {
 public:
  /// Keeps a reference to `text`. Throws std::invalid_argument for invalid options.
  HeidenhainInterpreter(std::string_view text, const std::string& file, const ReadOptions& options);

  /// Reads the whole program. Throws FormatError.
  Program run();

 private:
  using Stand = TipStand;
  enum class Positioning : std::uint8_t { Stay, Turn, Move };
  /// The words after the angles of a PLANE.
  struct PlaneWords {
    Positioning positioning = Positioning::Stay;
    int sequence = 0;  // sign of SEQ
    bool turns_table = false;
    HeidenhainRetraction retraction;
    double feed = 0;  // mm/min; 0: FMAX
  };
  struct Pole {
    Vec3 at{0};
    std::size_t u = 0, v = 1;
  };
  /// A corner that RND or CHF rounds or chamfers. The line that leads to it waits for the line that leaves it.
  struct Corner {
    Vec3 from{0};
    NcRowWords words;
    std::optional<double> size;  // mm: radius of RND, leg of CHF; no value: the block comes next
    bool round = false;
    double feed = 0;  // mm/min, at the corner only; 0: as the lines
  };

  // heidenhain_interpreter.cpp: options, order of blocks, notes.
  void take_options(const ReadOptions& options);
  void begin_program();
  void execute(const HeidenhainBlock& block);
  bool execute_motion(const std::string& word, HeidenhainCursor& cursor);
  bool execute_definition(const std::string& word, HeidenhainCursor& cursor);
  void unknown(const std::string& word);
  void expect_end(HeidenhainCursor& cursor);
  void flush();
  void note(const char* kind, const std::string& message);

  // heidenhain_flow.cpp: labels, jumps, parameters.
  void call(HeidenhainCursor& cursor);
  void label(HeidenhainCursor& cursor);
  std::string label_name(HeidenhainCursor& cursor);
  void jump(const std::string& name);
  void function(HeidenhainCursor& cursor);
  void condition(int number, HeidenhainCursor& cursor);
  void assign(HeidenhainCursor& cursor);

  // heidenhain_modes.cpp: tools, M functions, feed, control functions.
  void call_tool(HeidenhainCursor& cursor);
  double take_tool_delta(HeidenhainCursor& cursor, bool noted);
  void define_tool(HeidenhainCursor& cursor);
  void control_function(HeidenhainCursor& cursor);
  void begin_codes(const HeidenhainWords& words);
  void end_codes(const HeidenhainWords& words);
  bool is_user_code(int code) const;
  void take_feed(const HeidenhainWords& words);
  void take_speed(double speed);
  void keep_tip(bool on);
  NcRowWords row_words(bool rapid);

  // heidenhain_compensation.cpp: R0, RL, RR.
  void make_compensation();
  void compensate(char compensation);
  double compensation_radius();
  bool compensates();
  void contour_to(const Vec3& to, const Arc* arc, const Joints& rotary, const NcRowWords& words);
  void refuse_in_compensation(const char* what);
  Vec3 leave_contour(const Vec3& to);
  void stay_beside_contour();

  // heidenhain_cycles.cpp: definition and calls of cycles.
  void define_cycle(HeidenhainCursor& cursor);
  void define_old(int number, int part, HeidenhainCursor& cursor);
  void take_parameters(HeidenhainCursor& cursor);
  void shift_datum(HeidenhainCursor& cursor);
  void reset_datum();
  void rotate(HeidenhainCursor& cursor);
  void use_preset();
  void call_cycle();
  void bore();

  // heidenhain_plane.cpp: tilted working planes.
  void plane(HeidenhainCursor& cursor);
  void old_plane(HeidenhainCursor& cursor);
  PlaneWords plane_words(HeidenhainCursor& cursor);
  void tilt(const Mat3& turn, const PlaneWords& words);
  void untilt(const PlaneWords& words);
  void use_frame(const HeidenhainFrame& frame);
  Joints plane_joints(const PlaneWords& words) const;
  void position(const Joints& joints, const PlaneWords& words);
  void set_plane_parameters(const Joints& joints);
  bool is_upright() const;
  [[noreturn]] void fail_tilted() const;

  // heidenhain_motion.cpp: positioning blocks.
  void line(HeidenhainWords& words);
  void end_line(const HeidenhainWords& words);
  void vector_line(HeidenhainWords& words);
  void polar_line(HeidenhainWords& words);
  void move(const HeidenhainWords& words, const Vec3& to);
  void move_to(const Vec3& to, const Joints& rotary, const NcRowWords& words);
  void to_machine(const HeidenhainWords& words);
  void retract(const HeidenhainRetraction& retraction, double feed);
  Joints rotary_target(const HeidenhainWords& words);
  std::optional<Vec3> spatial_axis(const HeidenhainWords& words);
  void to_axis(const Vec3& to, const Vec3& axis, const NcRowWords& words);
  Vec3 linear_target(const HeidenhainWords& words);
  Joints in_part(const Vec3& at, const Joints& rotary) const;
  void leave_part(const NcRowWords& words);
  void lose_place();
  bool is_away() const;
  std::string axes_away() const;
  bool moves_in_part(const NcRowWords& words);
  void check_length(const Vec3& at) const;

  // heidenhain_arcs.cpp: circles and rounded corners.
  void circle_centre(HeidenhainWords& words);
  void circle(HeidenhainWords& words);
  void radius_circle(HeidenhainWords& words);
  void polar_circle(HeidenhainWords& words);
  void tangent_circle(HeidenhainWords& words, bool polar);
  Vec3 polar_target(const HeidenhainWords& words);
  void arc_to(const Vec3& to, const Arc& arc, std::size_t u, std::size_t v, const HeidenhainWords& words);
  void arc_rows(const Vec3& to, const Arc& arc, std::size_t u, std::size_t v, const Joints& rotary,
                const NcRowWords& words);
  void round_rows(const Vec3& from, const Vec3& to, const Arc& arc, std::pair<std::size_t, std::size_t> plane,
                  const std::pair<Joints, Joints>& rotary, const NcRowWords& words);
  bool is_clockwise(const HeidenhainWords& words);
  const Pole& pole(const char* what) const;
  void corner(HeidenhainWords& words, bool round);
  void cut_corner(const Vec3& to);
  void check_no_corner() const;
  bool corner_follows() const;

  NcPlace place_;
  std::unique_ptr<HeidenhainText> text_;
  HeidenhainValues values_;
  std::unique_ptr<NcRows> rows_;
  Program program_;
  std::string source_;
  bool block_delete_ = false, check_header_ = true, skip_unknown_ = false;
  CompensationRule rule_ = CompensationRule::Error;
  double max_turns_ = 0, turns_ = 0, arc_miss_ = 0;
  NoteList notes_;

  const Progress& progress_;
  std::size_t next_ = 0;             // index of the next block
  std::vector<std::size_t> calls_;   // blocks to return to
  std::map<std::size_t, int> left_;  // repetitions left, by block of the call
  bool ended_ = false;

  double unit_ = 1, feed_unit_ = 1;  // mm; mm/min per unit of F
  double feed_ = 0, call_feed_ = 0;  // mm/min, or mm/rev; 0: none
  bool per_turn_ = false, auto_per_turn_ = false;
  double speed_ = 0;
  int turning_ = 0, tool_ = 0;  // 1 clockwise
  std::map<int, double> tool_radii_;
  ToolDiameters diameters_;
  double tool_more_ = 0;  // mm: DR of TOOL CALL
  std::unique_ptr<CutterCompensation> compensation_;
  char side_ = '0';  // '0', 'L' or 'R'
  std::set<int> offsets_noted_;
  std::set<int> noted_;  // noted M functions, cycles (10 000 and up) and tools (negative)
  std::optional<double> preset_;

  HeidenhainFrame frame_;
  Vec3 at_{0};       // program coordinates, mm
  Joints rotary_{};  // deg; X Y Z without meaning
  TipStands stand_{Stand::Start, Stand::Start, Stand::Start};
  bool keeps_tip_ = false, spatial_ = false, along_vectors_ = false, shortest_ = false;
  Vec3 spatial_angles_{0};
  std::optional<Joints> plane_joints_;

  std::optional<Pole> pole_;
  std::optional<bool> clockwise_;
  std::optional<Vec3> leaving_;  // direction of the last contour element at its end, program coordinates
  std::optional<Corner> corner_;

  int cycle_ = 0;  // cycle executed by a call; 0: none
  std::array<std::optional<double>, 5> old_cycle_{};
  bool calls_everywhere_ = false;  // M89

  bool position_noted_ = false, start_noted_ = false, away_noted_ = false, compensation_noted_ = false;
};

}  // namespace riffler::nc
