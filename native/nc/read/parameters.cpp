#include "nc/read/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "riffler/base/error.hpp"

namespace riffler::nc {

namespace {

bool is_global(std::string_view name) {
  return name.starts_with('_');
}

}  // namespace

int NcParameters::index(double number, const NcPlace& place) const {
  // An integer up to the rounding of an expression counts as that integer, as in LinuxCNC.
  const double whole = std::round(number);
  if (!(std::abs(number - whole) < 1e-4)) place.fail("the number of a parameter must be whole");
  if (!(whole >= 1 && whole <= kLast)) place.fail("parameters have the numbers 1 to " + std::to_string(kLast));
  return static_cast<int>(whole);
}

double NcParameters::get(int number) const {
  // The control sets only the numbers 5399 to 5428 and 5220.
  if (number >= 5220)
    if (const std::optional<double> value = predefined_.predefined(number)) return *value;
  return numbered_[static_cast<std::size_t>(number)];
}

bool NcParameters::exists(const std::string& name) const {
  if (!is_global(name)) return frames_.back().names.contains(name);
  return globals_.contains(name) || name == "_value" || name == "_value_returned" || name == "_call_level" ||
         predefined_.predefined(name).has_value();
}

double NcParameters::get(const std::string& name, const NcPlace& place) const {
  const auto& names = is_global(name) ? globals_ : frames_.back().names;
  if (const auto found = names.find(name); found != names.end()) return found->second;
  if (is_global(name)) {
    if (name == "_value") return value_;
    if (name == "_value_returned") return value_returned_ ? 1 : 0;
    if (name == "_call_level") return static_cast<double>(depth());
    if (const std::optional<double> value = predefined_.predefined(name)) return *value;
  }
  if (name.starts_with("_hal[") || name.starts_with("_ini["))
    place.fail("parameter #<" + name + "> is the machine's own, and not known here: write its value in its place");
  place.fail("parameter #<" + name + "> is read before anything is assigned to it");
}

void NcParameters::assign(int number, double value, const NcPlace& place) {
  if (predefined_.predefined(number)) place.fail("parameter #" + std::to_string(number) + " is read only");
  pending_.emplace_back(number, value);
}

void NcParameters::assign(const std::string& name, double value, const NcPlace& place) {
  if (is_global(name) && !globals_.contains(name) && exists(name)) place.fail("parameter #<" + name + "> is read only");
  pending_.emplace_back(name, value);
}

void NcParameters::apply() {
  for (auto& [key, value] : pending_) {
    if (const int* number = std::get_if<int>(&key))
      set(*number, value);
    else if (const auto& name = std::get<std::string>(key); is_global(name))
      globals_[name] = value;
    else
      frames_.back().names[name] = value;
  }
  pending_.clear();
}

void NcParameters::enter(const std::vector<double>& arguments) {
  Frame frame;
  std::copy_n(numbered_.begin() + 1, kArguments, frame.outer.begin());
  std::fill_n(numbered_.begin() + 1, kArguments, 0.0);
  std::copy_n(arguments.begin(), std::min<std::size_t>(arguments.size(), kArguments), numbered_.begin() + 1);
  frames_.push_back(std::move(frame));
}

void NcParameters::leave(std::optional<double> value) {
  std::copy(frames_.back().outer.begin(), frames_.back().outer.end(), numbered_.begin() + 1);
  frames_.pop_back();
  value_ = value.value_or(0);
  value_returned_ = value.has_value();
}

void NcParameters::load(const std::filesystem::path& path) {
  NcSource source(path);
  NcPlace place{source.name(), 0, {}};
  std::string_view line;
  const auto number = [&](double& value) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc() || !std::isfinite(value)) place.fail("expected the number of a parameter and its value");
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  };
  while (source.next(line)) {
    place.line = source.line(), place.text = line;
    if (line.find_first_not_of(" \t") == line.npos || line[line.find_first_not_of(" \t")] == '#') continue;
    double key = 0, value = 0;
    number(key), number(value);
    set(index(key, place), value);
  }
}

}  // namespace riffler::nc
