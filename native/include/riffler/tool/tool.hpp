// A tool: its cutter's profile, from which everything else follows, and the shank and holder above it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "riffler/tool/piece.hpp"
#include "riffler/tool/profile.hpp"

namespace riffler::tool {

/// What part of the assembly a piece belongs to; only the cutter removes material.
enum class Part : unsigned char { Cutter, Shank, Holder };

struct ToolPiece {
  Part part;
  Piece piece;
};

/// Immutable after construction. Lengths in mm from the tip; `length` includes the rounded or conical end.
class Tool {
 public:
  /// A cutter from its profile. `kind` and `parameters` are what the JSON form keeps ("ball", diameter, …).
  Tool(std::string kind, std::vector<std::pair<std::string, double>> parameters, Profile profile);

  Tool with_shank(const std::vector<Frustum>& pieces) const;
  Tool with_holder(const std::vector<Frustum>& pieces) const;
  /// The same with wider shank and holder, to be kept clear of what the cutter touches: sides moved out by so many mm
  /// along their normals, and the ends of the holder's pieces along the axis.
  Tool with_margins(double shank, double holder) const;
  Tool named(std::string name) const;

  const std::string& name() const { return name_; }
  const std::string& kind() const { return kind_; }
  const std::vector<std::pair<std::string, double>>& parameters() const { return parameters_; }
  const Profile& profile() const { return profile_; }
  double diameter() const { return 2 * profile_.max_radius(); }
  double length() const { return profile_.length(); }

  /// The cutter's convex pieces from the tip upwards, and those of shank and holder.
  const std::vector<Piece>& cutter() const { return cutter_; }
  const std::vector<Frustum>& shank() const { return shank_; }
  const std::vector<Frustum>& holder() const { return holder_; }
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
