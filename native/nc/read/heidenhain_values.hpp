// Q parameters of Heidenhain conversational programs, and what is calculated with them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "nc/read/heidenhain_cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// Parameters Q, QL and QR by number. A parameter may hold a value that only the control knows (FN 18: SYSREAD): it may
/// be handed on, but not used.
class HeidenhainValues {
 public:
  explicit HeidenhainValues(const NcPlace& place) : place_(place) {}

  /// Takes the name of a parameter, "Q5", "QL5" or "QR5": its key. FormatError.
  int name(HeidenhainCursor& cursor);
  static std::string shown(int key);

  void set(int key, std::optional<double> value) { values_[key] = value; }
  /// FormatError for a parameter that nothing was assigned to; nothing where only the control knows its value.
  std::optional<double> get(int key) const;
  /// The value of Q`number`; FormatError saying `what` it is for where it has none that is known.
  double needed(int number, std::string_view what) const;
  void forget(int key) { values_.erase(key); }
  bool has(int number) const { return values_.contains(number); }

  /// A number or a parameter, after a sign or none: the value of a word, `what` in messages. FormatError where it has
  /// none that is known.
  double value(HeidenhainCursor& cursor, std::string_view what);
  std::optional<double> operand(HeidenhainCursor& cursor, std::string_view what);

  /// An expression, of formulas (^; * /; + −; functions; brackets) and of the functions FN (DIV, LEN, ANG too). Angles
  /// are degrees. FormatError where a result is not finite.
  std::optional<double> formula(HeidenhainCursor& cursor);

 private:
  std::optional<double> sum(HeidenhainCursor& cursor, int depth);
  std::optional<double> product(HeidenhainCursor& cursor, int depth);
  std::optional<double> power(HeidenhainCursor& cursor, int depth);
  std::optional<double> factor(HeidenhainCursor& cursor, int depth);
  double checked(double value) const;

  const NcPlace& place_;
  std::map<int, std::optional<double>> values_;
};

}  // namespace riffler::nc
