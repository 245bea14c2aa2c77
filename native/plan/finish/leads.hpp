// Leads of finishing: how the tool comes down to a piece, and leaves it.
#pragma once

#include <optional>
#include <vector>

#include "plan/finish/patterns.hpp"
#include "riffler/plan/drop.hpp"

namespace riffler::plan {

/// Finds arcs that begin and end pieces tangentially. An arc of a level curve lies next to the curve, that of any other
/// piece above its end; if the former does not fit, the latter is tried. An arc fits if the whole tool stays clear of
/// part and fixtures by a bound over its moves (FinishSurface::above), and if shank and holder stay clear of the stock
/// there and above it. The stock is that before the operation.
class Leads {
 public:
  /// `radius`: of the arcs, mm; 0: no arcs. `level`: whether the pieces are level curves. Keeps a reference to
  /// `surface`.
  Leads(const FinishSurface& surface, const Tool& tool, double radius, bool level, const Mesh& stock);

  /// The tips from the beginning of an arc up to the first tip of a piece, without it; empty if no arc fits.
  std::vector<Vec3> in(const CutPiece& piece) const { return arc(piece.tips, false); }
  /// The tips after the last tip of a piece, up to the end of an arc; empty if no arc fits.
  std::vector<Vec3> out(const CutPiece& piece) const;

 private:
  std::vector<Vec3> arc(const std::vector<Vec3>& tips, bool reversed) const;
  bool fits(const std::vector<Vec3>& arc, const Vec3& end) const;

  const FinishSurface& surface_;
  double radius_, body_height_ = 0;
  bool level_;
  std::optional<DropCutter> body_;  // shank and holder over the stock
};

}  // namespace riffler::plan
