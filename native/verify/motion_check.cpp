#include "verify/motion_check.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>

#include "nc/links.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "verify/slab_run.hpp"

namespace riffler::verify {

namespace {

constexpr std::size_t kGrain = 32;
constexpr std::size_t kMaxEvaluations = 200'000;

const Tool& tool_of(const nc::Program& program, std::size_t row) {
  const int number = program.tool()[row];
  const auto found = program.tools.find(number);
  if (found == program.tools.end())
    throw nc::RowError(
        "poses", row,
        "tool " + std::to_string(number) + " has no shape, so its moves cannot be checked: give it in tools");
  return found->second;
}

const char* kind_of(const nc::MachineStep& step) {
  if (step.first) return "coming down to it ";
  return step.rapid ? "on the rapid there " : "on the feed move there ";
}

}  // namespace

void refuse_collisions(const nc::Program& program, const nc::MachineMotion& motion, const collide::Collider& collider,
                       double tolerance, std::size_t* swept, const Progress& progress) {
  base::require_positive(tolerance, "contact_tolerance", base::kPositiveAndFinite);
  struct Shape {
    collide::Assembly assembly;
    nc::ToolEnvelope reach;
  };
  std::map<int, Shape> shapes;
  for (const nc::MachineStep& step : motion)
    if (const int number = program.tool()[step.row]; shapes.find(number) == shapes.end()) {
      const Tool& tool = tool_of(program, step.row);
      shapes.emplace(number, Shape{collide::Assembly(tool), nc::ToolEnvelope(&tool)});
    }
  const Box3 around = collider.bounds().grown(tolerance);
  std::atomic<std::size_t> first{motion.size()}, looked{0};
  base::parallel_for(
      motion.size(), kGrain,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end && k < first; ++k) {
          const nc::MachineStep& step = motion[k];
          const Shape& shape = shapes.at(program.tool()[step.row]);
          if (!shape.reach.swept_box(step.from, step.to).overlaps(around)) continue;
          ++looked;
          const collide::Swept found =
              collider.sweep(shape.assembly, Motion(step.from, step.to), -tolerance, kMaxEvaluations);
          if (found.answer == collide::Swept::Answer::Clear) continue;
          for (std::size_t known = first; k < known && !first.compare_exchange_weak(known, k);) {
          }
          return;
        }
      },
      progress);
  if (swept) *swept += looked;
  if (first == motion.size()) return;
  const nc::MachineStep& step = motion[first];
  const collide::Assembly& assembly = shapes.at(program.tool()[step.row]).assembly;
  throw nc::RowError(
      "poses", step.row,
      kind_of(step) +
          nc::meeting(collider, assembly, nc::deepest_pose(collider, assembly, Motion(step.from, step.to))) +
          ": make the program with this collider (Program.from_cl), plan with more clearance, or move the "
          "fixture");
}

void refuse_strikes(const nc::Program& program, const nc::MachineMotion& motion, const Volume& stock, double tolerance,
                    const Progress& progress) {
  nc::Program made;
  made.reserve(motion.size() + 1);
  made.tools = program.tools;
  constexpr double kFeed = 1000;  // arbitrary: times do not matter
  std::vector<std::size_t> rows;
  const auto add = [&](const nc::MachineStep& step, const Pose& pose, bool rapid) {
    made.append({pose, rapid ? 0 : kFeed, program.spindle()[step.row], program.tool()[step.row], 0, rapid});
    rows.push_back(step.row);
  };
  const Pose* last = nullptr;
  for (const nc::MachineStep& step : motion) {
    tool_of(program, step.row);
    if (!last || last->tip != step.from.tip || last->axis != step.from.axis) add(step, step.from, true);
    add(step, step.to, step.rapid);
    last = &step.to;
  }
  VerifyOptions options;
  options.tolerance = tolerance;
  SlabRun run({.stock = stock.snapshot(), .options = options}, base::part(progress, 0, 0.2));
  run.feed(made, base::part(progress, 0.2, 1));
  const VerifyReport report = run.finish();
  for (const Finding& finding : report.findings) {
    if (finding.kind == Kind::Spindle) continue;
    const std::size_t row = rows[static_cast<std::size_t>(finding.row)];
    char place[96];
    std::snprintf(place, sizeof place, " at [%.3f %.3f %.3f]", finding.point.x + 0.0, finding.point.y + 0.0,
                  finding.point.z + 0.0);
    throw nc::RowError("poses", row, "on the move there" + std::string(place) + " " + finding.message);
  }
}

}  // namespace riffler::verify
