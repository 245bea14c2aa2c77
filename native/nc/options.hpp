// Reads the named options that callers pass to posts and machines.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/nc/option_values.hpp"

namespace riffler::nc {

/// An option that an OptionReader has read.
struct OptionFact {
  enum class Kind { Number, Positive, Numbers, Range, Flag, Word, Path };

  std::string name;
  Kind kind;
  std::size_t most = 1;                   ///< largest count of numbers
  std::vector<std::string> words = {};    ///< the allowed words
  std::optional<OptionValue> value = {};  ///< default; no value: none
  bool needed = false;                    ///< required
  std::string about = {};                 ///< one sentence, if the machine's description has one
};

/// Takes options out one by one; options left at the end are unknown. Taking a name twice, as an option of a
/// description and a general one, throws std::invalid_argument.
class OptionReader {
 public:
  /// `owner` names the source in messages: "machine tcp", "post tcp". `listing`: required options may be missing,
  /// because the options are only being listed.
  OptionReader(Options options, std::string owner, bool listing = false)
      : options_(std::move(options)), owner_(std::move(owner)), listing_(listing) {}

  const std::string& owner() const { return owner_; }

  /// All options read so far, in order.
  const std::vector<OptionFact>& facts() const { return facts_; }

  /// The number `name`, or no value if not given; throws std::invalid_argument unless positive and finite.
  std::optional<double> positive(const std::string& name);

  /// A finite number, or no value if not given.
  std::optional<double> finite(const std::string& name);

  /// One number (repeated three times) or three numbers of a machine's description, which describes them: `about`. If
  /// there is no `otherwise` and the option `must` be given, a missing one throws std::invalid_argument with `about`.
  Vec3 of_machine(const std::string& name, std::size_t count, const std::optional<Vec3>& otherwise, bool must,
                  const std::string& about);

  /// Whether `name` was given and not taken yet.
  bool given(const std::string& name) const { return options_.contains(name); }

  /// Two finite ascending numbers, or no value if not given.
  std::optional<std::pair<double, double>> range(const std::string& name);

  /// A list of `least` to `most` finite numbers, or no value if not given.
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t least, std::size_t most);

  /// A finite number, a boolean or one of several words; `otherwise` if not given.
  double number(const std::string& name, double otherwise);
  bool flag(const std::string& name, bool otherwise);
  std::string word(const std::string& name, const std::vector<std::string>& known, const std::string& otherwise);

  /// A path; empty if not given.
  std::string path(const std::string& name);

  /// Throws std::invalid_argument naming an option that was not taken, the nearest known one, and all known ones.
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
