// Operations on a part: roughing and finishing. For riffler.plan, which describes it.
#include <memory>
#include <optional>
#include <utility>

#include "bindings/program_arguments.hpp"
#include "bindings/shared_volume.hpp"
#include "bindings/task.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/clear_of_stock.hpp"
#include "riffler/plan/cut_along.hpp"
#include "riffler/plan/finish.hpp"
#include "riffler/plan/outline.hpp"
#include "riffler/plan/rough.hpp"
#include "riffler/plan/surface_fit.hpp"

namespace riffler::bindings {

RIFFLER_TYPED(PlannedMoves, "riffler.plan.operations.PlannedMoves")

namespace {

using namespace py::literals;

constexpr double kPlanned = 0.85;  // of the progress
constexpr double kGreater = 1.5;   // factor on the deviation of triangles, which is measured, not proven

/// The operation, its counts, and what each of its moves takes off the stock, mm³.
struct Planned {
  plan::Operation operation;
  std::vector<std::pair<const char*, std::size_t>> counts;
  std::optional<double> engagement;
  std::vector<double> removed;
  std::optional<plan::SurfaceFit> fit{};
};

PlannedMoves from_planned(Planned&& planned) {
  plan::Operation& found = planned.operation;
  std::vector<std::uint8_t> kinds;
  for (const plan::MoveKind kind : found.kinds) kinds.push_back(static_cast<std::uint8_t>(kind));
  const py::object blocked_place = py::module_::import("riffler.plan.operations").attr("Blocked");
  py::list blocked;
  for (const plan::BlockedPlace& one : found.blocked)
    blocked.append(blocked_place(one.reason, from_vec3(one.place), one.length));
  py::dict stats;
  for (const auto& [name, count] : planned.counts) stats[name] = count;
  py::object exact = py::none();
  if (const auto& fit = planned.fit)
    exact = plan_result(
        "operations", "ExactFit",
        py::dict("fitted"_a = fit->fitted, "inserted"_a = fit->inserted, "raised"_a = fit->raised, "kept"_a = fit->kept,
                 "before"_a = fit->before, "after"_a = fit->after, "kept_depth"_a = fit->kept_depth));
  return plan_result(
      "operations", "PlannedMoves",
      py::dict("poses"_a = from_poses(found.poses), "kind"_a = take<std::uint8_t>(std::move(kinds)),
               "feed"_a = take<double>(std::move(found.feeds)), "removed"_a = take<double>(std::move(planned.removed)),
               "blocked"_a = py::tuple(blocked), "reason"_a = found.reason, "stats"_a = stats,
               "engagement"_a = planned.engagement, "exact"_a = exact));
}

Planned planned(plan::FinishResult&& found) {
  return {std::move(found),
          {{"rows", found.rows},
           {"added", found.added},
           {"direct", found.direct},
           {"retracts", found.retracts},
           {"arcs", found.arcs},
           {"straight", found.straight},
           {"drops", found.drops}},
          {},
          {}};
}

Planned planned(Planned&& found) {
  return std::move(found);
}

using ColliderPtr = std::shared_ptr<collide::Collider>;

/// Finishes, and moves the rows onto the exact surface if there is one.
Planned finished(const plan::SetupScene& scene, const Tool& tool, const plan::FinishOptions& options,
                 const ColliderPtr& exact, double deviation, const Progress& progress) {
  if (!exact) return planned(plan::finish(scene, tool, options, progress));
  Planned out = planned(plan::finish(scene, tool, options, base::part(progress, 0, 0.3)));
  const plan::SurfaceFitRule rule{options.allowance, options.tolerance, deviation, options.pattern == "waterline"};
  out.fit = plan::fit_to_surface(out.operation, tool, *exact, scene.fixtures, rule, base::part(progress, 0.3, 1));
  return out;
}

Planned planned(plan::RoughResult&& found) {
  return {std::move(found),
          {{"levels", found.levels},
           {"rings", found.rings},
           {"helices", found.helices},
           {"ramps", found.ramps},
           {"direct", found.direct},
           {"retracts", found.retracts},
           {"drops", found.drops}},
          found.engagement,
          {}};
}

Planned planned(plan::OutlineResult&& found) {
  return {std::move(found),
          {{"loops", found.loops},
           {"levels", found.levels},
           {"tabs", found.tabs},
           {"retracts", found.retracts},
           {"arcs", found.arcs},
           {"straight", found.straight}},
          {},
          {}};
}

Planned planned(plan::CutAlongResult&& found) {
  return {std::move(found), {{"pieces", found.pieces}, {"retracts", found.retracts}, {"lifted", found.lifted}}, {}, {}};
}

/// A rule of riffler.plan.axis_rules: kind, lead and tilt, target, and limits.
std::optional<plan::AxisRule> to_rule(const std::optional<std::string>& kind, double lead, double tilt,
                                      const ArrayLike& target, double max_tilt, double max_turn) {
  using Kind = plan::AxisRule::Kind;
  if (!kind) return {};
  plan::AxisRule rule;
  rule.kind = *kind == "towards"      ? Kind::Towards
              : *kind == "away"       ? Kind::Away
              : *kind == "least_tilt" ? Kind::LeastTilt
                                      : Kind::Lean;
  rule.lean = {lead, tilt}, rule.target = to_vec3s(py::cast<Doubles>(target), "orientation");
  rule.max_tilt = max_tilt, rule.max_turn = max_turn;
  return rule;
}

/// Plans with plan(scene, progress), and leaves out where shank or holder would touch the stock as it then is.
template <class Plan>
auto operation(const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures,
               SharedVolume& stock, const Tool& tool, const ArrayLike& axis, double clearance,
               const plan::StockRule& rule, const ProgressLike& progress, const Plan& plan_it) {
  auto scene = std::make_shared<plan::SetupScene>(plan::SetupScene{
      *part, {}, Reading(stock).volume.snapshot(), plan::unit_axis(to_vec3(axis, "axis"), "axis"), clearance});
  for (const auto& one : fixtures) scene->fixtures.push_back(*one);
  const auto work = [=](const Progress& listener) {
    Planned out = planned(plan_it(*scene, base::part(listener, 0, kPlanned)));
    out.removed = plan::clear_of_stock(*scene, tool, out.operation, rule, base::part(listener, kPlanned, 1));
    return out;
  };
  return long_call(progress, work, &from_planned);
}

}  // namespace

void bind_operations(py::module_& m) {
  m.def(
      "finish",
      [](const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures, SharedVolume& stock,
         const Tool& tool, const ArrayLike& axis, double clearance, const std::string& pattern, double cusp,
         double tolerance, double allowance, double angle, double min_slope, double max_slope, const ArraysLike& region,
         const std::vector<int>& faces, const std::optional<ArrayLike>& centre, bool climb, double feed, double plunge,
         std::optional<double> lead, const std::optional<std::string>& rule, double ahead, double aside,
         const ArrayLike& target, double max_tilt, double max_turn, const std::optional<ColliderPtr>& exact,
         double deviation, const ProgressLike& progress) {
        tool.require_revolved("plan.finish");
        plan::FinishOptions options;
        options.axes = to_rule(rule, ahead, aside, target, max_tilt, max_turn);
        options.pattern = pattern, options.cusp = cusp, options.tolerance = tolerance;
        options.allowance = allowance, options.angle = angle, options.min_slope = min_slope;
        options.max_slope = max_slope, options.region = to_curves(region, "region"), options.feed = feed;
        options.plunge = plunge, options.faces = faces, options.climb = climb, options.lead = lead;
        if (centre) options.centre = to_vec3(*centre, "centre");
        const double nearest = allowance - kGreater * deviation;
        const plan::StockRule apart{plan::StockRule::After::Resume, 0, tolerance, nearest, allowance, plunge};
        return operation(part, fixtures, stock, tool, axis, clearance, apart, progress,
                         [=](const plan::SetupScene& scene, const Progress& listener) {
                           return finished(scene, tool, options, exact.value_or(nullptr), deviation, listener);
                         });
      },
      "part"_a.none(false), "fixtures"_a, "stock"_a, "tool"_a, py::kw_only(), "axis"_a, "clearance"_a, "pattern"_a,
      "cusp"_a, "tolerance"_a, "allowance"_a, "angle"_a, "min_slope"_a, "max_slope"_a, "region"_a, "faces"_a,
      "centre"_a, "climb"_a, "feed"_a, "plunge"_a, "lead"_a, "rule"_a, "ahead"_a, "aside"_a, "target"_a, "max_tilt"_a,
      "max_turn"_a, "exact"_a, "deviation"_a, "progress"_a, "For riffler.plan.finish.");
  m.def(
      "rough",
      [](const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures, SharedVolume& stock,
         const Tool& tool, const ArrayLike& axis, double clearance, double stepdown, double engagement,
         double allowance, double tolerance, double slope, bool climb, double feed, double plunge, double depth,
         const ProgressLike& progress) {
        tool.require_revolved("plan.rough");
        const plan::RoughOptions options{stepdown, engagement, allowance, tolerance, slope, climb, feed, plunge, depth};
        const plan::StockRule apart{
            plan::StockRule::After::Leave, tool.diameter(), tolerance, allowance, allowance, plunge};
        return operation(part, fixtures, stock, tool, axis, clearance, apart, progress,
                         [=](const plan::SetupScene& scene, const Progress& listener) {
                           return plan::rough(scene, tool, options, listener);
                         });
      },
      "part"_a.none(false), "fixtures"_a, "stock"_a, "tool"_a, py::kw_only(), "axis"_a, "clearance"_a, "stepdown"_a,
      "engagement"_a, "allowance"_a, "tolerance"_a, "slope"_a, "climb"_a, "feed"_a, "plunge"_a, "depth"_a, "progress"_a,
      "For riffler.plan.rough.");
  m.def(
      "outline",
      [](const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures, SharedVolume& stock,
         const Tool& tool, const ArrayLike& axis, double clearance, const ArraysLike& curves, bool inside, double depth,
         double stepdown, std::size_t tabs, double tab_height, double tab_width, double allowance, double tolerance,
         double slope, bool climb, double feed, double plunge, std::optional<double> lead,
         const ProgressLike& progress) {
        tool.require_revolved("plan.outline");
        const plan::OutlineOptions options{to_curves(curves, "curves"),
                                           inside,
                                           depth,
                                           stepdown,
                                           tabs,
                                           tab_height,
                                           tab_width,
                                           allowance,
                                           tolerance,
                                           slope,
                                           climb,
                                           feed,
                                           plunge,
                                           lead};
        const plan::StockRule apart{
            plan::StockRule::After::Leave, tool.diameter(), tolerance, allowance, allowance, plunge};
        return operation(part, fixtures, stock, tool, axis, clearance, apart, progress,
                         [=](const plan::SetupScene& scene, const Progress& listener) {
                           return plan::outline(scene, tool, options, listener);
                         });
      },
      "part"_a.none(false), "fixtures"_a, "stock"_a, "tool"_a, py::kw_only(), "axis"_a, "clearance"_a, "curves"_a,
      "inside"_a, "depth"_a, "stepdown"_a, "tabs"_a, "tab_height"_a, "tab_width"_a, "allowance"_a, "tolerance"_a,
      "slope"_a, "climb"_a, "feed"_a, "plunge"_a, "lead"_a, "progress"_a, "For riffler.plan.outline.");
  m.def(
      "cut_along",
      [](const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures, SharedVolume& stock,
         const Tool& tool, const ArrayLike& axis, double clearance, const ArraysLike& lines, double distance,
         std::optional<double> fixture_distance, double tolerance, double max_lift, double feed, double plunge,
         const ProgressLike& progress) {
        tool.require_revolved("operations");
        const plan::CutAlongOptions options{distance, tolerance, max_lift, feed, plunge, fixture_distance};
        std::vector<plan::CutLine> cuts;
        for (const py::handle line : lines)
          cuts.push_back({to_poses(py::cast<Doubles>(line), ("lines[" + std::to_string(cuts.size()) + "]").c_str())});
        const plan::StockRule apart{plan::StockRule::After::Resume,      0,     tolerance, distance,
                                    fixture_distance.value_or(distance), plunge};
        return operation(part, fixtures, stock, tool, axis, clearance, apart, progress,
                         [=](const plan::SetupScene& scene, const Progress& listener) {
                           return plan::cut_along(scene, tool, cuts, options, listener);
                         });
      },
      "part"_a.none(false), "fixtures"_a, "stock"_a, "tool"_a, py::kw_only(), "axis"_a, "clearance"_a, "lines"_a,
      "distance"_a, "fixture_distance"_a, "tolerance"_a, "max_lift"_a, "feed"_a, "plunge"_a, "progress"_a,
      "For riffler.plan.along_poses.");
  m.def(
      "clear_passes",
      [](const std::shared_ptr<Mesh>& part, const std::vector<std::shared_ptr<Mesh>>& fixtures, SharedVolume& stock,
         const Tool& tool, const ArrayLike& axis, double clearance, const Doubles& poses,
         const std::vector<std::uint8_t>& kinds, const std::vector<double>& feeds, double tolerance,
         const ProgressLike& progress) {
        plan::Operation moves{to_poses(poses, "poses"), {}, feeds, {}, {}};
        for (const std::uint8_t kind : kinds) moves.kinds.push_back(static_cast<plan::MoveKind>(kind));
        const plan::StockRule apart{plan::StockRule::After::Whole, 0, tolerance};
        return operation(part, fixtures, stock, tool, axis, clearance, apart, progress,
                         [=](const plan::SetupScene&, const Progress&) { return Planned{moves, {}, {}, {}}; });
      },
      "part"_a.none(false), "fixtures"_a, "stock"_a, "tool"_a, py::kw_only(), "axis"_a, "clearance"_a, "poses"_a,
      "kinds"_a, "feeds"_a, "tolerance"_a, "progress"_a, "For riffler.plan.upright.");
  m.def("finish_patterns", &plan::finish_patterns, "For riffler.plan.finish.");
}

}  // namespace riffler::bindings
