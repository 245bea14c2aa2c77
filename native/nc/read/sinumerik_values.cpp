#include "nc/read/sinumerik_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/read/maybe.hpp"

namespace riffler::nc {

namespace {

constexpr int kLastParameter = 9999, kDeepestExpression = 100;
/// Relative difference, as a fraction of the larger number, up to which numbers count as equal.
constexpr double kEqualShare = 1e-12;

struct Function {
  std::string_view name;
  double (*of)(double);
};
constexpr Function kFunctions[] = {
    {"SIN", [](double x) { return base::sin(x * kDegree); }},
    {"COS", [](double x) { return base::cos(x * kDegree); }},
    {"TAN", [](double x) { return base::tan(x * kDegree); }},
    {"ASIN", [](double x) { return base::asin(x) / kDegree; }},
    {"ACOS", [](double x) { return base::acos(x) / kDegree; }},
    {"SQRT", [](double x) { return std::sqrt(x); }},
    {"POT", [](double x) { return x * x; }},
    {"ABS", [](double x) { return std::abs(x); }},
    {"TRUNC", [](double x) { return std::trunc(x); }},
    {"ROUND", [](double x) { return std::round(x); }},
    {"ROUNDUP", [](double x) { return x < 0 ? std::floor(x) : std::ceil(x); }},
    {"LN", [](double x) { return base::log(x); }},
    {"EXP", [](double x) { return base::exp(x); }},
};

/// "R5" → 5.
std::optional<int> parameter_number(std::string_view name) {
  if (name.size() < 2 || name.size() > 8 || name[0] != 'R') return std::nullopt;
  int out = 0;
  for (const char c : name.substr(1)) {
    if (!NcCursor::is_digit(c)) return std::nullopt;
    out = out * 10 + (c - '0');
  }
  return out;
}

std::string_view base_of(std::string_view element) {
  return element.substr(0, element.find('['));
}

/// Tracks the recursion depth.
struct Deeper {
  explicit Deeper(int& depth) : count(++depth) {}
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;
  ~Deeper() { --count; }
  int& count;
};

}  // namespace

// --- Variables ---

std::optional<SinumerikValues::Kind> SinumerikValues::kind_of(std::string_view type) {
  if (type == "REAL") return Kind::Real;
  if (type == "INT" || type == "CHAR") return Kind::Whole;
  if (type == "BOOL") return Kind::Truth;
  if (type == "STRING") return Kind::Text;
  return std::nullopt;
}

void SinumerikValues::define(const std::string& name, Kind kind, std::optional<double> value) {
  if (parameter_number(name)) place_.fail(name + " is an R parameter: give the variable another name");
  scopes_.back()[name] = {kind, 0.0};
  assign(name, value);
}

void SinumerikValues::define_text(const std::string& name, const std::string& text) {
  scopes_.back()[name] = {Kind::Text, std::nullopt, text};
}

const SinumerikValues::Variable* SinumerikValues::find(std::string_view name) const {
  for (const Scope* scope : {&scopes_.back(), &scopes_.front()})
    if (const auto found = scope->find(name); found != scope->end()) return &found->second;
  return nullptr;
}

bool SinumerikValues::knows(const std::string& name) const {
  return name == "R" || parameter_number(name) || find(name);
}

std::optional<std::string> SinumerikValues::text(const std::string& name) const {
  const Variable* variable = find(name);
  return variable && variable->kind == Kind::Text ? std::optional(variable->text) : std::nullopt;
}

std::string SinumerikValues::element(const std::string& name, SinumerikCursor& cursor) {
  if (!cursor.take_if("[")) return name;
  std::string out;
  do out.append(out.empty() ? "" : ",").append(std::to_string(whole(cursor, "an index")));
  while (cursor.take_if(","));
  if (!cursor.take_if("]")) cursor.fail("an index that is not closed by ]");
  return name == "R" ? name + out : name + '[' + out + ']';
}

std::optional<double> SinumerikValues::get(const std::string& element) const {
  if (const auto number = parameter_number(element)) {
    const auto found = parameters_.find(*number);
    if (found == parameters_.end())
      place_.fail(element + " has no value: assign one before it is used (" + element + "=...)");
    return found->second;
  }
  if (const Variable* variable = find(element)) return variable->value;
  const Variable* array = find(base_of(element));
  if (!array || array->kind == Kind::Text)
    place_.fail(element + " is not defined: DEF REAL " + std::string(base_of(element)) + "=... before it is used");
  return array->value;  // initial value of all elements of an array
}

void SinumerikValues::assign(const std::string& element, std::optional<double> value) {
  if (const auto number = parameter_number(element)) {
    if (*number > kLastParameter) place_.fail("there is no such R parameter");
    parameters_[*number] = value;
    return;
  }
  const std::string_view base = base_of(element);
  const Variable* variable = find(base);
  if (!variable)
    place_.fail(element + " is not defined: DEF REAL " + std::string(base) + " at the beginning of the program");
  const Kind kind = variable->kind;
  if (value && kind == Kind::Whole) value = std::round(*value);
  if (value && kind == Kind::Truth) value = *value != 0 ? 1 : 0;
  Scope& scope = scopes_.back().contains(base) ? scopes_.back() : scopes_.front();
  scope[element] = {kind, value};
}

void SinumerikValues::assign(const std::string& element, SinumerikCursor& cursor) {
  const Variable* variable = find(element);
  if (variable && variable->kind == Kind::Text) {
    if (cursor.peek() != '"') place_.fail("a text that is put together is not read: write it as one");
    return define_text(element, cursor.quoted());
  }
  assign(element, expression(cursor));
}

// --- Expressions ---

std::optional<double> SinumerikValues::expression(SinumerikCursor& cursor) {
  const std::optional<double> value = comparison(cursor);
  if (value) checked(*value);
  return value;
}

double SinumerikValues::value(SinumerikCursor& cursor, std::string_view what) {
  const std::optional<double> out = expression(cursor);
  if (!out)
    place_.fail("the value of " + std::string(what) +
                " is known only to the control (a system variable, $...): write what it is at your machine");
  return *out;
}

int SinumerikValues::whole(SinumerikCursor& cursor, std::string_view what) {
  const double number = value(cursor, what);
  if (!(std::abs(number) <= kMaxNumber && std::abs(number - std::round(number)) < 1e-9))
    place_.fail(std::string(what) + " must be a whole number");
  return static_cast<int>(std::round(number));
}

bool SinumerikValues::condition(SinumerikCursor& cursor) {
  return value(cursor, "a condition") != 0;
}

double SinumerikValues::checked(double value) const {
  if (!std::isfinite(value)) place_.fail("a calculation without a finite result");
  return value + 0.0;  // no -0
}

std::optional<double> SinumerikValues::comparison(SinumerikCursor& cursor) {
  static constexpr std::array<std::string_view, 6> kSigns{"==", "<>", ">=", "<=", ">", "<"};
  bool combined = false;
  std::optional<double> left = logic(cursor, 0, combined);
  while (true) {
    if (cursor.take_if("<<")) place_.fail("texts that are put together (<<) are not read here");
    const auto sign = std::ranges::find_if(kSigns, [&](std::string_view s) { return cursor.take_if(s); });
    if (sign == kSigns.end()) return left;
    const std::optional<double> right = logic(cursor, 0, combined);
    if (combined)
      place_.fail(
          "a comparison combined with AND, OR or XOR without brackets: these bind more tightly; put each comparison in "
          "brackets");
    left = both(left, right, [&](double a, double b) {
      const bool equal = std::abs(a - b) <= kEqualShare * std::max(std::abs(a), std::abs(b));
      const bool holds[] = {equal, !equal, a > b || equal, a < b || equal, a > b && !equal, a < b && !equal};
      return holds[sign - kSigns.begin()] ? 1.0 : 0.0;
    });
  }
}

/// OR, XOR and AND, from loosest to tightest.
std::optional<double> SinumerikValues::logic(SinumerikCursor& cursor, int level, bool& used) {
  static constexpr std::string_view kWords[] = {"OR", "XOR", "AND"};
  if (level == 3) return sum(cursor);
  std::optional<double> left = logic(cursor, level + 1, used);
  while (cursor.take_word(kWords[level])) {
    used = true;
    left = both(left, logic(cursor, level + 1, used), [&](double a, double b) {
      const bool x = a != 0, y = b != 0;
      return (level == 0 ? x || y : level == 1 ? x != y : x && y) ? 1.0 : 0.0;
    });
  }
  return left;
}

std::optional<double> SinumerikValues::sum(SinumerikCursor& cursor) {
  std::optional<double> value = product(cursor);
  while (true) {
    const bool plus = cursor.take_if("+");
    if (!plus && !cursor.take_if("-")) return value;
    const double sign = plus ? 1 : -1;
    value = both(value, product(cursor), [&](double a, double b) { return checked(a + sign * b); });
  }
}

std::optional<double> SinumerikValues::product(SinumerikCursor& cursor) {
  std::optional<double> value = factor(cursor);
  const auto by = [&](double (*of)(double, double)) {
    value = both(value, factor(cursor), of);
    if (value) value = checked(*value);
  };
  while (true) {
    if (cursor.take_if("*"))
      by([](double a, double b) { return a * b; });
    else if (cursor.take_if("/"))
      by([](double a, double b) { return a / b; });
    else if (cursor.take_word("DIV"))
      by([](double a, double b) { return std::trunc(a / b); });
    else if (cursor.take_word("MOD"))
      by([](double a, double b) { return std::fmod(a, b); });
    else
      return value;
  }
}

std::optional<double> SinumerikValues::factor(SinumerikCursor& cursor) {
  const Deeper deeper(depth_);
  if (depth_ > kDeepestExpression) place_.fail("an expression that is nested too deeply");
  const auto changed = [&](auto of) {
    const std::optional<double> value = factor(cursor);
    return value ? std::optional<double>(of(*value)) : std::nullopt;
  };
  if (cursor.take_if("-")) return changed([](double x) { return -x; });
  if (cursor.take_if("+")) return factor(cursor);
  if (cursor.take_if("(")) {
    const std::optional<double> value = comparison(cursor);
    if (!cursor.take_if(")")) place_.fail("a bracket that is not closed");
    return value;
  }
  if (cursor.peek() == '"') {
    cursor.quoted();
    return std::nullopt;
  }
  if (cursor.at_number()) return cursor.number("an expression");
  const std::string name = cursor.name();
  if (name.empty()) cursor.fail_unexpected();
  if (name == "NOT") return changed([](double x) { return x == 0 ? 1.0 : 0.0; });
  if (name == "TRUE") return 1;
  if (name == "FALSE") return 0;
  if (name[0] == '$') {
    if (cursor.take_if("[")) cursor.skip_brackets();
    return std::nullopt;
  }
  if (cursor.take_if("(")) return function(name, cursor);
  return get(element(name, cursor));
}

std::optional<double> SinumerikValues::function(const std::string& name, SinumerikCursor& cursor) {
  std::vector<std::optional<double>> of;
  do of.push_back(comparison(cursor));
  while (cursor.take_if(","));
  if (!cursor.take_if(")")) place_.fail("a bracket that is not closed");
  const auto found = std::ranges::find(kFunctions, name, &Function::name);
  const std::size_t count = found != std::end(kFunctions) ? 1 : name == "BOUND" ? 3 : 2;
  if (count == 2 && name != "ATAN2" && name != "MINVAL" && name != "MAXVAL")
    place_.fail("unknown function " + name + ": write what it gives at your machine");
  if (of.size() != count)
    place_.fail(name + std::string(" takes ") + std::to_string(count) + (count == 1 ? " value" : " values"));
  if (!std::ranges::all_of(of, [](const auto& x) { return x.has_value(); })) return std::nullopt;
  if (count == 1) return checked(found->of(*of[0]));
  if (count == 3) return std::min(std::max(*of[0], *of[2]), *of[1]);
  if (name == "ATAN2") return base::atan2(*of[0], *of[1]) / kDegree;
  return name == "MINVAL" ? std::min(*of[0], *of[1]) : std::max(*of[0], *of[1]);
}

}  // namespace riffler::nc
