// Interprets RS-274 as LinuxCNC 2.9 does, block by block, and produces rows.
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
#include "nc/read/control_flow.hpp"
#include "nc/read/cutter_compensation.hpp"
#include "nc/read/frame.hpp"
#include "nc/read/notes.hpp"
#include "nc/read/parameters.hpp"
#include "nc/read/rows.hpp"
#include "nc/read/tool_diameters.hpp"
#include "nc/read/words.hpp"
#include "nc/source.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

class NcInterpreter final : private NcPredefined {
 public:
  /// `folder`: searched for subroutine files in addition to the folders in the options. Throws std::invalid_argument
  /// for invalid options.
  NcInterpreter(std::unique_ptr<NcSource> source, const std::filesystem::path& folder, const ReadOptions& options);

  /// Executes one line. False at the end of the program. Rows are left in pending(). Throws FormatError.
  bool step();
  std::vector<Move>& pending() { return rows_->pending(); }
  /// Throws FormatError naming the line: more rows than can be stored.
  [[noreturn]] void fail_rows() const { place_.fail("more rows than can be stored"); }

  /// "source", and "skipped" and "notes" if there are any.
  Provenance provenance() const { return notes_.provenance(source_); }
  const std::vector<Note>& notes() const { return notes_.notes(); }

 private:
  /// The modes that M70 saves and M72 restores.
  struct Modes {
    std::array<std::size_t, 3> plane{0, 1, 2};  // joint indices of the plane's two axes and its normal
    double unit = 1;                            // mm
    bool absolute = true, absolute_centre = false;
    int feed_mode = 940, return_level = 990, system = 1;
    double feed = 0;  // mm/min, 1/min, or mm/rev; 0: none
    double speed = 0;
    int turning = 0;  // 1 clockwise
    bool surface_speed = false;
    int path_control = 640;
  };
  struct Given {
    bool block_delete = true, check_header = true;
    double max_turns = 0;
    std::vector<std::filesystem::path> folders;
    std::string parameters;
    bool skip_unknown = false;
    CompensationRule compensation = CompensationRule::Error;
    double arc_miss = kArcMiss;
    bool units = false;          // the option "units" was given
    std::optional<double> feed;  // mm/min, until the first F
    int motion = -1;             // until the first one, the code times ten; −1: none
    std::string motion_name;
    std::vector<std::pair<int, std::vector<double>>> positions;  // by the first of their parameter numbers
  };
  /// What is known of an axis's position.
  enum class Stand : std::uint8_t {
    Given,    // programmed
    Start,    // as before the program: taken as 0
    Machine,  // at a machine position whose place in the part is unknown
  };
  /// What is known of an axis's zero in a work offset.
  enum class Zero : std::uint8_t {
    Unknown,   // unknown: taken as 0
    Relative,  // relative to the first system in which the program moves
    Machine,   // in machine coordinates
  };
  struct Saved {
    Modes modes;
    std::size_t depth;  // call depth
    bool restores;      // restored at the end of the subroutine (M73)
  };
  /// The modal words of a canned cycle, mm.
  struct Cycle {
    int code = -1;
    double retract = 0, bottom = 0, peck = 0;
    double level = 0;  // drilling axis before the first of consecutive cycles
  };

  // interpreter.cpp: options, lines, order of execution in a block.
  void take_options(const ReadOptions& options);
  bool execute_line();
  bool executes(NcCursor& cursor);
  bool ended(std::string_view line);
  void percent();
  void block(NcCursor& cursor);
  void execute();
  void note(const char* kind, const std::string& message);

  // interpreter_modes.cpp: blocks without motion.
  void units_and_feed_mode();
  void feed_and_speed();
  void spindle();
  void signals();
  void tool();
  void states();
  void leave_saved_states();
  void restore(const Modes& modes);
  void kinematics();
  void dwell();
  void modes();
  void tool_length();
  void paths();
  void subprograms();
  void stop();

  // interpreter_machine.cpp: machine positions, and knowledge of work offsets.
  void take_start(OptionReader& options);
  void take_positions(OptionReader& options);
  void go_home(int code);
  Joints machine_target();
  void use_positions();
  bool is_zero_known(std::size_t joint) const;
  void to_machine_position(std::size_t joint, Joints& machine, double position, bool known);
  void leave_part(const char* code);
  std::string axes_away() const;
  void check_stands_in_part(const char* what) const;
  bool moves_in_part(bool rapid);
  void begin_or_wait(bool rapid);
  void note_start();
  void note_rapid(const Joints& to);
  void check_work_offset();
  void learn_zero(int number, std::size_t joint, bool by_position);

