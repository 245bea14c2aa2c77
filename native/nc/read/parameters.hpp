// Parameters of NC code: #1 … #5601, #<local>, #<_global>, and those that the control sets.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "nc/source.hpp"

namespace riffler::nc {

/// LinuxCNC's numbers of the control's data: X Y Z A B C from each of these on, for systems also the rotation.
namespace parameter {
inline constexpr int kHome = 5161, kSecondHome = 5181;  // G28, G30
inline constexpr int kShifted = 5210, kShift = 5211;    // G92: whether active, and the shift
inline constexpr int kSystem = 5220;                    // active system: 1 for G54
constexpr int origin(int system) {
  return 5201 + 20 * system;
}
constexpr int rotation(int system) {
  return 5210 + 20 * system;
}
}  // namespace parameter

/// Read-only parameters that follow from the control's state.
class NcPredefined {
 public:
  virtual ~NcPredefined() = default;
  virtual std::optional<double> predefined(int number) const = 0;
  virtual std::optional<double> predefined(std::string_view name) const = 0;
};

class NcParameters {
 public:
  static constexpr int kLast = 5601;     ///< as LinuxCNC
  static constexpr int kArguments = 30;  ///< #1 … #30 belong to the subroutine

  explicit NcParameters(const NcPredefined& predefined) : predefined_(predefined) { frames_.emplace_back(); }

  /// Throws FormatError (at `place`) unless `number` is an integer in range.
  int index(double number, const NcPlace& place) const;
  double get(int number) const;
  /// Throws FormatError for a name without an assignment.
  double get(const std::string& name, const NcPlace& place) const;
  bool exists(const std::string& name) const;

  /// Assignments take effect together, after the whole block was read. Throws FormatError for read-only ones.
  void assign(int number, double value, const NcPlace& place);
  void assign(const std::string& name, double value, const NcPlace& place);
  void apply();

  /// The assigned or loaded value of a number, even if the control's own value takes precedence.
  double stored(int number) const { return numbered_[static_cast<std::size_t>(number)]; }
  /// Sets a number immediately, also read-only ones.
  void set(int number, double value) { numbered_[static_cast<std::size_t>(number)] = value; }

  /// Enters a subroutine: its #1 … #30 are `arguments`, then 0; local names are separate.
  void enter(const std::vector<double>& arguments);
  /// Leaves it, with its return value.
  void leave(std::optional<double> value);
  std::size_t depth() const { return frames_.size() - 1; }

  /// Loads a LinuxCNC parameter file: a number and a value per line. Throws FormatError.
  void load(const std::filesystem::path& path);

 private:
  struct Frame {
    std::array<double, kArguments> outer{};  // values of #1 … #30 in the caller
    std::map<std::string, double, std::less<>> names;
  };
  using Key = std::variant<int, std::string>;

  const NcPredefined& predefined_;
  std::vector<double> numbered_ = std::vector<double>(kLast + 1);
  std::map<std::string, double, std::less<>> globals_;
  std::vector<Frame> frames_;
  std::vector<std::pair<Key, double>> pending_;
  double value_ = 0;
  bool value_returned_ = false;
};

}  // namespace riffler::nc
