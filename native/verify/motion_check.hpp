// Whether what a machine makes of a program meets part, fixtures or stock: asked before NC code is written.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/nc/machine/machine_motion.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::verify {

/// Checks every stretch of `motion` with cutter, shank and holder by Collider::sweep, that is, not at samples;
/// stretches that are far from part and fixtures by their boxes alone. RowError of the first one that enters them by
/// more than `tolerance` (mm), with what is met, where and what to do; std::invalid_argument for a tool without a
/// shape. `swept`: added to, how many stretches were not dismissed by their boxes.
void refuse_collisions(const nc::Program& program, const nc::MachineMotion& motion, const collide::Collider& collider,
                       double tolerance, std::size_t* swept = nullptr, const Progress& progress = {});

/// Runs the motion on the stock as verification does: RowError of the first rapid in material and the first place where
/// shank or holder meet it.
void refuse_strikes(const nc::Program& program, const nc::MachineMotion& motion, const Volume& stock, double tolerance,
                    const Progress& progress = {});

}  // namespace riffler::verify
