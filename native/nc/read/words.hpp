// The words of one block: values by letter, G and M codes by modal group, assignments. Detects contradictions within a
// block; knows nothing of what a control does with them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "nc/read/cursor.hpp"
#include "nc/read/parameters.hpp"

namespace riffler::nc {

/// Modal groups after the NIST RS274/NGC interpreter (NISTIR 6556, table 4) and LinuxCNC: two codes of one group in a
/// block contradict each other.
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
  SpindleMode,
  LatheRadius,
  Stop,
  ToolChange,
  Spindle,
  Mist,
  Flood,
  Override,
  Signal,
  State,
  Subprogram,
  Kinematics,
  User,
  Off,
};

/// "G43.4" for 'G' and 434.
std::string nc_code_name(char letter, int tenths);

class NcWords {
 public:
  /// `axes`: the letters of the machine's axes. Errors are thrown at `place`. With `skip`, unknown words are skipped
  /// and their texts appended to it.
  NcWords(std::string_view axes, const NcPlace& place, std::vector<std::string>* skip)
      : axes_(axes), place_(place), skip_(skip) {}

  /// Reads the words of a block. Throws FormatError for an unknown letter or code, a repeated word, two codes of one
  /// group.
  void read(NcCursor& cursor, NcParameters& parameters);

  /// Whether the block is empty.
  bool empty() const { return empty_; }
  /// The code of the group times ten (434 for G43.4), or −1.
  int code(NcGroup group) const { return codes_[static_cast<std::size_t>(group)]; }
  bool has(char letter) const { return (given_ & bit(letter)) != 0; }
  bool has_axes() const { return (given_ & axis_bits_) != 0; }
  /// Whether there are no codes except a motion.
  bool only_moves() const { return (groups_ & ~1U) == 0; }

  /// The value of a word that is present; marks it as used. Throws FormatError unless within ±limit.
  double value(char letter, double limit) {
    used_ |= bit(letter);
    const double v = values_[static_cast<std::size_t>(letter - 'A')];
    if (!(v <= limit && v >= -limit)) fail_range(letter);
    return v;
  }
  /// As above for an integer from 0 to kMaxNumber.
  int whole(char letter);
  /// Whether an axis word was skipped: of an axis that the machine does not have, or with an unknown code.
  bool lost_axes() const { return lost_axes_; }
  /// Marks words without effect on the tool path as used.
  void pass_over(std::string_view letters);

  /// Throws FormatError for a word that was not used.
  void check_all_used() const {
    if (given_ & ~used_) fail_unused();
  }

 private:
  static constexpr std::size_t kGroups = static_cast<std::size_t>(NcGroup::Off) + 1;
  static constexpr std::uint32_t bit(char letter) { return 1U << (letter - 'A'); }
  void add_code(char letter, double value);
  void skip_letter(char letter);
  void skip_code(char letter, const std::string& shown);
  void take_look_ahead();
  void take_skipped_words();
  [[noreturn]] void fail_range(char letter) const;
  [[noreturn]] void fail_unused() const;

  std::string_view axes_;
  const NcPlace& place_;
  std::vector<std::string>* skip_;
  std::uint32_t given_ = 0, used_ = 0, axis_bits_ = 0;
  std::uint32_t groups_ = 0;  // one bit per group that has a code
  bool empty_ = true, skipped_ = false, skipped_g_ = false, lost_axes_ = false;
  std::array<double, 26> values_{};
  std::array<std::int16_t, kGroups> codes_{};
};

}  // namespace riffler::nc
