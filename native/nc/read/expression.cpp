#include "nc/read/expression.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::nc {

namespace {

constexpr double kEqual = 1e-4;  // as LinuxCNC
/// Nesting depth of brackets: a bound on the stack.
constexpr int kDeepest = 100;

enum class Operator : std::uint8_t { Power, Times, Over, Mod, Plus, Minus, Eq, Ne, Gt, Ge, Lt, Le, And, Or, Xor };
struct Named {
  std::string_view text;
  Operator op;
  int binds;  // larger binds tighter
};
// Operators that begin with another one come first: ** before *.
constexpr std::array<Named, 15> kOperators{{
    {"**", Operator::Power, 5},
    {"*", Operator::Times, 4},
    {"/", Operator::Over, 4},
    {"MOD", Operator::Mod, 4},
    {"+", Operator::Plus, 3},
    {"-", Operator::Minus, 3},
    {"EQ", Operator::Eq, 2},
    {"NE", Operator::Ne, 2},
    {"GT", Operator::Gt, 2},
    {"GE", Operator::Ge, 2},
    {"LT", Operator::Lt, 2},
    {"LE", Operator::Le, 2},
    {"AND", Operator::And, 1},
    {"OR", Operator::Or, 1},
    {"XOR", Operator::Xor, 1},
}};

class Evaluator {
 public:
  Evaluator(NcCursor& cursor, const NcParameters& parameters, const NcPlace& place)
      : cursor_(cursor), parameters_(parameters), place_(place) {}

  double value(char what) {
    const char c = cursor_.peek();
    if (c == '[') {
      cursor_.take();
      return bracket();
    }
    if (c == '#') {
      cursor_.take();
      return parameter();
    }
    if ((c == '-' || c == '+') && !cursor_.at_number()) {
      const Deeper deeper(*this);
      cursor_.take();
      if (const char next = cursor_.peek(); next == '-' || next == '+')
        cursor_.fail(std::string("expected a number after ") + what);
      return c == '-' ? -value(what) : value(what);
    }
    if (NcCursor::is_letter(c)) {
      // A letter may begin the next word: only a complete function name followed by a bracket counts.
      if (const auto result = function()) return *result;
    }
    return cursor_.number(what);
  }

  /// #5, #[1 + 2], ##3, #<name>, after "#". An assignment has the same key.
  std::variant<int, std::string> key() {
    const Deeper deeper(*this);
    if (cursor_.peek() == '<') {
      cursor_.take();
      return cursor_.name();
    }
    return parameters_.index(value('#'), place_);
  }

 private:
  /// Tracks the recursion depth.
  struct Deeper {
    explicit Deeper(Evaluator& evaluator) : e(evaluator) {
      if (++e.depth_ > kDeepest) e.cursor_.fail("brackets nested more than 100 deep");
    }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    ~Deeper() { --e.depth_; }
    Evaluator& e;
  };

  double parameter() {
    const auto which = key();
    if (const int* number = std::get_if<int>(&which)) return parameters_.get(*number);
    return parameters_.get(std::get<std::string>(which), place_);
  }

  /// The rest of [ … ] after its first character.
  double bracket() {
    const Deeper deeper(*this);
    const double result = climb(value('['), 1);
    if (!cursor_.take_if(']')) {
      if (cursor_.peek() == '\0') cursor_.fail("an expression that is not closed by ]");
      cursor_.fail("expected an operator or ] in an expression");
    }
    return result;
  }

  const Named* next_operator() {
    if (waiting_) return std::exchange(waiting_, nullptr);
    cursor_.peek();
    for (const Named& named : kOperators)
      if (cursor_.take_word(named.text)) return &named;
    return nullptr;
  }

  /// Precedence climbing: `left` and everything after it with operators that bind at least as tightly as `least`. A
  /// looser operator is left for the caller in waiting_.
  double climb(double left, int least) {
    while (const Named* op = next_operator()) {
      if (op->binds < least) {
        waiting_ = op;
        break;
      }
      const double right = climb(value('['), op->binds + 1);
      left = finite(apply(op->op, left, right));
    }
    return left;
  }

