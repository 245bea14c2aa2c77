// Diameters of tools for cutter radius compensation: the reading option "tool_diameters".
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "nc/options.hpp"

namespace riffler {

/// What a control does with a program's G41, G42, RL and RR.
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

  /// mm; none: not known.
  std::optional<double> of(int number) const;

 private:
  std::optional<double> all_;
  std::map<int, double> of_;
};

}  // namespace riffler
