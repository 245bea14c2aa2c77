#include "nc/read/notes.hpp"

#include <algorithm>

namespace riffler::nc {

namespace {

bool is_skipped(std::string_view kind) {
  return kind == "skipped" || kind == "coordinates";
}

}  // namespace

void NoteList::add(std::string_view kind, int line, const std::string& message) {
  constexpr std::ptrdiff_t kMaxAlike = 20;
  if (std::ranges::count(notes_, kind, &Note::kind) < kMaxAlike)
    notes_.push_back({std::string(kind), line, message});
  else if (is_skipped(kind))
    ++more_skipped_;
}

Provenance NoteList::provenance(const std::string& source) const {
  Provenance out{{"source", source}};
  std::string skipped, others;
  for (const Note& n : notes_) {
    if (n.kind == "units" || n.kind == "rapid") continue;
    std::string& text = is_skipped(n.kind) ? skipped : others;
    text.append(text.empty() ? "line " : "; line ").append(std::to_string(n.line)).append(": ").append(n.message);
  }
  if (more_skipped_ > 0) skipped.append("; and ").append(std::to_string(more_skipped_)).append(" more");
  if (!skipped.empty()) out.emplace_back("skipped", skipped);
  if (!others.empty()) out.emplace_back("notes", others);
  return out;
}

}  // namespace riffler::nc
