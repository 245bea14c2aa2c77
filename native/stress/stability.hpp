// Boundary from which a simulated device gives energy to the hand: the measurements of docs/stability.md.
#pragma once

#include <cstdint>

#include "stress/random.hpp"
#include "stress/wall_simulation.hpp"

namespace riffler::stress {

/// The stiffness (N/mm) from which the oscillation of the device, struck once and then held by `hand`, grows instead of
/// decaying. Without friction and encoder steps; to 1e-3.
double swing_boundary(const WallDevice& device, const WallHand& hand, const Column& normal);

/// Energy (N·mm) that a hand gains in one round of a path on which it moves the device itself: what the wall delivers
/// minus what damping and friction take. The path is a triangle wave of 2 · `ticks` samples, `amplitude` to both sides
/// of an edge between encoder steps.
double gained(const WallDevice& device, const SimulatedWall& wall, const Column& amplitude, int ticks);

/// The stiffness from which one of many paths gains energy: paths of all lengths, with amplitudes from a thousandth of
/// an encoder step to a thousand steps, along each of `directions`. This is the most cunning hand, which passivity is
/// about.
double cunning_boundary(const WallDevice& device, double wall_damping, const Column& normal,
                        const std::vector<Column>& directions);

/// Five coordinates, three in mm and two in rad, coupled by mass and damping, and a wall across all of them.
struct CoupledScene {
  WallDevice device;
  Column normal;
  /// The motion that costs the hand least per mm of depth: damping⁻¹ · normal.
  Column easiest;
  /// Damping along the normal with everything else left free: 1 / (normalᵀ · damping⁻¹ · normal).
  double damping;
};
CoupledScene coupled_scene(std::uint64_t seed);

/// A hand that lets the device slide along `direction` only.
WallHand guide(const WallDevice& device, const Column& direction);

/// A hand on a one-sided wall. A striking hand presses, wavers and lets go at random; another one presses with its full
/// push, from half a millimetre before the wall. In addition to its force the hand is a weak spring and damper.
struct Session {
  long ticks = 100'000;
  double push = 2;  // N; in coordinates that are angles, times 20 mm
  std::uint64_t seed = 1;
  bool strikes = true;
  WallHand guide{};
};
struct SessionResult {
  double delivered = 0;           ///< N·mm: the most that the wall was ahead of the hand, over all ticks
  double measured_delivered = 0;  ///< by measured positions
  double gained = 0;              ///< N·mm: the most that the hand had got from wall and device together
  double least_energy = 0;        ///< of the controller's account
  double depth = 0;               ///< mm, mean of the last quarter
  double speed = 0;               ///< mm/s along the normal, root mean square of the last quarter
  double variation = 0;  ///< N·mm: half an encoder step times change of force, summed: what quantisation may hide
  long touched = 0;      ///< ticks in which the controller changed the wall's force
  long unforeseen = 0;   ///< ticks in which the grip accelerated beyond the settings' bound
};
SessionResult press(const WallDevice& device, const SimulatedWall& wall, const Session& session,
                    const std::optional<haptics::PassivitySettings>& settings);

/// N/mm: perceptual hardness, (2.14) of the source, of a wall that the device strikes with `speed` (mm/s of depth)
/// along damping⁻¹ · normal: the steepest rise of the wall's force in one period, of the first twenty in contact, over
/// the speed at contact. Mean of contacts spread evenly between two samples.
double perceptual_hardness(const WallDevice& device, const SimulatedWall& wall, const WallHand& guide, double speed,
                           const std::optional<haptics::PassivitySettings>& settings);

}  // namespace riffler::stress
