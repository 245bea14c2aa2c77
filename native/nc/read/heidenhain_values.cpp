#include "nc/read/heidenhain_values.hpp"

#include <cmath>
#include <iterator>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "nc/read/maybe.hpp"

namespace riffler::nc {

namespace {

constexpr int kMaxParameter = 9999, kLocal = 10'000, kLasting = 20'000;
constexpr int kMaxDepth = 100;

struct QFunction {
  std::string_view name;
  double (*of)(double);
};

// A name that begins with another name must come before it.
constexpr QFunction kQFunctions[] = {
    {"SQRT", [](double x) { return std::sqrt(x); }},
    {"SQ", [](double x) { return x * x; }},
    {"ASIN", [](double x) { return base::asin(x) / kDegree; }},
    {"ACOS", [](double x) { return base::acos(x) / kDegree; }},
    {"ATAN", [](double x) { return base::atan(x) / kDegree; }},
    {"SIN", [](double x) { return base::sin(x * kDegree); }},
    {"COS", [](double x) { return base::cos(x * kDegree); }},
    {"TAN", [](double x) { return base::tan(x * kDegree); }},
    {"LN", [](double x) { return base::log(x); }},
    {"LOG", [](double x) { return base::log10(x); }},
    {"EXP", [](double x) { return base::exp(x); }},
    {"NEG", [](double x) { return -x; }},
    {"INT", [](double x) { return std::trunc(x); }},
    {"ABS", [](double x) { return std::abs(x); }},
    {"FRAC", [](double x) { return x - std::trunc(x); }},
    {"SGN", [](double x) { return x > 0   ? 1.0
                                  : x < 0 ? -1.0
                                          : 0.0; }},
};

}  // namespace

int HeidenhainValues::name(HeidenhainCursor& cursor) {
  if (!cursor.take_if('Q')) cursor.fail_unexpected();
  int first = 0;
  if (cursor.take_if('L'))
    first = kLocal;
  else if (cursor.take_if('R'))
    first = kLasting;
  else if (cursor.peek() == 'S')
    place_.fail("string parameters (QS) are not read here");
  const double number = cursor.number("Q");
  if (!(number <= kMaxParameter && number == std::floor(number))) place_.fail("there is no such Q parameter");
  return first + static_cast<int>(number);
}

std::string HeidenhainValues::shown(int key) {
  const char* kind = key >= kLasting ? "QR" : key >= kLocal ? "QL" : "Q";
  return std::string(kind) + std::to_string(key % kLocal);
}

std::optional<double> HeidenhainValues::get(int key) const {
  const auto found = values_.find(key);
  if (found == values_.end())
    place_.fail(shown(key) + " has no value: assign one before it is used (FN 0: " + shown(key) + " = ...)");
  return found->second;
}

double HeidenhainValues::needed(int number, std::string_view what) const {
  if (!has(number)) place_.fail(std::string("Q") + std::to_string(number) + ", " + std::string(what) + ", is missing");
  const std::optional<double> value = get(number);
  if (!value)
    place_.fail(std::string("Q") + std::to_string(number) + ", " + std::string(what) +
                ", is known only to the control");
  return *value;
}

std::optional<double> HeidenhainValues::operand(HeidenhainCursor& cursor, std::string_view what) {
  double sign = 1;
  if (cursor.take_if('-'))
    sign = -1;
  else
    cursor.take_if('+');
  if (cursor.peek() != 'Q') return sign * cursor.number(what);
  const std::optional<double> value = get(name(cursor));
  return value ? std::optional(sign * *value) : std::nullopt;
}

double HeidenhainValues::value(HeidenhainCursor& cursor, std::string_view what) {
  const std::optional<double> value = operand(cursor, what);
  if (!value)
    place_.fail("the value of " + std::string(what) +
                " is known only to the control (FN 18, probing): assign what it is at your machine in its place");
  return *value;
}

double HeidenhainValues::checked(double value) const {
  if (!std::isfinite(value)) place_.fail("a calculation without a finite result");
  return value + 0.0;  // no -0
}

std::optional<double> HeidenhainValues::formula(HeidenhainCursor& cursor) {
  const std::optional<double> value = sum(cursor, 0);
  if (value) checked(*value);
  return value;
}

std::optional<double> HeidenhainValues::sum(HeidenhainCursor& cursor, int depth) {
  if (depth > kMaxDepth) place_.fail("a formula that is nested too deeply");
  std::optional<double> value = product(cursor, depth);
  while (true) {
    if (cursor.take_if('+'))
      value = both(value, product(cursor, depth), [](double a, double b) { return a + b; });
    else if (cursor.take_if('-'))
      value = both(value, product(cursor, depth), [](double a, double b) { return a - b; });
    else
      return value;
    if (value) value = checked(*value);
  }
}

std::optional<double> HeidenhainValues::product(HeidenhainCursor& cursor, int depth) {
  std::optional<double> value = power(cursor, depth);
  while (true) {
    if (cursor.take_if('*'))
      value = both(value, power(cursor, depth), [](double a, double b) { return a * b; });
    else if (cursor.take_if('/') || cursor.take_word("DIV"))
      value = both(value, power(cursor, depth), [](double a, double b) { return a / b; });
    else if (cursor.take_word("LEN"))
      value = both(value, power(cursor, depth), [](double a, double b) { return geom::hypot(a, b); });
    else if (cursor.take_word("ANG"))
      value = both(value, power(cursor, depth), [](double a, double b) {
        const double angle = base::atan2(a, b) / kDegree;
        return angle < 0 ? angle + 360 : angle;
      });
    else
      return value;
    if (value) value = checked(*value);
  }
}

std::optional<double> HeidenhainValues::power(HeidenhainCursor& cursor, int depth) {
  std::optional<double> value = factor(cursor, depth);
  while (cursor.take_if('^')) {
    value = both(value, factor(cursor, depth), [](double a, double b) { return base::pow(a, b); });
    if (value) value = checked(*value);
  }
  return value;
}

std::optional<double> HeidenhainValues::factor(HeidenhainCursor& cursor, int depth) {
  if (depth > kMaxDepth) place_.fail("a formula that is nested too deeply");
  if (cursor.take_if('-')) {
    const std::optional<double> value = factor(cursor, depth + 1);
    return value ? std::optional(-*value) : std::nullopt;
  }
  if (cursor.take_if('+')) return factor(cursor, depth + 1);
  if (cursor.take_if('(')) {
    const std::optional<double> value = sum(cursor, depth + 1);
    if (!cursor.take_if(')')) place_.fail("a bracket that is not closed");
    return value;
  }
  if (cursor.take_word("PI")) return kPi;
  for (const QFunction& function : kQFunctions) {
    if (!cursor.take_word(function.name)) continue;
    const std::optional<double> value = factor(cursor, depth + 1);
    return value ? std::optional(checked(function.of(*value))) : std::nullopt;
  }
  return operand(cursor, "a formula");
}

}  // namespace riffler::nc