  // interpreter_compensation.cpp: cutter radius compensation.
  void make_compensation();
  void compensate(int code);
  void choose_offset();
  double compensation_diameter();
  CutterSide compensation_side(double diameter) const;
  bool compensates();
  void contour_to(const Joints& to, int code);
  void refuse_in_compensation(const std::string& what) const;
  void leave_contour(const Joints& to, bool in_part);
  void check_not_leaving() const;

  // interpreter_offsets.cpp: offsets of program coordinates, and their parameters.
  NcFrame frame_of_parameters() const;
  void use_frame(const NcFrame& frame);
  void select_system(int code);
  void non_modal();
  void set_data();
  void set_system(int number, bool by_position);
  void shift_by_words(bool local);
  double length_or_angle(std::size_t joint);
  std::optional<double> predefined(int number) const override;
  std::optional<double> predefined(std::string_view name) const override;

  // interpreter_motion.cpp
  void motion();
  void choose_motion(int code);
  bool goes_home() const;
  void move(int code);
  void refuse(int code);
  bool axes_are_taken() const;
  void check_feed();
  void motion_at_start(int code);
  Joints target();
  void line_to(const Joints& to, bool rapid);
  void straight_to(const Joints& to, const NcRowWords& words);
  void arc_to(const Joints& to, bool clockwise);
  Arc arc_of_words(const Joints& to, bool clockwise);
  Arc the_arc(const Vec2& from, const Vec2& end, bool clockwise);
  void check_centre(const Vec2& from, const Vec2& end, const Vec2& centre, const Vec2& other);
  void spline_to(const Joints& to, int code);
  void drill_at(int code);
  void take_cycle_words(int code);
  NcRowWords row_words(bool rapid);

  NcPlace place_;
  NcParameters parameters_;
  Given given_;
  Options machine_options_;
  std::string machine_;
  bool tcp_given_ = false;
  std::vector<std::string> skipped_here_;
  std::unique_ptr<NcControlFlow> flow_;
  std::unique_ptr<NcRows> rows_;
  std::unique_ptr<NcWords> words_;
  std::unique_ptr<CutterCompensation> compensation_;
  std::string source_;
  NoteList notes_;

  Joints at_{};  // program coordinates, mm and degrees
  std::array<Stand, 6> stand_{Stand::Start, Stand::Start, Stand::Start, Stand::Given, Stand::Given, Stand::Given};
  std::array<std::array<Zero, 3>, 10> zero_{};  // of X Y Z, per system
  std::size_t first_system_ = 0;                // the first system in which rows were made
  std::array<bool, 10> offset_noted_{};
  /// For G28 and G30, per axis: whether the machine position is known, or a position in the part (G28.1).
  std::array<std::array<bool, 6>, 2> home_known_{}, home_in_part_{};
  Modes modes_;
  int motion_ = -1, before_cycle_ = -1;  // the code times ten; −1: none
  bool chosen_ = false;                  // the program has named a motion
  bool feed_noted_ = false;              // a note says that option first_feed was used
  bool feed_given_ = false;              // the program has named a feed above 0
  bool cancelled_ = false;               // by G80
  NcFrame frame_;
  Cycle cycle_;
  std::optional<Vec2> spline_end_;  // G5: from its end to its second control point
  int tool_ = 0, next_tool_ = 0, length_number_ = 0;
  std::optional<Vec3> length_;  // of the current tool, from the first dynamic offset
  bool length_used_ = false, length_off_ = false, compensation_noted_ = false;
  int compensation_code_ = 400;                  // G40 to G42.1, times ten
  std::optional<double> compensation_diameter_;  // mm, of G41.1 and G42.1
  std::optional<int> diameter_number_;           // D
  ToolDiameters diameters_;
  std::map<int, double> tool_radii_;  // mm, of G10 L1, L10 and L11
  std::set<int> offsets_noted_;
  bool begun_ = false;  // whether every linear axis was programmed, or taken as 0
  bool position_noted_ = false, rotary_noted_ = false, start_noted_ = false, away_noted_ = false, units_said_ = false;
  bool rapid_noted_ = false;
  std::vector<Saved> saved_;
  bool started_ = false, percent_ = false, ended_ = false;
};

}  // namespace riffler::nc
