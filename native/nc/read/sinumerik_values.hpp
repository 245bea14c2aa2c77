// Variables of Sinumerik programs and their arithmetic.
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

/// R parameters, and variables defined by DEF and PROC, in scopes of subprograms. A value may be known only to the
/// control (system variables, $...): it may be assigned, but not used.
class SinumerikValues {
 public:
  enum class Kind : std::uint8_t { Real, Whole, Truth, Text };

  explicit SinumerikValues(const NcPlace& place) : place_(place), scopes_(1) {}

  void enter() { scopes_.emplace_back(); }
  void leave() { scopes_.pop_back(); }

  /// `kind` of "REAL", "INT", "BOOL", "STRING", "CHAR"; no value for other types.
  static std::optional<Kind> kind_of(std::string_view type);
  void define(const std::string& name, Kind kind, std::optional<double> value);
  void define_text(const std::string& name, const std::string& text);
  /// Whether `name` is a variable, R parameters included.
  bool knows(const std::string& name) const;
  /// The text of a text variable.
  std::optional<std::string> text(const std::string& name) const;

  /// Reads the indices "[...]" of a variable, if any, and returns the name of the element.
  std::string element(const std::string& name, SinumerikCursor& cursor);
  /// Assigns a value. Throws FormatError for an undefined name.
  void assign(const std::string& element, std::optional<double> value);
  /// Reads and assigns the value after the = of an assignment.
  void assign(const std::string& element, SinumerikCursor& cursor);

  /// Reads an expression with the control's precedence: NOT; * / DIV MOD; + -; AND; XOR; OR; comparisons. A comparison
  /// combined with AND, OR or XOR without brackets throws FormatError, since it does not mean what it seems to. Angles
  /// are in degrees. No value if only the control knows it. Throws FormatError if the value is not finite.
  std::optional<double> expression(SinumerikCursor& cursor);
  /// As above, but throws FormatError if the value is unknown. `what` appears in messages.
  double value(SinumerikCursor& cursor, std::string_view what);
  /// An integer, otherwise the same.
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

  int depth_ = 0;  // nesting depth of brackets and signs
  const NcPlace& place_;
  std::map<int, std::optional<double>> parameters_;  // R
  std::vector<Scope> scopes_;                        // the main program first
};

}  // namespace riffler::nc
