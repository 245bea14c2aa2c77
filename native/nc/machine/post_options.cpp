#include "nc/machine/post_options.hpp"

#include <cmath>
#include <stdexcept>

#include "nc/limits.hpp"

namespace riffler::nc {

namespace {

/// A coordinate in mm, if given.
std::optional<double> place(OptionReader& options, const std::string& name) {
  const std::optional<double> value = options.finite(name);
  if (value && !(std::abs(*value) <= kMaxLength))
    throw std::invalid_argument(options.owner() + ": option " + name + " is out of range");
  return value;
}

}  // namespace

PostOptions take_post_options(OptionReader& options, const std::string& coolant) {
  PostOptions out;
  const double step = options.number("line_numbers", 0);
  if (!(step >= 0 && step <= 1000 && step == static_cast<int>(step)))
    throw std::invalid_argument(options.owner() + ": option line_numbers must be a whole step up to 1000; 0: none");
  out.line_numbers = static_cast<int>(step);
  out.coolant = options.word("coolant", {"off", "flood", "mist"}, coolant);
  out.vectors = options.flag("vectors", false);
  out.retract = place(options, "retract");
  out.safe_start = options.flag("safe_start", true);
  out.safe_height = place(options, "safe_height");
  out.arcs = options.flag("arcs", false);
  return out;
}

}  // namespace riffler::nc
