// The words of a block of a Sinumerik program: coordinates, codes, feed, tool.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/read/sinumerik_cursor.hpp"
#include "nc/read/sinumerik_values.hpp"

namespace riffler::nc {

/// A coordinate as written: in the program's unit, or degrees.
struct SinumerikCoordinate {
  enum class Meaning : std::uint8_t {
    Modal,        ///< by G90 and G91, or relative to an arc's start
    Absolute,     ///< AC()
    Incremental,  ///< IC()
    Shortest,     ///< DC()
    Positive,     ///< ACP()
    Negative,     ///< ACN()
  };
  double value = 0;
  Meaning meaning = Meaning::Modal;
  bool given = false;

  bool is_absolute(bool modal) const { return meaning == Meaning::Modal ? modal : meaning != Meaning::Incremental; }
};

/// A code with the value after its = ("M1=3" is M function 3 of spindle 1).
struct SinumerikCode {
  int number = 0, spindle = 0;  ///< 0: the master spindle
};

class SinumerikWords {
 public:
  /// Handles a name that is not a word; the name has been consumed.
  using Other = std::function<void(const std::string& name, SinumerikCursor& cursor)>;

  /// Reads the words up to the end of the block, including assignments. Throws FormatError.
  void read(SinumerikCursor& cursor, SinumerikValues& values, const Other& other);

  std::array<SinumerikCoordinate, 6> axes;                    ///< X Y Z A B C
  std::array<SinumerikCoordinate, 3> centre, via;             ///< I J K, I1 J1 K1
  std::array<std::optional<double>, 3> vector;                ///< A3 B3 C3
  std::optional<double> radius, opening, turns, plane_angle;  ///< CR, AR, TURN, RPL
  std::optional<double> feed, block_feed, speed;              ///< F, FB, S
  std::optional<int> tool, edge, call, times;                 ///< T, D, L, P
  std::string tool_name;
  std::vector<int> codes;  ///< G
  std::vector<SinumerikCode> functions;
  bool homes = false;  ///< axes with their machine names: X1=0, for G74 and G75

  bool has_linear() const { return axes[0].given || axes[1].given || axes[2].given; }
  bool has_rotary() const { return axes[3].given || axes[4].given || axes[5].given; }
  bool has_centre() const { return centre[0].given || centre[1].given || centre[2].given; }
  bool has_vector() const { return vector[0] || vector[1] || vector[2]; }
  bool has_code(int code) const;
  /// Whether there are no words, except for assignments, which take effect while reading.
  bool empty() const;

 private:
  void take_address(SinumerikCursor& cursor, SinumerikValues& values);
  void take_extended(char letter, const std::string& extension, SinumerikCursor& cursor, SinumerikValues& values);
  void take_name(SinumerikCursor& cursor, SinumerikValues& values, const Other& other);
  void take_parameter(const std::string& name, SinumerikCursor& cursor, SinumerikValues& values);
  void take_coordinate(SinumerikCoordinate& to, const std::string& name, SinumerikCursor& cursor,
                       SinumerikValues& values);
  void take_number(char letter, double value, SinumerikCursor& cursor);
  void once(std::optional<double>& to, double value, const std::string& name, SinumerikCursor& cursor);
};

}  // namespace riffler::nc
