// The elements of a journal, and the rules for their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "riffler/brush/options.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::session {

/// Frame of the stock's volume, and the file of its snapshot unless it is a full block.
struct JournalStock {
  Box3 box;
  double pitch = 0;
  std::string directions = "z";  ///< "z" or "xyz"
  std::string snapshot;          ///< file name (.rvol) in the journal's folder; empty: a full block
  std::string mask{};            ///< file name (.rvol) of the protected region in the journal's folder; empty: none
};

/// Effect of the swept tool: on the stock outside the protected region, or on that region itself.
/// Soften: one smoothing dab at the tip of each row, as wide as the tool (dexel/smooth/smooth_dabs.hpp).
/// Beside: removes as a session with a protected region does (session/masked_stock.hpp). Build: adds as a session does.
/// Consecutive strokes of one of these modes share one start, so they leave no seams.
/// The modes from kFirstBrush on: dabs at the rows, as wide as the tool, of the brush::Kind with the same place in its
/// list (brush/options.hpp).
enum class StrokeMode : std::uint32_t { Remove = 0, Add = 1, Mask = 2, Unmask = 3, Soften = 4, Beside = 5, Build = 6 };
inline constexpr std::uint32_t kFirstBrush = 7;
inline constexpr std::uint32_t kStrokeModes = kFirstBrush + brush::kKinds;

inline bool is_brush(StrokeMode mode) {
  return static_cast<std::uint32_t>(mode) >= kFirstBrush;
}
/// The brush of a mode for which is_brush().
inline brush::Kind brush_of(StrokeMode mode) {
  return static_cast<brush::Kind>(static_cast<std::uint32_t>(mode) - kFirstBrush);
}

/// Rows of a stroke. Each column is as long as `poses`, or empty if it was not recorded.
struct JournalRows {
  std::span<const Pose> poses;
  std::span<const double> times{};    ///< s, non-decreasing
  std::span<const Wrench> forces{};   ///< N, N·mm requested from the device, on the hand, about the grip
  std::span<const double> removed{};  ///< mm³ removed (or added) by the move that ends at the row
  std::span<const Vec3> forward{};    ///< unit vector square to the axis, of a hand tool
};

/// Whether a tool at `a` and a tool at `b` have exactly the same pose: no move.
inline bool stands(const Pose& a, const Pose& b) {
  return a.tip == b.tip && a.axis == b.axis;
}

/// One stroke: a continuous cut with one tool (replay.hpp). A removing stroke without a protected region leaves the
/// same bytes however it is divided into carves; for other strokes, except those of a session (Beside, Build), each
/// carve is a stroke.
struct JournalStroke {
  int tool = 0;
  double tolerance = 0.01;  ///< mm, the tolerance given to carve()
  std::string name{};
  std::vector<Pose> poses{};    ///< at least one
  std::vector<double> times{};  ///< this and the following columns as in JournalRows
  std::vector<Wrench> forces{};
  std::vector<double> removed{};
  StrokeMode mode = StrokeMode::Remove;
  double strength = 0.5;  ///< 0 … 1, for Soften and brushes
  std::vector<Vec3> forward{};
  double amount = 0;  ///< mm or rad, of brushes: brush::BrushOptions
  brush::Falloff falloff = brush::Falloff::Smooth;

  JournalRows rows() const { return {poses, times, forces, removed, forward}; }
  /// Appends rows with the same columns.
  void append(const JournalRows& rows);
};

/// The part of a journal's state that its checks need; its size does not grow with the journal. Each function throws
/// std::invalid_argument with the reason, and then changes nothing: a second stock, a tool number used for another
/// tool, a stroke with an unknown tool, rows with other columns than the stroke's, rows for a stroke that has ended.
class JournalRules {
 public:
  void set_stock(const JournalStock& stock);
  void add_tool(int number, const std::string& json);
  void add_stroke(const JournalStroke& stroke);
  void extend_stroke(const JournalRows& rows);
  /// `n`: at least 1 and at most the number of strokes that count (undo) or of those undone since the last stroke was
  /// added (redo).
  void undo(std::size_t n);
  void redo(std::size_t n);

  const std::optional<JournalStock>& stock() const { return stock_; }
  const std::map<int, std::string>& tools() const { return tools_; }
  std::size_t counting() const { return counting_; }  ///< strokes that are not undone
  std::size_t taken() const { return taken_; }        ///< strokes that can be redone

 private:
  struct Last {  // last row of the stroke that may be extended
    double time;
    bool timed, forces, removed, forward;
  };
  std::optional<JournalStock> stock_;
  std::map<int, std::string> tools_;
  std::optional<Last> last_;
  std::size_t counting_ = 0, taken_ = 0;
};

}  // namespace riffler::session
