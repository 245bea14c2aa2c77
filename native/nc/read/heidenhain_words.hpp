// The words of a positioning block of a Heidenhain program: coordinates, feed, M functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "nc/read/heidenhain_cursor.hpp"
#include "nc/read/heidenhain_values.hpp"

namespace riffler::nc {

/// A coordinate as written: in the program's unit, or degrees.
struct HeidenhainCoordinate {
  double value = 0;
  bool given = false, incremental = false;

  /// The position in mm or degrees, relative to `at` if incremental; `at` if not given.
  double from(double at, double unit) const { return !given ? at : incremental ? at + value * unit : value * unit; }
};

enum class HeidenhainFeed : std::uint8_t {
  Unchanged,
  Number,   ///< mm/min, or tenths of inches a minute
  Auto,     ///< as in TOOL CALL
  Rapid,    ///< FMAX, for its block
  PerTurn,  ///< FU
};

/// M140 MB: a retraction along the tool.
struct HeidenhainRetraction {
  bool given = false, to_limit = false;
  double distance = 0;
};

class HeidenhainWords {
 public:
  /// Optional words of a statement. Coordinates of axes, feed and M functions are always allowed.
  enum Kind : std::uint8_t { Normal = 1, ToolAxis = 2, Polar = 4, Radius = 8, Turning = 16, Length = 32 };

  /// Reads the words up to the end of the block. Throws FormatError for unknown words and for those not in `kinds`.
  void read(HeidenhainCursor& cursor, HeidenhainValues& values, std::uint8_t kinds);

  /// Reads F and its value; the F comes next.
  void read_feed(HeidenhainCursor& cursor, HeidenhainValues& values);

  std::array<HeidenhainCoordinate, 6> axes;          ///< X Y Z A B C
  std::array<HeidenhainCoordinate, 3> normal, tool;  ///< NX NY NZ, TX TY TZ
  HeidenhainCoordinate radius, angle;                ///< PR, PA
  std::optional<double> arc_radius;                  ///< R of CR, RND
  std::optional<bool> clockwise;                     ///< DR−: true, DR+: false
  std::optional<double> length;                      ///< for CHF, and for RND without R
  char compensation = 0;                             ///< '0', 'L', 'R', or 'P' for R+ and R−; 0: none
  HeidenhainFeed feed = HeidenhainFeed::Unchanged;
  double feed_number = 0;
  HeidenhainRetraction retraction;
  std::optional<double> speed;  ///< S, mostly in TOOL CALL
  std::vector<int> codes;       ///< M functions in order
  std::vector<char> reduced;    ///< axes after M94

  bool has_linear() const { return axes[0].given || axes[1].given || axes[2].given; }
  bool has_rotary() const { return axes[3].given || axes[4].given || axes[5].given; }
  bool has_code(int code) const;

 private:
  void take_word(HeidenhainCursor& cursor, HeidenhainValues& values);
  void take_coordinate(HeidenhainCoordinate& to, HeidenhainCursor& cursor, HeidenhainValues& values,
                       std::string_view name, bool incremental);
  void take_radius(HeidenhainCursor& cursor, HeidenhainValues& values);
  void take_code(HeidenhainCursor& cursor, HeidenhainValues& values);

  std::uint8_t kinds_ = 0;
};

}  // namespace riffler::nc
