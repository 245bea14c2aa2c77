// Variables of Sinumerik programs, and what is calculated with them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/read/sinumerik_cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// R parameters, and variables that DEF and PROC define, in scopes of subprograms. A value may be one that only the
/// control knows (system variables, $...): it may be assigned, but not used.
class SinumerikValues {
 public:
  enum class Kind : std::uint8_t { Real, Whole, Truth, Text };

  explicit SinumerikValues(const NcPlace& place) : place_(place), scopes_(1) {}

  void enter() { scopes_.emplace_back(); }
  void leave() { scopes_.pop_back(); }

  /// `kind` of "REAL", "INT", "BOOL", "STRING", "CHAR"; nothing for other types.
  static std::optional<Kind> kind_of(std::string_view type);
  void define(const std::string& name, Kind kind, std::optional<double> value);
  void define_text(const std::string& name, const std::string& text);
  /// Whether `name` is a variable, R parameters included.
  bool knows(const std::string& name) const;
  /// The text of a variable of that kind.
  std::optional<std::string> text(const std::string& name) const;

  /// Takes the indices "[...]" of a variable, where there are any: the name of the element.
  std::string element(const std::string& name, SinumerikCursor& cursor);
  /// FormatError for a name that is not defined.
  void assign(const std::string& element, std::optional<double> value);
  /// Takes what follows the = of an assignment.
  void assign(const std::string& element, SinumerikCursor& cursor);

  /// Operators bind as on the control: NOT; * / DIV MOD; + -; AND; XOR; OR; comparisons. Comparisons beside AND, OR or
  /// XOR without brackets are a FormatError, for they do not mean what they seem to. Angles are degrees. Nothing where
  /// only the control knows the value; FormatError where it is not finite.
  std::optional<double> expression(SinumerikCursor& cursor);
  /// The same, FormatError where the value is not known. `what` stands in messages.
  double value(SinumerikCursor& cursor, std::string_view what);
  /// A whole number, or the same.
  int whole(SinumerikCursor& cursor, std::string_view what);
  bool condition(SinumerikCursor& cursor);

 private:
  struct Variable {
    Kind kind = Kind::Real;
    std::optional<double> value;
    std::string text{};
  };
  using Scope = std::map<std::string, Variable, std::less<>>;

  const Variable* find(std::string_view name) const;
  std::optional<double> get(const std::string& element) const;
  std::optional<double> comparison(SinumerikCursor& cursor);
  std::optional<double> logic(SinumerikCursor& cursor, int level, bool& used);
  std::optional<double> sum(SinumerikCursor& cursor);
  std::optional<double> product(SinumerikCursor& cursor);
  std::optional<double> factor(SinumerikCursor& cursor);
  std::optional<double> function(const std::string& name, SinumerikCursor& cursor);
  double checked(double value) const;

  int depth_ = 0;  // of brackets and signs within each other
  const NcPlace& place_;
  std::map<int, std::optional<double>> parameters_;  // R
  std::vector<Scope> scopes_;                        // of the main program first
};

}  // namespace riffler::nc
