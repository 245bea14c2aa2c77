#include "nc/number_text.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace riffler::nc {

namespace {

constexpr std::int64_t kScale[] = {1,       10,        100,        1000,        10'000,
                                   100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

}  // namespace

std::int64_t ticks(double value, int decimals) {
  return std::llround(value * static_cast<double>(kScale[decimals]));
}

void put_ticks(std::string& out, std::int64_t value, int decimals, bool trim) {
  if (value < 0) out += '-';
  const std::int64_t size = std::abs(value), scale = kScale[decimals];
  char digits[24];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, size / scale).ptr);
  std::int64_t rest = size % scale;
  if (decimals == 0 || (trim && rest == 0)) return;
  out += '.';
  const std::size_t begin = out.size();
  out.resize(begin + static_cast<std::size_t>(decimals));
  for (int k = decimals; k-- > 0; rest /= 10)
    out[begin + static_cast<std::size_t>(k)] = static_cast<char>('0' + rest % 10);
  if (trim) out.erase(out.find_last_not_of('0') + 1);
}

std::string number_text(double value, int decimals) {
  if (!(std::abs(value) < 1e9)) return "out of range";  // only sizes in comments can be this large
  std::string out;
  put_ticks(out, ticks(value, decimals), decimals, true);
  return out;
}

std::string plain(std::string_view text) {
  constexpr std::size_t kLongest = 200;
  std::string out;
  for (const char c : text.substr(0, kLongest)) {
    const bool ascii = c >= ' ' && c <= '~';
    out += c == '(' ? '[' : c == ')' ? ']' : ascii ? c : '?';
  }
  return out;
}

}  // namespace riffler::nc
