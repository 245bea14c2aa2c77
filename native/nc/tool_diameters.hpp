// Diameters of tools for cutter radius compensation: the reading option "tool_diameters".
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "nc/options.hpp"

namespace riffler {

/// How a reader treats cutter radius compensation: G41, G42, RL, RR, CUTCOM.
enum class CompensationRule : std::uint8_t {
  Error,   ///< refuse them
  Ignore,  ///< take points for those of the tool's centre
  Offset,  ///< offset the contour by the tool's radius
};

/// Takes option "cutter_compensation".
CompensationRule take_compensation_rule(OptionReader& options);

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

}  // namespace riffler
