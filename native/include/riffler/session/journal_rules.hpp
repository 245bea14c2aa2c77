// What a journal is made of, and what may follow what in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::session {

/// The frame of the stock's volume, and the file of its snapshot where it is not the full block.
struct JournalStock {
  Box3 box;
  double pitch = 0;
  std::string directions = "z";  ///< "z" or "xyz"
  std::string snapshot;          ///< file name beside the journal (.rvol), or empty: a block
  std::string mask{};            ///< file name beside the journal (.rvol) of what is protected, or empty: nothing is
};

/// What a stroke does where the tool sweeps: to the stock, but for what is protected, or to what is protected. Soften:
/// a dab at the tip of each row, as wide as the tool (dexel/smooth/smooth_dabs.hpp). Beside: removes as a session does
/// beside what is protected (session/masked_stock.hpp), and Build puts on as a session does; those of one mode that
/// follow each other have one beginning, and no seams between them.
enum class StrokeMode : std::uint32_t { Remove = 0, Add = 1, Mask = 2, Unmask = 3, Soften = 4, Beside = 5, Build = 6 };
inline constexpr std::uint32_t kStrokeModes = 7;

/// Rows of a stroke. A column beside the poses is as long as they are, or empty: not recorded.
struct JournalRows {
  std::span<const Pose> poses;
  std::span<const double> times{};    ///< s, never falling
  std::span<const Wrench> forces{};   ///< N, N·mm that the device was told to give the hand: about the grip
  std::span<const double> removed{};  ///< mm³ by the move that ends at the row; or put on
};

/// Whether a tool that stood at `a` stands there still at `b`: no move.
inline bool stands(const Pose& a, const Pose& b) {
  return a.tip == b.tip && a.axis == b.axis;
}

/// One stroke: what was carved in one go with one tool (replay.hpp). Of one that removes, where nothing is protected,
/// any division into carves leaves the same bytes; of others but a session's (Beside, Build) each carve is a stroke.
struct JournalStroke {
  int tool = 0;
  double tolerance = 0.01;  ///< mm, as carve() was given it
  std::string name{};
  std::vector<Pose> poses{};    ///< at least one
  std::vector<double> times{};  ///< this and the following as JournalRows
  std::vector<Wrench> forces{};
  std::vector<double> removed{};
  StrokeMode mode = StrokeMode::Remove;
  double strength = 0.5;  ///< 0 … 1, of one that softens

  JournalRows rows() const { return {poses, times, forces, removed}; }
  void append(const JournalRows& rows);
};

/// What of a journal its checks need: as small for a long one as for a short one. Each function throws
/// std::invalid_argument saying what is wrong and changes nothing then: a second stock, a number with another tool, a
/// stroke with a tool that is not there, rows with other columns than the stroke's, more rows for a stroke that has
/// ended.
class JournalRules {
 public:
  void set_stock(const JournalStock& stock);
  void add_tool(int number, const std::string& json);
  void add_stroke(const JournalStroke& stroke);
  void extend_stroke(const JournalRows& rows);
  /// n from 1: of those that count, and of those taken back since the last stroke was added.
  void undo(std::size_t n);
  void redo(std::size_t n);

  const std::optional<JournalStock>& stock() const { return stock_; }
  const std::map<int, std::string>& tools() const { return tools_; }
  std::size_t counting() const { return counting_; }  ///< strokes that were not taken back
  std::size_t taken() const { return taken_; }        ///< strokes that can be brought back

 private:
  struct Last {  // row of the stroke that may be extended
    double time;
    bool timed, forces, removed;
  };
  std::optional<JournalStock> stock_;
  std::map<int, std::string> tools_;
  std::optional<Last> last_;
  std::size_t counting_ = 0, taken_ = 0;
};

}  // namespace riffler::session
