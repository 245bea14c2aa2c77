#include "nc/options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/nearest_word.hpp"

namespace riffler::nc {

std::optional<OptionValue> OptionReader::take(OptionFact fact) {
  const std::string name = fact.name;
  if (std::ranges::find(facts_, name, &OptionFact::name) != facts_.end())
    throw std::invalid_argument(owner_ + ": option " + name +
                                " would have two meanings: [options] of the description must use another name");
  facts_.push_back(std::move(fact));
  auto node = options_.extract(name);
  if (node.empty()) return std::nullopt;
  return std::move(node.mapped());
}

void OptionReader::refuse(const std::string& name, const std::string& must) const {
  throw std::invalid_argument(owner_ + ": option " + name + " must be " + must);
}

std::optional<double> OptionReader::positive(const std::string& name) {
  const std::optional<OptionValue> given = take({.name = name, .kind = OptionFact::Kind::Positive});
  if (!given) return std::nullopt;
  const double* value = std::get_if<double>(&*given);
  if (!value || !(std::isfinite(*value) && *value > 0)) refuse(name, "a positive, finite number");
  return *value;
}

std::optional<double> OptionReader::finite(const std::string& name) {
  return finite(take({.name = name, .kind = OptionFact::Kind::Number}), name);
}

double OptionReader::number(const std::string& name, double otherwise) {
  return finite(take({.name = name, .kind = OptionFact::Kind::Number, .value = otherwise}), name).value_or(otherwise);
}

std::optional<double> OptionReader::finite(const std::optional<OptionValue>& given, const std::string& name) const {
  if (!given) return std::nullopt;
  const double* value = std::get_if<double>(&*given);
  if (!value || !std::isfinite(*value)) refuse(name, "a finite number");
  return *value;
}

Vec3 OptionReader::of_machine(const std::string& name, std::size_t count, const std::optional<Vec3>& otherwise,
                              bool must, const std::string& about) {
  std::optional<OptionValue> value;
  if (otherwise && count == 1) value = otherwise->x;
  if (otherwise && count == 3) value = std::vector<double>{otherwise->x, otherwise->y, otherwise->z};
  const std::optional<OptionValue> given =
      take({.name = name,
            .kind = count == 1 ? OptionFact::Kind::Number : OptionFact::Kind::Numbers,
            .most = count,
            .value = std::move(value),
            .needed = must,
            .about = about});
  if (!given && must && !listing_)
    throw std::invalid_argument(owner_ + ": option " + name + " must be given: " + about);
  if (!given) return otherwise.value_or(Vec3(0));
  if (count == 1) return Vec3(*finite(given, name));
  const auto* list = std::get_if<std::vector<double>>(&*given);
  if (!list || list->size() != 3 || !std::ranges::all_of(*list, [](double x) { return std::isfinite(x); }))
    refuse(name, "three finite numbers");
  return {(*list)[0], (*list)[1], (*list)[2]};
}

std::optional<std::pair<double, double>> OptionReader::range(const std::string& name) {
  const std::optional<OptionValue> given = take({.name = name, .kind = OptionFact::Kind::Range, .most = 2});
  if (!given) return std::nullopt;
  const auto* value = std::get_if<std::vector<double>>(&*given);
  if (!value || value->size() != 2 || !std::isfinite((*value)[0]) || !std::isfinite((*value)[1]) ||
      !((*value)[0] < (*value)[1]))
    refuse(name, "two finite ascending numbers");
  return std::pair((*value)[0], (*value)[1]);
}

std::optional<std::vector<double>> OptionReader::numbers(const std::string& name, std::size_t least, std::size_t most) {
  const std::optional<OptionValue> given = take({.name = name, .kind = OptionFact::Kind::Numbers, .most = most});
  if (!given) return std::nullopt;
  const auto* value = std::get_if<std::vector<double>>(&*given);
  if (!value || value->size() < least || value->size() > most ||
      !std::all_of(value->begin(), value->end(), [](double x) { return std::isfinite(x); }))
    refuse(name, std::to_string(least) + " to " + std::to_string(most) + " finite numbers");
  return *value;
}

bool OptionReader::flag(const std::string& name, bool otherwise) {
  const std::optional<OptionValue> given = take({.name = name, .kind = OptionFact::Kind::Flag, .value = otherwise});
  if (!given) return otherwise;
  const bool* value = std::get_if<bool>(&*given);
  if (!value) refuse(name, "true or false");
  return *value;
}

std::string OptionReader::word(const std::string& name, const std::vector<std::string>& known,
                               const std::string& otherwise) {
  const std::optional<OptionValue> given =
      take({.name = name, .kind = OptionFact::Kind::Word, .words = known, .value = otherwise});
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
  const std::optional<OptionValue> given = take({.name = name, .kind = OptionFact::Kind::Path});
  if (!given) return "";
  const std::string* value = std::get_if<std::string>(&*given);
  if (!value) throw std::invalid_argument("option " + name + " must be a path");
  return *value;
}

void OptionReader::done() const {
  if (options_.empty()) return;
  const std::string& wrong = options_.begin()->first;
  std::vector<std::string> names;
  std::string known;
  for (const OptionFact& fact : facts_) {
    names.push_back(fact.name);
    known += (known.empty() ? "" : ", ") + fact.name;
  }
  const std::string hint = base::nearest_word_hint(wrong, names);
  throw std::invalid_argument(owner_ + ": unknown option '" + wrong + "'" + hint + (hint.empty() ? "; " : " ") +
                              (known.empty() ? "it takes none" : "known: " + known));
}

}  // namespace riffler::nc
