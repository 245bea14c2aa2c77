// Operations on a part: finishing. For riffler.plan, which describes it.
#include <memory>

#include "bindings/program_types.hpp"
#include "bindings/shared_volume.hpp"
#include "bindings/task.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/finish.hpp"
#include "riffler/sweep/carve.hpp"

namespace riffler::bindings {

RIFFLER_TYPED(FinishedMoves, "riffler.plan.operations.FinishedMoves")

namespace {

using namespace py::literals;

constexpr double kPlanned = 0.85;  // of the progress

/// The operation, and the volume that each of its moves removes from the stock, mm³.
struct Planned {
  plan::FinishResult operation;
  std::vector<double> removed;
};

FinishedMoves from_planned(Planned&& planned) {
  plan::FinishResult& found = planned.operation;
  std::vector<std::uint8_t> kinds;
  for (const plan::MoveKind kind : found.kinds) kinds.push_back(static_cast<std::uint8_t>(kind));
  const py::object blocked_place = py::module_::import("riffler.plan.operations").attr("Blocked");
  py::list blocked;
  for (const plan::BlockedPlace& one : found.blocked)
    blocked.append(blocked_place(one.reason, from_vec3(one.place), one.length));
  return plan_result(
      "operations", "FinishedMoves",
      py::dict("poses"_a = from_poses(found.poses), "kind"_a = take<std::uint8_t>(std::move(kinds)),
               "feed"_a = take<double>(std::move(found.feeds)), "removed"_a = take<double>(std::move(planned.removed)),
               "blocked"_a = py::tuple(blocked), "reason"_a = found.reason,
               "stats"_a = py::dict("rows"_a = found.rows, "added"_a = found.added, "direct"_a = found.direct,
                                    "retracts"_a = found.retracts, "drops"_a = found.drops)));
}

std::vector<std::vector<Vec3>> to_region(const ArraysLike& arrays) {
  std::vector<std::vector<Vec3>> curves;
  for (const py::handle curve : arrays)
    curves.push_back(to_vec3s(py::cast<Doubles>(curve), ("region[" + std::to_string(curves.size()) + "]").c_str()));
  return curves;
}

auto finish_part(const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures,
                 SharedVolume& stock, const Tool& tool, const ArrayLike& axis, double clearance,
                 const plan::FinishOptions& options, const ProgressLike& progress) {
  auto scene = std::make_shared<plan::SetupScene>(plan::SetupScene{
      *part, {}, Reading(stock).volume.snapshot(), plan::unit_axis(to_vec3(axis, "axis"), "axis"), clearance});
  for (const auto& one : fixtures) scene->fixtures.push_back(*one);
  const auto work = [=](const Progress& listener) {
    Planned out{finish(*scene, tool, options, base::part(listener, 0, kPlanned)), {}};
    if (!out.operation.poses.empty()) {
      Volume left = scene->stock.snapshot();
      sweep::CarveOptions how;
      const Progress rest = base::part(listener, kPlanned, 1);
      how.progress = rest;
      out.removed = sweep::carve(left, tool, out.operation.poses, how).removed;
    }
    return out;
  };
  return long_call(progress, work, &from_planned);
}

}  // namespace

void bind_finish(py::module_& m) {
  m.def(
      "finish",
      [](const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures, SharedVolume& stock,
         const Tool& tool, const ArrayLike& axis, double clearance, const std::string& pattern, double cusp,
         double tolerance, double allowance, double angle, double min_slope, double max_slope, const ArraysLike& region,
         double feed, double plunge, const ProgressLike& progress) {
        plan::FinishOptions options;
        options.pattern = pattern, options.cusp = cusp, options.tolerance = tolerance;
        options.allowance = allowance, options.angle = angle, options.min_slope = min_slope;
        options.max_slope = max_slope, options.region = to_region(region), options.feed = feed;
        options.plunge = plunge;
        return finish_part(part, fixtures, stock, tool, axis, clearance, options, progress);
      },
      "part"_a.none(false), "fixtures"_a, "stock"_a, "tool"_a, py::kw_only(), "axis"_a, "clearance"_a, "pattern"_a,
      "cusp"_a, "tolerance"_a, "allowance"_a, "angle"_a, "min_slope"_a, "max_slope"_a, "region"_a, "feed"_a, "plunge"_a,
      "progress"_a, "For riffler.plan.finish.");
  m.def("finish_patterns", &plan::finish_patterns, "For riffler.plan.finish.");
}

}  // namespace riffler::bindings
