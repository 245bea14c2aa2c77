// Interprets Sinumerik programs block by block and produces rows.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "nc/read/arc.hpp"
#include "nc/read/notes.hpp"
#include "nc/read/rows.hpp"
#include "nc/read/sinumerik_cycle.hpp"
#include "nc/read/sinumerik_frame.hpp"
#include "nc/read/sinumerik_text.hpp"
#include "nc/read/sinumerik_values.hpp"
#include "nc/read/sinumerik_words.hpp"
#include "nc/read/stand.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

class SinumerikInterpreter {
 public:
  /// Keeps a reference to `text`. `folder`: searched for subprogram files in addition to the folder of the option.
  /// Throws std::invalid_argument for invalid options.
  SinumerikInterpreter(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                       const ReadOptions& options);

  /// Reads the whole program. Throws FormatError.
  Program run();

 private:
  using Stand = TipStand;
  enum class Motion : std::uint8_t { None, Rapid, Line, Clockwise, CounterClockwise, Through, Tangent };
  /// Motion of the tool's axis between two blocks under TRAORI.
  enum class Turning : std::uint8_t { Unsaid, Axes, GreatCircle };
  /// A part of the program that REPEAT executes again.
  struct Repetition {
    std::size_t begin, end, back;  // block indices; `end` is one past the last
    int left;
  };
  struct Call {
    std::shared_ptr<const SinumerikRoutine> routine;
    std::size_t next = 0;  // index of the next block
    std::vector<Repetition> repetitions{};
    int line = 0;  // line of the main program
    int left = 0;  // calls left, from P
    std::string arguments{};
  };
  using Arguments = std::vector<std::optional<double>>;

  // sinumerik_interpreter.cpp: options, order of blocks, notes.
  void take_options(const ReadOptions& options);
  bool step();
  void execute(const SinumerikBlock& block);
  bool execute_statement(const std::string& word, SinumerikCursor& cursor);
  void words_of(SinumerikCursor& cursor);
  void execute_words(SinumerikWords& words);
  void flush();
  void note(const char* kind, const std::string& message);
  void note_once(int key, const char* kind, const std::string& message);

  // sinumerik_names.cpp: names other than control structures: modes, commands, cycles, subprograms.
  void named(const std::string& name, SinumerikCursor& cursor, const SinumerikWords& words);
  bool switches(const std::string& name);
  void refuse(const std::string& name) const;
  void define(SinumerikCursor& cursor);

  // sinumerik_flow.cpp: control structures, jumps, subprograms.
  bool execute_structure(const SinumerikBlock& block, SinumerikCursor& cursor);
  bool execute_jump(const std::string& word, SinumerikCursor& cursor);
  void for_loop(SinumerikCursor& cursor, bool first);
  void choose(SinumerikCursor& cursor);
  void jump(const std::string& way, SinumerikCursor& cursor, bool taken);
  void go(std::size_t block);
  std::size_t find_label(const std::string& label, bool forward, bool backward) const;
  void repeat(SinumerikCursor& cursor, bool one_block);
  void end_repetitions();
  void call(const std::string& name, SinumerikCursor& cursor, int times);
  void enter(const std::shared_ptr<const SinumerikRoutine>& routine, SinumerikCursor& cursor, int times);
  void bind(const SinumerikRoutine& routine, SinumerikCursor& cursor);
  void leave();
  std::shared_ptr<const SinumerikRoutine> find_routine(const std::string& name);
  void index_folders();
  void count_turn();

  // sinumerik_modes.cpp: G codes, feed, spindle, tool.
  void take_codes(SinumerikWords& words);
  bool take_code(int code);
  void take_units(int code);
  void take_feed(const SinumerikWords& words);
  void begin_functions(const SinumerikWords& words);
  void end_functions(const SinumerikWords& words);
  bool is_of_master(const SinumerikCode& code) const { return code.spindle == 0 || code.spindle == master_; }
  void take_tool(const SinumerikWords& words);
  int number_of_tool(const std::string& name);
  void compensate(int code);
  void select_system(int system);
  NcRowWords row_words(bool rapid);

