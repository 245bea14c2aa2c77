// Text of a Sinumerik program → routines (the main program, and subprograms in the same file), blocks, labels, and
// where control structures end.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/source.hpp"

namespace riffler::nc {

/// Whether a text says that it is such a program: its first lines have "%_N_..." or ";$PATH=".
bool begins_sinumerik(NcSource& source);

enum class SinumerikKeyword : std::uint8_t {
  None,
  If,
  Else,
  EndIf,
  While,
  EndWhile,
  For,
  EndFor,
  Loop,
  EndLoop,
  Repeat,
  Until,
};

struct SinumerikBlock {
  int line = 0;           ///< 1-based
  bool optional = false;  ///< behind a /
  std::string_view text;  ///< without its number and label
  /// Of a control structure. An IF with a jump in its block is none.
  SinumerikKeyword keyword = SinumerikKeyword::None;
  /// The block in which that part of the structure ends: of IF its ELSE or ENDIF, of ELSE its ENDIF, of a loop's first
  /// block its last, and of that the first.
  std::size_t partner = 0;
};

struct SinumerikRoutine {
  std::string name;  ///< upper case, without _N_ and _SPF
  std::string file;  ///< base name
  std::vector<SinumerikBlock> blocks;
  /// Labels, and numbers of blocks ("N100"), with the blocks that have them.
  std::map<std::string, std::vector<std::size_t>, std::less<>> labels;
  std::shared_ptr<const std::string> text;  ///< of a file of its own
};

/// The routines of a text, the main program first. Keeps `text`. `place` is where it is, for messages: FormatError for
/// control structures that do not pair.
std::vector<SinumerikRoutine> sinumerik_routines(std::string_view text, NcPlace& place);

/// "_N_HOLE_SPF", "hole.spf" → "HOLE".
std::string sinumerik_name(std::string_view name);

}  // namespace riffler::nc
