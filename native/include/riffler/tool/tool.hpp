// A tool: a cutter, defined by its profile, with the shank and holder above it.
#pragma once

#include <string>
#include <utility>
#include <vector>

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

  /// Copies with this shank or holder; heights in mm from the tip. Throw std::invalid_argument naming the bad piece.
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
  const Profile& profile() const { return profile_; }
  /// Largest diameter of the cutter, and height of its upper end above the tip, mm.
  double diameter() const { return 2 * profile_.max_radius(); }
  double length() const { return profile_.length(); }

  /// The cutter's convex pieces, from the tip upwards.
  const std::vector<Piece>& cutter() const { return cutter_; }
  /// The pieces of shank and holder; heights are measured from the tip.
  const std::vector<Frustum>& shank() const { return shank_; }
  const std::vector<Frustum>& holder() const { return holder_; }
  /// All pieces: cutter, shank, holder.
  std::vector<ToolPiece> assembly() const;

 private:
  std::string name_, kind_;
  std::vector<std::pair<std::string, double>> parameters_;
  Profile profile_;
  std::vector<Piece> cutter_;
  std::vector<Frustum> shank_, holder_;
};

}  // namespace riffler::tool

namespace riffler {
using tool::Tool;
}  // namespace riffler
