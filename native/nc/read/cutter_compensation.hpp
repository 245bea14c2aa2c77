// Cutter radius compensation: from a contour and the tool's radius to the path of the tool's centre, move by move.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nc/machine/machine.hpp"
#include "nc/read/arc.hpp"
#include "nc/read/rows.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// The side of the contour on which the tool is, seen in feed direction.
enum class CutterSide : std::int8_t { Left = 1, Right = -1 };

/// Where the first move of a compensation ends: next to the programmed point, perpendicular to …
enum class CutterEntry : std::uint8_t {
  ItsOwnDirection,  ///< the entry move itself, as in LinuxCNC; the next corner is an ordinary one
  NextElement,      ///< the start of the next element, as on Heidenhain controls
};

struct CutterOffset {
  CutterSide side = CutterSide::Left;
  double radius = 0;         ///< mm, > 0
  std::size_t u = 0, v = 1;  ///< joint indices of the plane's two axes
  const char* off = "G40";   ///< the word that ends the compensation, for messages
  CutterEntry entry = CutterEntry::ItsOwnDirection;
};

/// A move of the tool's centre. `arc` lies in the plane; other joints move evenly along it.
struct CentreMove {
  Joints from, to;
  std::optional<Arc> arc;
  NcRowWords words;
};

/// Offsets lines and arcs of a plane. Outside corners get an arc about the corner; at inside corners both elements end
/// where their offsets meet. This takes one element of look-ahead: each waits until the next one is known.
///
/// Throws FormatError at `place` if the tool does not fit: an inside arc not larger than the tool, or an inside corner
/// for which its elements are too short. Only neighbours are checked, as on controls: the tool may still collide with
/// other parts of the contour.
class CutterCompensation {
 public:
  /// Keeps a reference to `place`. `emit` is called with the moves of the centre, in order.
  CutterCompensation(const NcPlace& place, std::function<void(const CentreMove&)> emit)
      : place_(place), emit_(std::move(emit)) {}

  /// Starts at the programmed position `at`, which is that of the tool's centre unless is_leaving().
  void on(const CutterOffset& offset, const Joints& at);
  bool is_on() const { return on_; }
  const CutterOffset& offset() const { return offset_; }
  /// Position of the tool's centre after the emitted moves.
  const Joints& centre() const { return centre_; }

  /// A straight move to `to`. Without motion in the plane, the other joints move at the contour's last offset point.
  void line(const Joints& to, const NcRowWords& words);
  /// Along `arc`, which begins at the programmed point.
  void arc(const Joints& to, const Arc& arc, const NcRowWords& words);

  /// Emits the pending element and ends the compensation. The tool stays at the last offset point until the next move.
  void off();
  /// Whether the tool is still at the offset point where off() left it. True until end_leaving().
  bool is_leaving() const { return leaving_; }
  void end_leaving() { leaving_ = false; }

 private:
  struct StationaryMove {
    Joints to;
    NcRowWords words;
  };
  /// An element of the contour and its offset.
  struct Element {
    Joints to{};
    NcRowWords words;
    bool entry = false;
    Vec2 corner{0};                                 // programmed end
    Vec2 start_tangent{0}, end_tangent{0};          // unit tangents of the contour at its ends
    double start_curvature = 0, end_curvature = 0;  // curvature there, 1/mm, > 0 to the left
    Vec2 start{0}, end{0};   // of the centre: perpendicular to the contour's ends, until a corner moves them
    std::optional<Arc> arc;  // arc of the centre
    double trim_start = 0, trim_end = 0;     // rad by which corners shorten an arc at its start and end
    std::vector<StationaryMove> stationary;  // moves at its end without motion in the plane
  };

  Element line_element(const Joints& to, const NcRowWords& words) const;
  Element arc_element(const Joints& to, const Arc& arc, const NcRowWords& words) const;
  Element entry_line(const Joints& to, const NcRowWords& words) const;
  Element entry_arc(const Joints& to, const Arc& arc, const NcRowWords& words) const;
  void append(Element next);
  void join(Element& before, Element& next);
  double turn(const Element& before, const Element& next) const;
  void round_corner(const Element& before, const Element& next);
  std::optional<Vec2> meeting(const Element& before, const Element& next) const;
  void begin_at(Element& element, const Vec2& at, bool beyond) const;
  void end_at(Element& element, const Vec2& at, bool beyond) const;
  void finish(const Element& element);
  void go(const Joints& to, const std::optional<Arc>& arc, const NcRowWords& words);
  Joints with_centre(const Joints& joints, const Vec2& centre) const;
  Vec2 normal(const Vec2& tangent) const;
  double side() const { return static_cast<double>(offset_.side); }
  [[noreturn]] void fail_fit(const Element& element, const std::string& what) const;

  const NcPlace& place_;
  std::function<void(const CentreMove&)> emit_;
  CutterOffset offset_;
  bool on_ = false, begun_ = false, leaving_ = false;
  Vec2 point_{0};  // programmed
  Joints centre_{};
  std::optional<Element> pending_;
};

}  // namespace riffler::nc
