// Named options of posts and machines, as callers give them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "geom/vec.hpp"

namespace riffler {

using OptionValue = std::variant<bool, double, std::string, std::vector<double>>;
using Options = std::map<std::string, OptionValue>;

/// Takes options out one by one; what is left at the end was not known to anybody. A name that is taken twice has two
/// meanings, a description's own and everybody's: std::invalid_argument.
class OptionReader {
 public:
  /// `owner` stands in messages: "machine tcp", "post tcp".
  OptionReader(Options options, std::string owner) : options_(std::move(options)), owner_(std::move(owner)) {}

  const std::string& owner() const { return owner_; }

  /// The number `name`, or nothing where it was not given; std::invalid_argument unless it is positive and finite.
  std::optional<double> positive(const std::string& name);

  /// Whether `name` was given and nobody has taken it yet.
  bool given(const std::string& name) const { return options_.count(name) > 0; }

  /// Two finite numbers that grow, or nothing where they were not given.
  std::optional<std::pair<double, double>> range(const std::string& name);

  /// A list of `least` to `most` finite numbers, or nothing where it was not given.
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t least, std::size_t most);

  /// A finite number, three of them, true or false, or one of some words; what is given where it was not.
  double number(const std::string& name, double otherwise);
  Vec3 vector(const std::string& name, const Vec3& otherwise);
  bool flag(const std::string& name, bool otherwise);
  std::string word(const std::string& name, const std::vector<std::string>& known, const std::string& otherwise);

  /// A path; empty where it was not given.
  std::string path(const std::string& name);

  /// Throws std::invalid_argument naming an option that nobody took, and those that are known.
  void done() const;

 private:
  std::optional<OptionValue> take(const std::string& name);
  [[noreturn]] void refuse(const std::string& name, const std::string& must) const;

  Options options_;
  std::string owner_;
  std::vector<std::string> known_;
};

}  // namespace riffler
