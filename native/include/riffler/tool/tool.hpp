// A tool: a cutter, defined by its profile, with the shank and holder above it; or a hand tool, a union of convex
// bodies.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "riffler/tool/hull.hpp"
#include "riffler/tool/piece.hpp"
#include "riffler/tool/profile.hpp"

namespace riffler::tool {

/// The part of the tool that a piece belongs to. Only the cutter removes material.
enum class Part : unsigned char { Cutter, Shank, Holder };

/// One convex piece of a tool.
struct ToolPiece {
  Part part;
  Piece piece;
};

/// Immutable after construction. Lengths are in mm, heights are measured from the tip; `length` includes the rounded or
/// conical end.
class Tool {
 public:
  /// Makes a cutter from its profile. `kind` and `parameters` are stored for the JSON form ("ball", diameter, …).
  Tool(std::string kind, std::vector<std::pair<std::string, double>> parameters, Profile profile);
  /// Makes a hand tool, the union of convex bodies (hand_tools.hpp). It has no profile, shank or holder.
  Tool(std::string kind, std::vector<std::pair<std::string, double>> parameters, std::vector<Hull> hulls);

  /// Whether the tool is a body of revolution about its axis: all but hand tools are.
  bool revolved() const { return !hulls_; }
  /// The convex bodies of a hand tool; none of others.
  const std::vector<Hull>& hulls() const;
  /// Throws std::invalid_argument for a hand tool, naming `who` cannot use it, the tool, and what can be used instead.
  /// What needs a profile or pieces need not call it: `profile`, `cutter` and `assembly` do.
  void require_revolved(std::string_view who) const;

  /// Copies with this shank or holder; heights in mm from the tip. Throw std::invalid_argument naming the bad piece,
  /// and for hand tools.
  Tool with_shank(const std::vector<Frustum>& pieces) const;
  Tool with_holder(const std::vector<Frustum>& pieces) const;
  /// A copy with a wider shank and holder, for keeping them clear of what the cutter touches. Moves the sides out by
  /// this many mm along their normals, and the ends of the holder's pieces along the axis.
  Tool with_margins(double shank, double holder) const;
  /// A copy with this name.
  Tool named(std::string name) const;

  const std::string& name() const { return name_; }
  const std::string& kind() const { return kind_; }
  const std::vector<std::pair<std::string, double>>& parameters() const { return parameters_; }
  /// Throws std::invalid_argument for hand tools.
  const Profile& profile() const;
  /// Largest diameter of the cutter (of a hand tool: about its axis), and height of its upper end above the tip, mm.
  double diameter() const;
  double length() const;

  /// The cutter's convex pieces, from the tip upwards. Throws std::invalid_argument for hand tools.
  const std::vector<Piece>& cutter() const;
  /// The pieces of shank and holder; heights are measured from the tip.
  const std::vector<Frustum>& shank() const { return shank_; }
  const std::vector<Frustum>& holder() const { return holder_; }
  /// All pieces: cutter, shank, holder. Throws std::invalid_argument for hand tools.
  std::vector<ToolPiece> assembly() const;

 private:
  std::string name_, kind_;
  std::vector<std::pair<std::string, double>> parameters_;
  std::optional<Profile> profile_;                  // of all but hand tools
  std::shared_ptr<const std::vector<Hull>> hulls_;  // of hand tools
  std::vector<Piece> cutter_;
  std::vector<Frustum> shank_, holder_;
};

}  // namespace riffler::tool

namespace riffler {
using tool::Tool;
}  // namespace riffler
