#include "nc/read/o_word.hpp"

#include <algorithm>
#include <utility>

#include "nc/read/cursor.hpp"

namespace riffler::nc {

namespace {

constexpr std::pair<std::string_view, NcKeyword> kKeywords[] = {
    {"", NcKeyword::None},
    {"SUB", NcKeyword::Sub},
    {"ENDSUB", NcKeyword::EndSub},
    {"CALL", NcKeyword::Call},
    {"RETURN", NcKeyword::Return},
    {"IF", NcKeyword::If},
    {"ELSEIF", NcKeyword::ElseIf},
    {"ELSE", NcKeyword::Else},
    {"ENDIF", NcKeyword::EndIf},
    {"WHILE", NcKeyword::While},
    {"ENDWHILE", NcKeyword::EndWhile},
    {"DO", NcKeyword::Do},
    {"REPEAT", NcKeyword::Repeat},
    {"ENDREPEAT", NcKeyword::EndRepeat},
    {"BREAK", NcKeyword::Break},
    {"CONTINUE", NcKeyword::Continue},
};

}  // namespace

std::optional<NcKeyword> nc_keyword(std::string_view text) {
  for (const auto& [name, keyword] : kKeywords)
    if (name == text) return keyword;
  return std::nullopt;
}

std::optional<NcOLine> nc_o_line(std::string_view line) {
  std::size_t at = 0;
  const auto blanks = [&] {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  };
  const auto digits = [&] {
    blanks();
    const std::size_t begin = at;
    while (at < line.size() && NcCursor::is_digit(line[at])) ++at;
    return line.substr(begin, at - begin);
  };
  const auto take = [&](char c) {
    blanks();
    if (at == line.size() || NcCursor::upper(line[at]) != c) return false;
    ++at;
    return true;
  };
  take('/');
  if (take('N')) digits();
  if (!take('O')) return std::nullopt;
  NcOLine out;
  if (take('<')) {
    for (; at < line.size() && line[at] != '>'; ++at)
      if (line[at] != ' ' && line[at] != '\t') out.label += NcCursor::lower(line[at]);
    if (at == line.size() || out.label.empty()) return std::nullopt;
    ++at;
  } else {
    std::string_view number = digits();
    if (number.empty()) return std::nullopt;
    number.remove_prefix(std::min(number.find_first_not_of('0'), number.size() - 1));
    out.label = number;
  }
  blanks();
  std::string word;
  for (; at < line.size() && NcCursor::is_letter(line[at]); ++at) word += NcCursor::upper(line[at]);
  const std::optional<NcKeyword> keyword = nc_keyword(word);
  if (!keyword) return std::nullopt;
  out.keyword = *keyword, out.rest = line.substr(at);
  return out;
}

}  // namespace riffler::nc
