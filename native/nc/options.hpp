// Reads the named options that callers give to posts and machines.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/nc/option_values.hpp"

namespace riffler::nc {

/// An option that an OptionReader was asked for.
struct OptionFact {
  enum class Kind { Number, Positive, Numbers, Range, Flag, Word, Path };

  std::string name;
  Kind kind;
  std::size_t most = 1;                   ///< how many numbers it has
  std::vector<std::string> words = {};    ///< of which it is one
  std::optional<OptionValue> value = {};  ///< where it is not given; nothing: there is none then
  bool needed = false;                    ///< must be given
  std::string about = {};                 ///< one sentence, where the description of a machine has it
};

/// Takes options out one by one; what is left at the end was not known to anybody. A name that is taken twice has two
/// meanings, a description's own and everybody's: std::invalid_argument.
class OptionReader {
 public:
  /// `owner` stands in messages: "machine tcp", "post tcp". `listing`: an option that must be given may be missing,
  /// as what can be given is looked for.
  OptionReader(Options options, std::string owner, bool listing = false)
      : options_(std::move(options)), owner_(std::move(owner)), listing_(listing) {}

  const std::string& owner() const { return owner_; }

  /// All options asked for so far, in that order.
  const std::vector<OptionFact>& facts() const { return facts_; }

  /// The number `name`, or nothing where it was not given; std::invalid_argument unless it is positive and finite.
  std::optional<double> positive(const std::string& name);

  /// A finite number, or nothing where it was not given.
  std::optional<double> finite(const std::string& name);

  /// One number three times, or three, of a machine's description, which says what they are: `about`. Where `otherwise`
  /// is nothing and the option `must` be given, one that is not is std::invalid_argument with `about`.
  Vec3 of_machine(const std::string& name, std::size_t count, const std::optional<Vec3>& otherwise, bool must,
                  const std::string& about);

  /// Whether `name` was given and nobody has taken it yet.
  bool given(const std::string& name) const { return options_.contains(name); }

  /// Two finite numbers that grow, or nothing where they were not given.
  std::optional<std::pair<double, double>> range(const std::string& name);

  /// A list of `least` to `most` finite numbers, or nothing where it was not given.
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t least, std::size_t most);

  /// A finite number, true or false, or one of some words; `otherwise` where it was not given.
  double number(const std::string& name, double otherwise);
  bool flag(const std::string& name, bool otherwise);
  std::string word(const std::string& name, const std::vector<std::string>& known, const std::string& otherwise);

  /// A path; empty where it was not given.
  std::string path(const std::string& name);

  /// Throws std::invalid_argument naming an option that nobody took, and those that are known.
  void done() const;

 private:
  std::optional<OptionValue> take(OptionFact fact);
  std::optional<double> finite(const std::optional<OptionValue>& given, const std::string& name) const;
  [[noreturn]] void refuse(const std::string& name, const std::string& must) const;

  Options options_;
  std::string owner_;
  bool listing_ = false;
  std::vector<OptionFact> facts_;
};

}  // namespace riffler::nc
