// Contact of a cutter with the material of a volume that changes, such as a stock between two strokes.
#pragma once

#include <cstddef>

#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::collide {

/// Sums the contact from the rays under the tool, without prepared data, so the next query feels the surface that a cut
/// has just left. Shank and holder do not touch, as they do not cut. No function allocates or waits.
class StockContact {
 public:
  /// The most boxes of material that one query looks at.
  static constexpr std::size_t kMostBoxes = 16384;

  explicit StockContact(const Tool& tool);

  /// What a query found.
  struct Overlap {
    double volume = 0;      ///< mm³ of material inside the cutter
    double area = 0;        ///< mm² of the cutter's surface in the material
    bool complete = true;   ///< false: there were more than kMostBoxes, and the sums are of some of them
    std::size_t boxes = 0;  ///< boxes looked at

    /// Mean depth of the material in the cutter, mm; 0 without contact.
    double depth() const { return area > 0 ? volume / area : 0; }
  };

  /// Adds to `contact` the force of the material inside the cutter at `pose`: `stiffness` (N/mm³) times its volume,
  /// against the normal of the cutter's surface nearest to it; the torque about the tip; and the stiffness. Each ray
  /// counts as a column as wide as its cell, so that a wall along the rays pushes evenly, too. Where there are three
  /// grids, each counts with the square of the normal's component along its rays: the rays that meet a face squarely
  /// locate it best. The force is continuous in the pose, and nearly the gradient of
  /// ∫ stiffness · depth dV, so a closed path gives almost no work. Throws std::invalid_argument for a pose whose tip
  /// is not finite or whose axis is not of unit length (within 1e-6).
  Overlap add(const Volume& stock, const Pose& pose, double stiffness, Contact& contact) const;

 private:
  Assembly cutter_;
  double radius_, length_;  // mm: of a cylinder about the axis that holds the cutter
  double flat_;             // mm: the cutter's surface is nearly flat across boxes up to this half side
};

}  // namespace riffler::collide
