#include "nc/read/sinumerik_text.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "nc/read/cursor.hpp"
#include "nc/read/sinumerik_cursor.hpp"

namespace riffler::nc {

namespace {

using Keyword = SinumerikKeyword;

struct KeywordName {
  std::string_view name;
  Keyword keyword;
};
constexpr KeywordName kStructures[] = {
    {"IF", Keyword::If},         {"ELSE", Keyword::Else},         {"ENDIF", Keyword::EndIf},
    {"WHILE", Keyword::While},   {"ENDWHILE", Keyword::EndWhile}, {"FOR", Keyword::For},
    {"ENDFOR", Keyword::EndFor}, {"LOOP", Keyword::Loop},         {"ENDLOOP", Keyword::EndLoop},
    {"REPEAT", Keyword::Repeat}, {"UNTIL", Keyword::Until},
};

/// Whether one of its words is a jump.
bool has_jump(SinumerikCursor cursor) {
  while (const char c = cursor.peek()) {
    if (c == '"') {
      cursor.quoted();
    } else if (const std::string name = cursor.name(); !name.empty()) {
      if (name.starts_with("GOTO")) return true;
    } else {
      cursor.take();
    }
  }
  return false;
}

/// Lines that are no blocks: the name of a program, "%_N_NAME_MPF", or "%" with a number.
std::optional<std::string> header_name(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == line.npos || line[first] != '%') return std::nullopt;
  line.remove_prefix(first + 1);
  const std::size_t last = line.find_last_not_of(" \t\r");
  return sinumerik_name(last == line.npos ? "" : line.substr(line.find_first_not_of(" \t"), last + 1));
}

class Routines {
 public:
  Routines(std::string_view text, NcPlace& place) : source_(text, place.file), place_(place) {}

  std::vector<SinumerikRoutine> read() {
    begin(sinumerik_name(place_.file));
    std::string_view line;
    while (source_.next(line)) {
      place_.line = source_.line(), place_.text = line;
      if (const auto name = header_name(line)) {
        if (!routines_.back().blocks.empty())
          begin(*name);
        else if (!name->empty())
          routines_.back().name = *name;
        continue;
      }
      add(line);
    }
    end();
    return std::move(routines_);
  }

 private:
  void begin(const std::string& name) {
    if (!routines_.empty()) end();
    routines_.push_back({name, place_.file, {}, {}, nullptr});
  }

  void end() {
    if (open_.empty()) return;
    const SinumerikBlock& block = routines_.back().blocks[open_.back()];
    place_.line = block.line, place_.text = block.text;
    place_.fail("a control structure that is not ended (ENDIF, ENDWHILE, ENDFOR, ENDLOOP, UNTIL)");
  }

  void add(std::string_view line) {
    SinumerikBlock block{place_.line, false, line};
    const auto skip = [&](std::string_view what) {
      const std::size_t first = block.text.find_first_not_of(what);
      block.text.remove_prefix(std::min(first, block.text.size()));
    };
    skip(" \t");
    if (block.text.starts_with('/')) {
      block.optional = true;
      block.text.remove_prefix(1);
      skip("0123456789");  // one of ten skip levels
      skip(" \t");
    }
    std::vector<std::string> labels;
    take_number(block, labels);
    take_label(block, labels);
    SinumerikCursor cursor(block.text, place_);
    if (cursor.take_word("PROC")) {
      const std::string name = cursor.name();
      if (!routines_.back().blocks.empty()) begin(name);
      routines_.back().name = name;
    }
    SinumerikRoutine& routine = routines_.back();
    for (const std::string& label : labels) routine.labels[label].push_back(routine.blocks.size());
    if (SinumerikCursor(block.text, place_).peek() == '\0' && labels.empty()) return;
    link(block);
    routine.blocks.push_back(block);
  }

  /// "N10", or ":10" for a main block.
  static void take_number(SinumerikBlock& block, std::vector<std::string>& labels) {
    const std::string_view text = block.text;
    if (text.size() < 2 || (NcCursor::upper(text[0]) != 'N' && text[0] != ':') || !NcCursor::is_digit(text[1])) return;
    std::size_t end = 1;
    while (end < text.size() && NcCursor::is_digit(text[end])) ++end;
    labels.push_back(std::string(1, NcCursor::upper(text[0])).append(text.substr(1, end - 1)));
    end = std::min(text.find_first_not_of(" \t", end), text.size());
    block.text = text.substr(end);
  }

  void take_label(SinumerikBlock& block, std::vector<std::string>& labels) const {
    const std::size_t end = block.text.find_first_of(":;\"=(");
    if (end == block.text.npos || block.text[end] != ':') return;
    SinumerikCursor cursor(block.text.substr(0, end), place_);
    const std::string name = cursor.name();
    if (name.empty() || cursor.peek() != '\0') return;
    labels.push_back(name);
    block.text.remove_prefix(end + 1);
  }

  void link(SinumerikBlock& block) {
    SinumerikCursor cursor(block.text, place_);
    const std::string word = cursor.name();
    const auto found = std::ranges::find(kStructures, word, &KeywordName::name);
    if (found == std::end(kStructures)) return;
    if (found->keyword == Keyword::If && has_jump(cursor)) return;
    if (found->keyword == Keyword::Repeat && cursor.peek() != '\0') return;  // repeats a part between labels
    block.keyword = found->keyword;
    std::vector<SinumerikBlock>& blocks = routines_.back().blocks;
    const std::size_t here = blocks.size();
    const auto closes = [&](std::initializer_list<Keyword> openers) {
      if (open_.empty() || std::ranges::find(openers, blocks[open_.back()].keyword) == openers.end())
        place_.fail(word + " without what it ends");
      blocks[open_.back()].partner = here, block.partner = open_.back();
      open_.pop_back();
    };
    switch (block.keyword) {
      case Keyword::Else:
        closes({Keyword::If});
        open_.push_back(here);
        break;
      case Keyword::EndIf:
        closes({Keyword::If, Keyword::Else});
        break;
      case Keyword::EndWhile:
        closes({Keyword::While});
        break;
      case Keyword::EndFor:
        closes({Keyword::For});
        break;
      case Keyword::EndLoop:
        closes({Keyword::Loop});
        break;
      case Keyword::Until:
        closes({Keyword::Repeat});
        break;
      default:
        open_.push_back(here);
    }
  }

  NcSource source_;
  NcPlace& place_;
  std::vector<SinumerikRoutine> routines_;
  std::vector<std::size_t> open_;  // open control structures, by block
};

}  // namespace

bool begins_sinumerik(NcSource& source) {
  constexpr int kLines = 5;
  const NcSource::Mark start = source.mark();
  std::string_view line;
  bool begins = false;
  for (int k = 0; k < kLines && !begins && source.next(line); ++k)
    begins = line.starts_with("%_N_") || line.starts_with(";$PATH=");
  source.go(start);
  return begins;
}

std::string sinumerik_name(std::string_view name) {
  std::string out;
  for (const char c : name) out += NcCursor::upper(c);
  if (out.starts_with("_N_")) out.erase(0, 3);
  for (const std::string_view end : {"_SPF", "_MPF", ".SPF", ".MPF"})
    if (out.ends_with(end)) {
      out.erase(out.size() - end.size());
      break;
    }
  return out;
}

std::vector<SinumerikRoutine> sinumerik_routines(std::string_view text, NcPlace& place) {
  return Routines(text, place).read();
}

}  // namespace riffler::nc
