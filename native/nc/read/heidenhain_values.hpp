// Q parameters of Heidenhain programs and their arithmetic.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "nc/read/heidenhain_cursor.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// Parameters Q, QL and QR by number. A parameter may hold a value that only the control knows (FN 18: SYSREAD): it may
/// be assigned, but not used.
class HeidenhainValues {
 public:
  explicit HeidenhainValues(const NcPlace& place) : place_(place) {}

  /// Reads the name of a parameter, "Q5", "QL5" or "QR5", and returns its key. Throws FormatError.
  int name(HeidenhainCursor& cursor);
  static std::string shown(int key);

  void set(int key, std::optional<double> value) { values_[key] = value; }
  /// The value; no value if only the control knows it. Throws FormatError for a parameter without an assignment.
  std::optional<double> get(int key) const;
  /// The value of Q`number`. Throws FormatError stating its purpose `what` if it has no known value.
  double needed(int number, std::string_view what) const;
  void forget(int key) { values_.erase(key); }
  bool has(int number) const { return values_.contains(number); }

  /// A number or parameter, after an optional sign: the value of a word; `what` appears in messages. Throws FormatError
  /// if it has no known value.
  double value(HeidenhainCursor& cursor, std::string_view what);
  std::optional<double> operand(HeidenhainCursor& cursor, std::string_view what);

  /// An expression, of formulas (^; * /; + −; functions; brackets) and of FN functions (also DIV, LEN, ANG). Angles are
  /// in degrees. No value if only the control knows it. Throws FormatError if a result is not finite.
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
