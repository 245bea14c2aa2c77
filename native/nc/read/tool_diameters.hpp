// Diameters of tools for cutter radius compensation: the reading option "tool_diameters".
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "nc/options.hpp"

namespace riffler::nc {

/// How a reader treats cutter radius compensation: G41, G42, RL, RR, CUTCOM.
enum class CompensationRule : std::uint8_t {
  Error,   ///< refuse them
  Ignore,  ///< take points for those of the tool's centre
  Offset,  ///< offset the contour by the tool's radius
};

/// Takes option "cutter_compensation".
CompensationRule take_compensation_rule(OptionReader& options);

// What the readers say of it; `code`: G41, RL …
/// Under CompensationRule::Error.
std::string compensation_refused(const std::string& code);
/// Under CompensationRule::Ignore.
std::string compensation_ignored(const std::string& code);
/// `whose`: the offset or the tool of that number.
std::string diameter_unknown(const std::string& code, const std::string& whose, int number);
std::string path_is_offset(const std::string& code, const std::string& whose, double radius);

class ToolDiameters {
 public:
  /// Takes option "tool_diameters" out of `options`, which holds `given`: one diameter (mm) of all tools, or a list of
  /// numbers of tools each with its diameter. A negative diameter changes the side. std::invalid_argument.
  void take(const Options& given, OptionReader& options);

  /// Diameter of a tool or offset, mm; none where the option does not give it.
  std::optional<double> of(int number) const;

 private:
  std::optional<double> all_;
  std::map<int, double> of_;
};

}  // namespace riffler::nc
