// The kinds of brushes with falloff, and their settings.
#pragma once

#include <cstdint>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::brush {

/// How a brush displaces a point of the surface; f is its falloff at the point, times the strength, a the dab's axis.
enum class Kind : std::uint32_t {
  Clay,       ///< by f · amount along a, where the surface faces a (in full up to 60° off): a layer with a soft edge
  Inflate,    ///< by f · amount along the surface's own normal
  Flatten,    ///< by f of its distance from the plane towards it; plane: the surface's mean, raised by amount
  Scrape,     ///< as Flatten, points above the plane only
  Fill,       ///< as Flatten, points below the plane only
  Grab,       ///< by f times the vector from the first dab to the last: one displacement for all dabs
  SnakeHook,  ///< by f times the vector from each dab to the next
  Pinch,      ///< by f/2 of its distance from the line through the dab along a, towards that line
  Crease,     ///< as Pinch, and by f² / strength · amount along a
  Twist,      ///< about the line through the dab along a, by f · amount rad
};
inline constexpr std::uint32_t kKinds = 10;

/// Falloff over t, the distance from the dab's centre as a fraction of the radius, with p = 1 − t: Blender's presets.
enum class Falloff : std::uint32_t {
  Smooth,         ///< 3p² − 2p³
  Smoother,       ///< 6p⁵ − 15p⁴ + 10p³
  Sphere,         ///< √(2p − p²)
  Root,           ///< √p
  Sharp,          ///< p²
  Linear,         ///< p
  Sharper,        ///< p⁴
  InverseSquare,  ///< 2p − p²
  Constant,       ///< 1
};
inline constexpr std::uint32_t kFalloffs = 9;

/// The falloff at t: 1 at 0, and 0 from 1 on.
double falloff_at(Falloff falloff, double t);

struct BrushOptions {
  Kind kind = Kind::Clay;
  double radius = 5;                  ///< mm. Material outside it does not change
  double strength = 1;                ///< 0 … 1, a factor of the displacement
  double amount = 0;                  ///< of either sign; mm, for Twist rad; unused by Grab, SnakeHook, Pinch
  Falloff falloff = Falloff::Smooth;  ///< of the displacement towards the radius
  const Volume* protect = nullptr;    ///< region that must not change; null for none. On the volume's grid
  Progress progress;
};

}  // namespace riffler::brush
