// Splits a Heidenhain program into blocks, labels and the numbers of tools called by name.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/source.hpp"

namespace riffler::nc {

/// Whether a text is a Heidenhain program: its first block contains BEGIN PGM.
bool begins_heidenhain(NcSource& source);

struct HeidenhainBlock {
  int line = 0;           ///< line at which it begins, 1-based
  bool optional = false;  ///< marked with /
  std::string_view text;  ///< without its number, up to the end of its last line
  /// Tool diameter (mm) from comments directly before the block ("D=10", "DM=10"); 0: none, or several.
  double diameter = 0;
};

class HeidenhainText {
 public:
  /// Keeps a reference to `text`. Blocks end with END PGM. `place` is the position for messages. Throws FormatError for
  /// a label set twice, and for a line ending in ~ at the end of the text.
  HeidenhainText(std::string_view text, NcPlace& place);

  std::size_t size() const { return blocks_.size(); }
  const HeidenhainBlock& operator[](std::size_t k) const { return blocks_[k]; }

  /// The block of the label `name` ("1", or "NAME" without quotes).
  std::optional<std::size_t> label(const std::string& name) const;
  /// Tools called by name get the numbers after those of tools called by number.
  int tool_number(const std::string& name) const;
  /// Diameter (mm) from a tool list in comments ("#3 D=10"); 0: not listed.
  double diameter(int tool) const;

 private:
  void add(HeidenhainBlock block, NcPlace& place);
  void read_comment(std::string_view text);

  std::vector<HeidenhainBlock> blocks_;
  std::map<std::string, std::size_t, std::less<>> labels_;
  std::vector<std::string> tool_names_;
  std::map<int, double> diameters_;
  double diameter_ = 0;  // from the comments before the next block; −1: several
  int last_tool_ = 0;
};

}  // namespace riffler::nc
