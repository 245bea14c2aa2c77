// Text of a Heidenhain conversational program → blocks, labels and the numbers of tools that are called by name.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nc/source.hpp"

namespace riffler::nc {

/// Whether a text is such a program: BEGIN PGM stands in its first block.
bool begins_heidenhain(NcSource& source);

struct HeidenhainBlock {
  int line = 0;           ///< where it begins, 1-based
  bool optional = false;  ///< behind a /
  std::string_view text;  ///< without its number, up to the end of the last of its lines
  /// Of a tool, as the comments right before the block have it ("D=10", "DM=10"); 0: they have none, or several.
  double diameter = 0;
};

class HeidenhainText {
 public:
  /// Keeps `text`. Blocks end with END PGM. `place` is where it is, for messages: FormatError for labels that are set
  /// twice, and for a line that ends with ~ at the end of the text.
  HeidenhainText(std::string_view text, NcPlace& place);

  std::size_t size() const { return blocks_.size(); }
  const HeidenhainBlock& operator[](std::size_t k) const { return blocks_[k]; }

  /// The block of the label `name` ("1", or "NAME" without quotes).
  std::optional<std::size_t> label(const std::string& name) const;
  /// Tools that the program calls by name get the numbers after those that it calls by number.
  int tool_number(const std::string& name) const;
  /// As a list of tools in comments has it ("#3 D=10"); 0: not there.
  double diameter(int tool) const;

 private:
  void add(HeidenhainBlock block, NcPlace& place);
  void read_comment(std::string_view text);

  std::vector<HeidenhainBlock> blocks_;
  std::map<std::string, std::size_t, std::less<>> labels_;
  std::vector<std::string> tool_names_;
  std::map<int, double> diameters_;
  double diameter_ = 0;  // in the comments before the block to come; −1: several
  int last_tool_ = 0;
};

}  // namespace riffler::nc
