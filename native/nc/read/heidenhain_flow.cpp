// Labels and jumps, Q parameters and the FN functions of Heidenhain programs.
#include <algorithm>
#include <cmath>
#include <string>

#include "nc/limits.hpp"
#include "nc/read/heidenhain_interpreter.hpp"

namespace riffler::nc {

namespace {

constexpr std::size_t kMaxCalls = 100;
/// Values that differ by less are equal, which covers differences to the control's own arithmetic.
constexpr double kEqual = 1e-9;

}  // namespace

/// CALL LBL n calls a subprogram; with REP it repeats the program from the label to here.
void HeidenhainInterpreter::call(HeidenhainCursor& cursor) {
  if (!cursor.take_word("LBL"))
    place_.fail("a call of another program is not read: paste it in as a label (LBL), and call that");
  const std::string name = label_name(cursor);
  const std::size_t here = next_ - 1;
  if (!cursor.take_word("REP")) {
    expect_end(cursor);
    if (calls_.size() >= kMaxCalls) place_.fail("subprograms are nested too deeply");
    const std::size_t back = next_;
    jump(name);
    calls_.push_back(back);
    return;
  }
  const double times = values_.value(cursor, "REP");
  if (cursor.take_if('/')) values_.value(cursor, "REP");  // remaining count, as shown on the control's screen
  expect_end(cursor);
  if (!(times >= 0 && times <= kMaxNumber && times == std::floor(times))) place_.fail("REP takes a whole number");
  const auto [left, first] = left_.emplace(here, static_cast<int>(times));
  if (left->second == 0) {
    left_.erase(left);
    return;
  }
  --left->second;
  jump(name);
}

void HeidenhainInterpreter::label(HeidenhainCursor& cursor) {
  const std::string name = label_name(cursor);
  if (name != "0" || calls_.empty()) return;
  next_ = calls_.back();
  calls_.pop_back();
}

std::string HeidenhainInterpreter::label_name(HeidenhainCursor& cursor) {
  if (cursor.peek() == '"') return cursor.quoted();
  const double number = cursor.peek() == 'Q' ? values_.value(cursor, "LBL") : cursor.number("LBL");
  if (!(number >= 0 && number <= kMaxNumber && number == std::floor(number))) place_.fail("LBL takes a whole number");
  return std::to_string(static_cast<int>(number));
}

void HeidenhainInterpreter::jump(const std::string& name) {
  if (corner_) place_.fail("a jump behind RND or CHF, before the line after it");
  const std::optional<std::size_t> to = text_->label(name);
  if (!to) place_.fail("there is no LBL " + name);
  if (++turns_ > max_turns_)
    place_.fail(std::string("the program jumps more than ") + std::to_string(static_cast<long long>(max_turns_)) +
                " times: it seems endless; option max_turns allows more");
  next_ = *to;
}

void HeidenhainInterpreter::assign(HeidenhainCursor& cursor) {
  const int key = values_.name(cursor);
  if (!cursor.take_if('=')) cursor.fail("a parameter without =");
  values_.set(key, values_.formula(cursor));
  expect_end(cursor);
}

void HeidenhainInterpreter::function(HeidenhainCursor& cursor) {
  const double given = cursor.number("FN");
  const int number = given <= 99 ? static_cast<int>(given) : 99;
  cursor.take_if(':');
  switch (number) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
    case 7:
    case 8:
    case 13:
      return assign(cursor);
    case 9:
    case 10:
    case 11:
    case 12:
      return condition(number, cursor);
    case 14:
      place_.fail(
          "FN 14 stops the program with a message of its own: what it checks is not met, or set by another program");
    case 15:
    case 16:
    case 20:
    case 38:
      return;  // output, wait, send
    case 18:
    case 28:  // values from the control or its tables
      if (!(cursor.take_word("SYSREAD") || cursor.take_word("TABREAD"))) cursor.fail_unexpected();
      if (cursor.peek() == 'Q') values_.set(values_.name(cursor), std::nullopt);
      return;
    default:
      place_.fail(std::string("FN ") + std::to_string(number) +
                  " is not read: it acts on the control's own data; take it out");
  }
}

void HeidenhainInterpreter::condition(int number, HeidenhainCursor& cursor) {
  if (!cursor.take_word("IF")) cursor.fail_unexpected();
  const double a = values_.value(cursor, "IF");
  bool holds = false;
  static constexpr std::string_view kRelations[] = {"EQU", "NE", "GT", "LT"};
  if (!cursor.take_word(kRelations[number - 9])) cursor.fail_unexpected();
  const double b = values_.value(cursor, "IF");
  const bool equal = std::abs(a - b) <= kEqual * std::max({1.0, std::abs(a), std::abs(b)});
  switch (number) {
    case 9:
      holds = equal;
      break;
    case 10:
      holds = !equal;
      break;
    case 11:
      holds = a > b && !equal;
      break;
    default:
      holds = a < b && !equal;
  }
  if (!cursor.take_word("GOTO LBL")) cursor.fail_unexpected();
  const std::string name = label_name(cursor);
  expect_end(cursor);
  if (holds) jump(name);
}

}  // namespace riffler::nc
