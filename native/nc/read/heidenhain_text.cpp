#include "nc/read/heidenhain_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "nc/limits.hpp"
#include "nc/read/heidenhain_cursor.hpp"

namespace riffler::nc {

namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == text.npos ? std::string_view() : text.substr(first, last - first + 1);
}

/// The block without the leading / and its number.
HeidenhainBlock block_of(std::string_view line, int number) {
  HeidenhainBlock block{number, false, without_blanks(line)};
  if (block.text.starts_with('/')) block.optional = true, block.text = without_blanks(block.text.substr(1));
  const std::size_t digits = block.text.find_first_not_of("0123456789");
  block.text = without_blanks(block.text.substr(std::min(digits, block.text.size())));
  if (block.text.starts_with('/')) block.optional = true, block.text = without_blanks(block.text.substr(1));
  return block;
}

/// Comments, structure headings, and comments in G code style.
bool is_comment(std::string_view text) {
  return text.empty() || text[0] == ';' || text[0] == '*' || text[0] == '(';
}

}  // namespace

bool begins_heidenhain(NcSource& source) {
  const NcSource::Mark start = source.mark();
  std::string_view line;
  bool begins = false;
  while (source.next(line)) {
    const std::string_view text = block_of(line, 0).text;
    if (is_comment(text)) continue;
    const NcPlace place{source.name(), source.line(), line};
    HeidenhainCursor cursor(text, place);
    begins = cursor.take_word("BEGIN PGM");
    break;
  }
  source.go(start);
  return begins;
}

HeidenhainText::HeidenhainText(std::string_view text, NcPlace& place) {
  NcSource source(text, place.file);
  std::string_view line;
  while (source.next(line)) {
    HeidenhainBlock block = block_of(line, source.line());
    place.line = block.line, place.text = line;
    bool more = without_blanks(line).ends_with('~');
    while (more) {
      if (!source.next(line)) place.fail("the text ends after a ~, which continues the block");
      more = without_blanks(line).ends_with('~');
      block.text = {block.text.data(), static_cast<std::size_t>(line.data() + line.size() - block.text.data())};
    }
    if (is_comment(block.text)) {
      read_comment(block.text);
      continue;
    }
    add(block, place);
    HeidenhainCursor cursor(block.text, place);
    if (cursor.take_word("END PGM")) break;
  }
}

/// A tool's diameter, as CAM systems write it in comments above TOOL CALL or, after the tool's number, in a list.
void HeidenhainText::read_comment(std::string_view text) {
  std::size_t at = text.find("D=");
  std::size_t number = at + 2;
  if (at == text.npos) at = text.find("DM="), number = at + 3;
  if (at == text.npos || (at > 0 && NcCursor::is_letter(text[at - 1]))) return;
  if (text.substr(number).starts_with('+')) ++number;
  double diameter = 0;
  std::from_chars(text.data() + number, text.data() + text.size(), diameter);
  if (!(diameter > 0 && diameter <= kMaxLength)) return;
  diameter_ = diameter_ == 0 || diameter_ == diameter ? diameter : -1;
  int tool = 0;
  const std::size_t hash = text.find('#');
  if (hash < at && std::from_chars(text.data() + hash + 1, text.data() + at, tool).ec == std::errc())
    diameters_.emplace(tool, diameter);
}

double HeidenhainText::diameter(int tool) const {
  const auto found = diameters_.find(tool);
  return found == diameters_.end() ? 0 : found->second;
}

void HeidenhainText::add(HeidenhainBlock block, NcPlace& place) {
  block.diameter = std::max(diameter_, 0.0);
  diameter_ = 0;
  HeidenhainCursor cursor(block.text, place);
  if (cursor.take_word("LBL")) {
    std::string name;
    if (cursor.peek() == '"')
      name = cursor.quoted();
    else if (cursor.at_number())
      name = std::to_string(static_cast<long long>(std::min(cursor.number("LBL"), double{kMaxNumber})));
    if (!name.empty() && name != "0" && !labels_.emplace(name, blocks_.size()).second)
      place.fail("LBL " + name + " is set twice");
  } else if (cursor.take_word("TOOL CALL")) {
    if (cursor.peek() == '"') {
      const std::string name = cursor.quoted();
      if (std::ranges::find(tool_names_, name) == tool_names_.end()) tool_names_.push_back(name);
    } else if (cursor.at_number()) {
      last_tool_ = std::max(last_tool_, static_cast<int>(std::min(cursor.number("TOOL CALL"), double{kMaxNumber})));
    }
  }
  blocks_.push_back(block);
}

std::optional<std::size_t> HeidenhainText::label(const std::string& name) const {
  const auto found = labels_.find(name);
  return found == labels_.end() ? std::nullopt : std::optional(found->second);
}

int HeidenhainText::tool_number(const std::string& name) const {
  const auto at = std::ranges::find(tool_names_, name);
  const auto number = last_tool_ + 1 + (at - tool_names_.begin());
  return static_cast<int>(std::min<std::ptrdiff_t>(number, kMaxNumber));
}

}  // namespace riffler::nc
