// The named cutters: a table of their shapes, and a function each for C++.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::tool {

enum class SizeUnit : unsigned char { Length, Angle, Flag };  ///< mm; rad; 0 or 1

/// One size of a shape. A size means the same in every shape that has it: a form has one field for it.
struct CutterSize {
  const char* name;  ///< in Python, in dicts and on the command line
  SizeUnit unit;
  const char *label, *description;  ///< of a form's field
  double low, high, initial;        ///< of a form's field; `initial` suits a cutter of 6 mm
  double largest = 0;               ///< multiple of the diameter that a form allows; 0: any
  bool may_be_zero = false;         ///< else a length must be positive
};

/// CUTTER/d, r, e, f, a, b, h of APT (ISO 4343). Lengths in mm, angles in rad.
struct AptCutter {
  double d;     ///< diameter
  double r;     ///< corner radius
  double e, f;  ///< the corner's centre: distance from the axis, height over the tip
  double a, b;  ///< angle of the end to the plane across the axis, angle of the flank to the axis
  double h;     ///< length
};

/// One row of the table. Python's functions and dict form, the command line, CUTTER statements of APT files and
/// Blender's panels are made from it: a new shape is a new last row. Blender files refer to shapes by number.
struct CutterShape {
  const char *name, *label, *description;
  std::span<const CutterSize> sizes;                   ///< in the order of arguments; one is "diameter", one "length"
  Profile (*profile)(std::span<const double> sizes);   ///< throws std::invalid_argument where sizes do not fit
  AptCutter (*to_apt)(std::span<const double> sizes);  ///< null: CUTTER cannot describe the shape
  std::optional<std::vector<double>> (*from_apt)(const AptCutter&);  ///< sizes, nothing for other shapes; may be null
};

std::span<const CutterShape> cutter_shapes();
/// Null where there is none: the free profile has no sizes and no row.
const CutterShape* find_cutter_shape(std::string_view name);
/// Throws std::invalid_argument naming the size that is out of range or does not fit.
Tool make_cutter(const CutterShape& shape, std::span<const double> sizes);
/// The sizes from which a tool was made, or nothing where it lacks one.
std::optional<std::vector<double>> sizes_of(const Tool& tool, const CutterShape& shape);
/// Whether a tool's parameter of this name is a flag.
bool is_flag(const Tool& tool, std::string_view parameter);

namespace cutters {

/// Every function throws std::invalid_argument naming the size that is not positive and finite or does not fit.
Tool ball(double diameter, double length);
Tool flat(double diameter, double length);
/// Bull nose: major radius e = diameter / 2 − corner_radius.
Tool fillet(double diameter, double corner_radius, double length);
/// Cone of `half_angle` (rad, between axis and flank) above a ball tip tangent to it (or a flat tip), up to `diameter`,
/// then a cylinder.
Tool taper(double tip_radius, double half_angle, double diameter, double length, bool flat_tip = false);
/// A sharp tip, a cone up to `tip_height`, a second cone up to `diameter`, then a cylinder.
Tool cone_end(double tip_half_angle, double tip_height, double half_angle, double diameter, double length);
/// Any profile of lines and arcs, followed by a cylinder up to `length` where it ends below.
Tool profile(std::vector<ProfileSegment> segments, double length);

}  // namespace cutters

}  // namespace riffler::tool

namespace riffler {
namespace cutters = tool::cutters;
}  // namespace riffler
