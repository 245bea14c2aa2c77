// Splits the text of a Sinumerik program into routines (the main program and subprograms in the same file), blocks and
// labels, and pairs control structures.
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

/// Whether a text is marked as a Sinumerik program: its first lines contain "%_N_..." or ";$PATH=".
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
  bool optional = false;  ///< marked with /
  std::string_view text;  ///< without its number and label
  /// Keyword of a control structure. An IF with a jump in its block is none.
  SinumerikKeyword keyword = SinumerikKeyword::None;
  /// The block that ends this part of the structure: for IF its ELSE or ENDIF, for ELSE its ENDIF, for the first block
  /// of a loop the last, and for the last the first.
  std::size_t partner = 0;
};

struct SinumerikRoutine {
  std::string name;  ///< upper case, without _N_ and _SPF
  std::string file;  ///< base name
  std::vector<SinumerikBlock> blocks;
  /// Labels and block numbers ("N100") with the blocks that have them.
  std::map<std::string, std::vector<std::size_t>, std::less<>> labels;
  std::shared_ptr<const std::string> text;  ///< text of a separate file
};

/// The routines of a text, the main program first. Keeps a reference to `text`. `place` is the position for messages.
/// Throws FormatError for control structures that do not pair.
std::vector<SinumerikRoutine> sinumerik_routines(std::string_view text, NcPlace& place);

/// "_N_HOLE_SPF", "hole.spf" → "HOLE".
std::string sinumerik_name(std::string_view name);

}  // namespace riffler::nc