  // sinumerik_motion.cpp: knowledge of the tip's position; lines.
  void motion(SinumerikWords& words);
  void line(const SinumerikWords& words, bool rapid);
  void vector_line(const SinumerikWords& words, bool rapid);
  void move_to(const Vec3& to, const Joints& rotary, const NcRowWords& words);
  void to_machine(const SinumerikWords& words, bool rapid);
  void to_home(const SinumerikWords& words);
  Vec3 linear_target(const SinumerikWords& words);
  Joints rotary_target(const SinumerikWords& words);
  Joints in_part(const Vec3& at, const Joints& rotary) const;
  void check_length(const Vec3& at) const;
  void leave_part(const NcRowWords& words);
  void lose_place();
  bool is_away() const;
  std::string axes_away() const;
  bool moves_in_part(const NcRowWords& words);
  void begin_or_wait(bool rapid);
  void check_system();
  void note_start();
  bool is_upright() const;
  [[noreturn]] void fail_tilted() const;
  [[noreturn]] void fail_axis(char letter) const;
  void keep_tip(bool on);

  // sinumerik_arcs.cpp
  void arc(const SinumerikWords& words, Motion motion);
  Arc plane_arc(const SinumerikWords& words, const Vec2& from, Vec3& to, Motion motion);
  Vec2 centre_of(const SinumerikWords& words, const Vec2& from) const;
  void arc_to(const Vec3& to, const Arc& arc, const NcRowWords& words);
  void arc_through(const SinumerikWords& words);
  static std::string number_of(double whole);

  // sinumerik_planes.cpp: TRANS, ROT, CYCLE800.
  bool execute_frame(const std::string& word, SinumerikCursor& cursor);
  SinumerikFrame frame_of(const std::string& word, SinumerikCursor& cursor);
  void use_frames(const SinumerikFrame& swivel, const SinumerikFrame& programmed);
  void swivel(SinumerikCursor& cursor);
  void swivel_to(const Mat3& turn, const Vec3& before, const Vec3& after, bool adds, bool retracts, bool turns);
  void unswivel(bool retracts);

  // sinumerik_cycles.cpp: drilling cycles and hole patterns.
  bool execute_cycle(const std::string& word, SinumerikCursor& cursor);
  Arguments arguments(SinumerikCursor& cursor);
  void modal_call(SinumerikCursor& cursor);
  void drill(int number, const Arguments& arguments);
  void holes(const std::string& word, const Arguments& arguments);
  void hole_at(const Vec2& at);

  NcPlace place_;
  SinumerikValues values_;
  std::unique_ptr<NcRows> rows_;
  Program program_;
  std::string source_;
  const Progress& progress_;
  std::map<std::string, std::shared_ptr<const SinumerikRoutine>> routines_;
  std::vector<std::filesystem::path> folders_;
  std::optional<std::map<std::string, std::filesystem::path>> files_;  // subprogram files by name
  std::vector<Call> calls_;                                            // the main program first
  bool block_delete_ = false, check_header_ = true, skip_unknown_ = false, ignore_compensation_ = false;
  double max_turns_ = 0, turns_ = 0, arc_miss_ = 0;
  double executed_ = 0;  // blocks executed
  NoteList notes_;
  bool ended_ = false;

  std::array<std::size_t, 3> plane_{0, 1, 2};         // axes of the plane and its normal
  double basic_unit_ = 1, unit_ = 1, feed_unit_ = 1;  // mm
  bool units_given_ = false, units_said_ = false;
  bool absolute_ = true;
  int feed_mode_ = 94;
  double feed_ = 0, block_feed_ = 0;  // mm/min, 1/min or mm/rev; 0: none
  bool surface_speed_ = false;
  double speed_ = 0;
  int turning_ = 0, master_ = 1;  // 1 clockwise
  int tool_ = 0, next_tool_ = 0, last_tool_ = 0;
  std::vector<std::string> tool_names_;
  bool length_off_ = false;
  Motion motion_ = Motion::None;

  // Flags of the current block.
  bool by_machine_ = false, homes_ = false, dwells_ = false, bounds_ = false, taps_ = false, returns_ = false;

  SinumerikFrame swivel_, programmed_, frame_;  // frame_: both combined
  std::optional<Joints> swivel_joints_;
  Vec3 at_{0};       // program coordinates, mm
  Joints rotary_{};  // deg; X Y Z without meaning
  TipStands stand_{Stand::Start, Stand::Start, Stand::Start};
  bool keeps_tip_ = false, machine_vectors_ = false;
  Turning turning_way_ = Turning::Unsaid, by_system_ = Turning::Unsaid;
  std::optional<Vec3> leaving_;  // direction of the last contour element at its end, program coordinates
  int system_ = -1;              // −1: as before the program; 0: G500; 1 for G54
  std::optional<int> first_system_;
  std::set<int> noted_;
  bool begun_ = false, position_noted_ = false, start_noted_ = false, away_noted_ = false;

  int modal_cycle_ = 0;
  Arguments modal_arguments_;
};

}  // namespace riffler::nc