  double apply(Operator op, double a, double b) {
    const auto truth = [](bool is) { return is ? 1.0 : 0.0; };
    switch (op) {
      case Operator::Power:
        if (a < 0 && b != std::floor(b)) cursor_.fail("a negative number to a power that is not whole");
        return base::pow(a, b);
      case Operator::Times:
        return a * b;
      case Operator::Over:
        if (b == 0) cursor_.fail("division by zero");
        return a / b;
      case Operator::Mod: {
        if (b == 0) cursor_.fail("division by zero");
        const double rest = std::fmod(a, b);
        return rest < 0 ? rest + std::abs(b) : rest;
      }
      case Operator::Plus:
        return a + b;
      case Operator::Minus:
        return a - b;
      case Operator::Eq:
        return truth(std::abs(a - b) < kEqual);
      case Operator::Ne:
        return truth(std::abs(a - b) >= kEqual);
      case Operator::Gt:
        return truth(a > b);
      case Operator::Ge:
        return truth(a >= b);
      case Operator::Lt:
        return truth(a < b);
      case Operator::Le:
        return truth(a <= b);
      case Operator::And:
        return truth(a != 0 && b != 0);
      case Operator::Or:
        return truth(a != 0 || b != 0);
      case Operator::Xor:
        return truth((a != 0) != (b != 0));
    }
    return 0;
  }

  double finite(double x) {
    if (!std::isfinite(x)) cursor_.fail("an expression whose value is not finite");
    return x;
  }

  std::optional<double> function() {
    for (const std::string_view name :
         {"ABS", "ACOS", "ASIN", "ATAN", "COS", "EXISTS", "EXP", "FIX", "FUP", "LN", "ROUND", "SIN", "SQRT", "TAN"})
      if (cursor_.take_word(name)) {
        if (!cursor_.take_if('[')) cursor_.fail("expected [ after " + std::string(name));
        return finite(name == "EXISTS" ? exists() : name == "ATAN" ? arc_tangent() : of(name, bracket()));
      }
    return std::nullopt;
  }

  double exists() {
    if (!cursor_.take_if('#') || !cursor_.take_if('<')) cursor_.fail("EXISTS needs a name: EXISTS[#<name>]");
    const std::string name = cursor_.name();
    if (!cursor_.take_if(']')) cursor_.fail("an expression that is not closed by ]");
    return parameters_.exists(name) ? 1 : 0;
  }

  double arc_tangent() {
    const double y = bracket();
    if (!cursor_.take_if('/') || !cursor_.take_if('[')) cursor_.fail("ATAN takes two values: ATAN[y]/[x]");
    return base::atan2(y, bracket()) / kDegree;
  }

  double of(std::string_view name, double x) {
    const auto need = [&](bool good) {
      if (!good) cursor_.fail(std::string(name) + " of a number for which it has no value");
    };
    if (name == "ABS") return std::abs(x);
    if (name == "ACOS") return need(std::abs(x) <= 1), base::acos(x) / kDegree;
    if (name == "ASIN") return need(std::abs(x) <= 1), base::asin(x) / kDegree;
    if (name == "COS") return base::cos(x * kDegree);
    if (name == "EXP") return base::exp(x);
    if (name == "FIX") return std::floor(x);
    if (name == "FUP") return std::ceil(x);
    if (name == "LN") return need(x > 0), base::log(x);
    if (name == "ROUND") return std::round(x);
    if (name == "SIN") return base::sin(x * kDegree);
    if (name == "SQRT") return need(x >= 0), std::sqrt(x);
    return base::tan(x * kDegree);
  }

  NcCursor& cursor_;
  const NcParameters& parameters_;
  const NcPlace& place_;
  int depth_ = 0;
  const Named* waiting_ = nullptr;
};

}  // namespace

double nc_value(NcCursor& cursor, const NcParameters& parameters, const NcPlace& place, char what) {
  return Evaluator(cursor, parameters, place).value(what);
}

void nc_assignment(NcCursor& cursor, NcParameters& parameters, const NcPlace& place) {
  Evaluator evaluator(cursor, parameters, place);
  const auto key = evaluator.key();
  if (!cursor.take_if('=')) cursor.fail("expected = after a parameter");
  const double value = evaluator.value('=');
  if (const int* number = std::get_if<int>(&key))
    parameters.assign(*number, value, place);
  else
    parameters.assign(std::get<std::string>(key), value, place);
}

}  // namespace riffler::nc
