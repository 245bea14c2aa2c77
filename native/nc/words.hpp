// The words of one block in their places: values by letter, G and M codes by modal group. Knows what contradicts itself
// within a block, not what a control does with it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "nc/lexer.hpp"

namespace riffler {

/// Modal groups, after the NIST RS274/NGC interpreter (NISTIR 6556, table 4): two codes of one group in a block
/// contradict each other.
enum class NcGroup : std::uint8_t {
  Motion,
  NonModal,
  Plane,
  Distance,
  ArcDistance,
  FeedMode,
  Units,
  CutterCompensation,
  ToolLength,
  WorkOffset,
  PathControl,
  ReturnLevel,
  Stop,
  ToolChange,
  Spindle,
  Mist,
  Flood,
};

class NcWords {
 public:
  /// `axes`: the letters of the machine's axes. Errors are raised by `lexer`, which knows the line.
  NcWords(std::string_view axes, const NcLexer& lexer) : axes_(axes), lexer_(lexer) {}

  /// Takes the next block. FormatError: unknown letter or code, a word twice, two codes of one group.
  void collect(const NcBlock& block);

  /// The code of the group times ten (434 for G43.4), or −1.
  int code(NcGroup group) const { return codes_[static_cast<std::size_t>(group)]; }
  bool has(char letter) const { return (given_ & bit(letter)) != 0; }

  /// The value of a word that is there, marked as used. FormatError unless within ±limit.
  double value(char letter, double limit);
  /// The same for a whole number from 0 to kMaxNumber.
  int whole(char letter);

  /// FormatError for a word that nobody asked for.
  void check_all_used() const;

 private:
  static constexpr std::size_t kGroups = static_cast<std::size_t>(NcGroup::Flood) + 1;
  static std::uint32_t bit(char letter) { return 1U << (letter - 'A'); }
  void add_code(char letter, double value);
  [[noreturn]] void fail_unknown(char letter) const;

  std::string_view axes_;
  const NcLexer& lexer_;
  std::uint32_t given_ = 0, used_ = 0;
  std::array<double, 26> values_{};
  std::array<int, kGroups> codes_{};
};

}  // namespace riffler
