#include "nc/options.hpp"

#include <cmath>
#include <stdexcept>

namespace riffler {

std::optional<double> OptionReader::positive(const std::string& name) {
  known_.push_back(name);
  const auto node = options_.extract(name);
  if (node.empty()) return std::nullopt;
  const double* value = std::get_if<double>(&node.mapped());
  if (!value || !(std::isfinite(*value) && *value > 0))
    throw std::invalid_argument(owner_ + ": option " + name + " must be a positive, finite number");
  return *value;
}

void OptionReader::done() const {
  if (options_.empty()) return;
  std::string known;
  for (const std::string& name : known_) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument(owner_ + ": unknown option '" + options_.begin()->first + "'; " +
                              (known.empty() ? "it takes none" : "known: " + known));
}

}  // namespace riffler
