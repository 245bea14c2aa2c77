#include "nc/options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace riffler {

std::optional<OptionValue> OptionReader::take(const std::string& name) {
  if (std::find(known_.begin(), known_.end(), name) != known_.end())
    throw std::invalid_argument(owner_ + ": option " + name +
                                " would have two meanings: [options] of the description must use another name");
  known_.push_back(name);
  auto node = options_.extract(name);
  if (node.empty()) return std::nullopt;
  return std::move(node.mapped());
}

void OptionReader::refuse(const std::string& name, const std::string& must) const {
  throw std::invalid_argument(owner_ + ": option " + name + " must be " + must);
}

std::optional<double> OptionReader::positive(const std::string& name) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return std::nullopt;
  const double* value = std::get_if<double>(&*given);
  if (!value || !(std::isfinite(*value) && *value > 0)) refuse(name, "a positive, finite number");
  return *value;
}

double OptionReader::number(const std::string& name, double otherwise) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return otherwise;
  const double* value = std::get_if<double>(&*given);
  if (!value || !std::isfinite(*value)) refuse(name, "a finite number");
  return *value;
}

Vec3 OptionReader::vector(const std::string& name, const Vec3& otherwise) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return otherwise;
  const auto* value = std::get_if<std::vector<double>>(&*given);
  if (!value || value->size() != 3 ||
      !std::all_of(value->begin(), value->end(), [](double x) { return std::isfinite(x); }))
    refuse(name, "three finite numbers");
  return {(*value)[0], (*value)[1], (*value)[2]};
}

std::optional<std::pair<double, double>> OptionReader::range(const std::string& name) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return std::nullopt;
  const auto* value = std::get_if<std::vector<double>>(&*given);
  if (!value || value->size() != 2 || !std::isfinite((*value)[0]) || !std::isfinite((*value)[1]) ||
      !((*value)[0] < (*value)[1]))
    refuse(name, "two finite numbers that grow");
  return std::pair((*value)[0], (*value)[1]);
}

std::optional<std::vector<double>> OptionReader::numbers(const std::string& name, std::size_t least, std::size_t most) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return std::nullopt;
  const auto* value = std::get_if<std::vector<double>>(&*given);
  if (!value || value->size() < least || value->size() > most ||
      !std::all_of(value->begin(), value->end(), [](double x) { return std::isfinite(x); }))
    refuse(name, std::to_string(least) + " to " + std::to_string(most) + " finite numbers");
  return *value;
}

bool OptionReader::flag(const std::string& name, bool otherwise) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return otherwise;
  const bool* value = std::get_if<bool>(&*given);
  if (!value) refuse(name, "true or false");
  return *value;
}

std::string OptionReader::word(const std::string& name, const std::vector<std::string>& known,
                               const std::string& otherwise) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return otherwise;
  const std::string* value = std::get_if<std::string>(&*given);
  if (!value || std::find(known.begin(), known.end(), *value) == known.end()) {
    std::string all;
    for (const std::string& w : known) all += (all.empty() ? "" : ", ") + w;
    refuse(name, "one of " + all);
  }
  return *value;
}

std::string OptionReader::path(const std::string& name) {
  const std::optional<OptionValue> given = take(name);
  if (!given) return "";
  const std::string* value = std::get_if<std::string>(&*given);
  if (!value) throw std::invalid_argument("option " + name + " must be a path");
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
