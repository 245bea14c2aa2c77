// Collision check of a machine's motion with part, fixtures and stock, before NC code is written.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/nc/machine/machine_motion.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::verify {

/// Checks every step of `motion` with cutter, shank and holder by Collider::sweep, continuously rather than at samples;
/// steps far from part and fixtures pass by their boxes alone. Throws RowError for the first step that enters them by
/// more than `tolerance` (mm), stating the obstacle, the place and a remedy, and std::invalid_argument for a tool
/// without a shape. `swept`: incremented by the number of steps not dismissed by their boxes.
void refuse_collisions(const nc::Program& program, const nc::MachineMotion& motion, const collide::Collider& collider,
                       double tolerance, std::size_t* swept = nullptr, const Progress& progress = {});

/// Runs the motion on the stock as verification does. Throws RowError for the first rapid in material, and for the
/// first place where shank or holder collide with the stock.
void refuse_strikes(const nc::Program& program, const nc::MachineMotion& motion, const Volume& stock, double tolerance,
                    const Progress& progress = {});

}  // namespace riffler::verify
