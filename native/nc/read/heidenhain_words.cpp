#include "nc/read/heidenhain_words.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "nc/machine/machine.hpp"

namespace riffler::nc {

namespace {

bool is_axis(char c) {
  return (c >= 'X' && c <= 'Z') || (c >= 'A' && c <= 'C');
}

}  // namespace

bool HeidenhainWords::has_code(int code) const {
  return std::ranges::find(codes, code) != codes.end();
}

void HeidenhainWords::read(HeidenhainCursor& cursor, HeidenhainValues& values, std::uint8_t kinds) {
  kinds_ = kinds;
  while (cursor.peek() != '\0') take_word(cursor, values);
}

void HeidenhainWords::take_coordinate(HeidenhainCoordinate& to, HeidenhainCursor& cursor, HeidenhainValues& values,
                                      std::string_view name, bool incremental) {
  if (to.given) cursor.fail("word " + std::string(name) + " twice");
  to = {values.value(cursor, name), true, incremental};
}

void HeidenhainWords::take_word(HeidenhainCursor& cursor, HeidenhainValues& values) {
  const auto next = [&](std::uint8_t kind, std::string_view word) { return (kinds_ & kind) && cursor.take_word(word); };
  const char c = cursor.peek();
  const std::string name(1, c);
  if (is_axis(c)) {
    cursor.take();
    return take_coordinate(axes[joint_index(c)], cursor, values, name, false);
  }
  if (c == '(') return cursor.skip_line();  // a comment in G code style
  if (c == 'I') {
    if (next(Polar, "IPR")) return take_coordinate(radius, cursor, values, "IPR", true);
    if (next(Polar, "IPA")) return take_coordinate(angle, cursor, values, "IPA", true);
    cursor.take();
    const char axis = cursor.peek();
    if (!is_axis(axis)) cursor.fail_unexpected();
    cursor.take();
    return take_coordinate(axes[joint_index(axis)], cursor, values, name + axis, true);
  }
  if (next(Polar, "PR")) return take_coordinate(radius, cursor, values, "PR", false);
  if (next(Polar, "PA")) return take_coordinate(angle, cursor, values, "PA", false);
  for (const char axis : {'X', 'Y', 'Z'}) {
    const char n[] = {'N', axis}, t[] = {'T', axis};
    if (next(Normal, {n, 2})) return take_coordinate(normal[joint_index(axis)], cursor, values, {n, 2}, false);
    if (next(ToolAxis, {t, 2})) return take_coordinate(tool[joint_index(axis)], cursor, values, {t, 2}, false);
  }
  if (next(Turning, "DR")) {
    if (cursor.take_if('+'))
      clockwise = false;
    else if (cursor.take_if('-'))
      clockwise = true;
    else
      cursor.fail("DR needs + or -");
    return;
  }
  if (c == 'R') return take_radius(cursor, values);
  if (c == 'F') return read_feed(cursor, values);
  if (c == 'M') return take_code(cursor, values);
  if (c == 'S') {
    cursor.take();
    speed = values.value(cursor, "S");
    return;
  }
  if ((kinds_ & Length) && (cursor.at_number() || c == 'Q')) {
    length = values.value(cursor, "the length");
    return;
  }
  if (c == 'U' || c == 'V' || c == 'W')
    cursor.fail("the axis " + name + " is not read: X Y Z A B C are; take it out, or write the moves for them");
  cursor.fail_unexpected();
}

/// R0, RL, RR, R+ and R− of the compensation; R with a number is an arc's radius if the block may have one.
void HeidenhainWords::take_radius(HeidenhainCursor& cursor, HeidenhainValues& values) {
  if (cursor.take_word("RL")) {
    compensation = 'L';
  } else if (cursor.take_word("RR")) {
    compensation = 'R';
  } else if (kinds_ & Radius) {
    cursor.take();
    const double value = values.value(cursor, "R");
    if (value == 0)
      compensation = '0';
    else
      arc_radius = value;
  } else {
    cursor.take();
    if (cursor.at_number()) {
      if (cursor.number("R") != 0) cursor.fail("R with a radius: it belongs to CR and RND");
      compensation = '0';
    } else if (cursor.take_if('+') || cursor.take_if('-')) {
      compensation = 'P';
    }
  }
}

void HeidenhainWords::read_feed(HeidenhainCursor& cursor, HeidenhainValues& values) {
  cursor.take();
  const bool of_m128 = !codes.empty() && codes.back() == 128 && feed == HeidenhainFeed::Unchanged;
  if (cursor.take_word("MAX")) {
    feed = HeidenhainFeed::Rapid;
  } else if (cursor.take_word("AUTO")) {
    feed = HeidenhainFeed::Auto;
  } else if (cursor.take_if('U')) {
    feed = HeidenhainFeed::PerTurn, feed_number = values.value(cursor, "FU");
  } else if (cursor.take_if('Z')) {
    cursor.fail("a feed per tooth (FZ) is not read: how many teeth the tool has is in the control's table; write F");
  } else if (cursor.at_number() || cursor.peek() == 'Q' || cursor.peek() == '+') {
    const double number = values.value(cursor, "F");
    // F after M128 limits the compensating motions.
    if (!of_m128) feed = HeidenhainFeed::Number, feed_number = number;
  } else if (cursor.peek() != '\0' && cursor.peek() != 'M') {
    cursor.fail_unexpected();
  }
}

void HeidenhainWords::take_code(HeidenhainCursor& cursor, HeidenhainValues& values) {
  cursor.take();
  if (cursor.take_if('B')) {
    retraction.given = true;
    if (cursor.take_word("MAX"))
      retraction.to_limit = true;
    else
      retraction.distance = values.value(cursor, "MB");
    return;
  }
  const double number = cursor.number("M");
  if (!(number <= 9999 && number == std::floor(number))) cursor.fail("there is no such M function");
  codes.push_back(static_cast<int>(number));
  if (codes.back() == 94)
    while (cursor.peek() >= 'A' && cursor.peek() <= 'C') {
      reduced.push_back(cursor.peek());
      cursor.take();
    }
  // M103 F, M118 X Y Z, M120 LA: words without effect on the tool path.
  if (codes.back() == 120 && cursor.take_word("LA")) values.value(cursor, "LA");
  if (codes.back() == 103 && cursor.take_if('F')) values.value(cursor, "F");
}

}  // namespace riffler::nc
