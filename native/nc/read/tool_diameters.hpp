// Tool diameters for cutter radius compensation: the reading option "tool_diameters".
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "nc/options.hpp"

namespace riffler::nc {

/// Treatment of cutter radius compensation: G41, G42, RL, RR, CUTCOM.
enum class CompensationRule : std::uint8_t {
  Error,   ///< reject it
  Ignore,  ///< take points as those of the tool's centre
  Offset,  ///< offset the contour by the tool's radius
};

/// Reads option "cutter_compensation".
CompensationRule take_compensation_rule(OptionReader& options);

// Messages of the readers; `code`: G41, RL …

/// Under CompensationRule::Error.
std::string compensation_refused(const std::string& code);
/// Under CompensationRule::Ignore.
std::string compensation_ignored(const std::string& code);
/// `whose`: the offset or the tool of that number.
std::string diameter_unknown(const std::string& code, const std::string& whose, int number);
std::string path_is_offset(const std::string& code, const std::string& whose, double radius);

class ToolDiameters {
 public:
  /// Reads option "tool_diameters" from `options`, whose original values are `given`: one diameter (mm) for all tools,
  /// or a list of tool numbers each followed by its diameter. A negative diameter swaps the side. Throws
  /// std::invalid_argument.
  void take(const Options& given, OptionReader& options);

  /// Diameter of a tool or offset, mm; no value if the option does not give it.
  std::optional<double> of(int number) const;

 private:
  std::optional<double> all_;
  std::map<int, double> of_;
};

}  // namespace riffler::nc
