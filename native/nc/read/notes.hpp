// Assumptions and omissions of a reader: notes of a program, also summarised in its provenance.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "riffler/nc/program.hpp"

namespace riffler::nc {

class NoteList {
 public:
  /// Adds a note; keeps a limited number of each kind.
  void add(std::string_view kind, int line, const std::string& message);
  const std::vector<Note>& notes() const { return notes_; }
  /// "source", and "skipped" and "notes" if there are any; notes on units and rapids appear only in notes().
  Provenance provenance(const std::string& source) const;

 private:
  std::vector<Note> notes_;
  std::size_t more_skipped_ = 0;
};

}  // namespace riffler::nc
