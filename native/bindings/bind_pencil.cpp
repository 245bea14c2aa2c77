// Pencil cuts.
#include <memory>

#include "bindings/program_types.hpp"
#include "bindings/task.hpp"
#include "plan/passes.hpp"
#include "riffler/plan/pencil.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bindings {

namespace {

py::object from_stats(const plan::PencilStats& s) {
  using namespace py::literals;
  return plan_result("strategies.pencil", "PencilStats",
                     py::dict("balls"_a = s.balls, "entered"_a = s.entered, "starts"_a = s.starts, "stuck"_a = s.stuck,
                              "faceting"_a = s.faceting, "edges"_a = s.edges, "traces"_a = s.traces,
                              "steps"_a = s.steps, "cut"_a = s.cut));
}

PencilResult from_result(plan::PencilResult&& result) {
  py::list paths;
  for (plan::PencilPath& path : result.paths) paths.append(std::make_shared<plan::PencilPath>(std::move(path)));
  py::list ends;
  for (const auto& [first, last] : result.ends) ends.append(py::make_tuple(first, last));
  using namespace py::literals;
  return plan_result(
      "strategies.pencil", "PencilPaths",
      py::dict("paths"_a = paths, "ends"_a = ends, "rest_area"_a = result.rest_area,
               "rest_areas"_a = take<double>(std::move(result.rest_areas)), "reference_area"_a = result.reference_area,
               "reference_areas"_a = take<double>(std::move(result.reference_areas)),
               "stats"_a = from_stats(result.stats), "reason"_a = result.reason));
}

}  // namespace

void bind_pencil(py::module_& m) {
  m.def("stepover_of_scallop", &plan::stepover_of_scallop, py::arg("radius"), py::arg("height"));
  m.def(
      "require_revolved", [](const Tool& tool, const std::string& who) { tool.require_revolved(who); }, py::arg("tool"),
      py::arg("who"), "ValueError for a hand tool, which ``who`` cannot use.");
  m.def("tip_ball_radius", &plan::tip_ball_radius, py::arg("tool"), py::arg("name"),
        "Radius (mm) of the ball at the tip of ``tool``; ValueError naming the argument ``name`` if the tip is not a "
        "ball.");
  m.def(
      "pencil",
      [](const std::shared_ptr<Mesh>& part, const Tool& tool, double tolerance, std::optional<double> bitangency_angle,
         double minimum_length, int passes, std::optional<double> stepover, double overthickness,
         const ProgressLike& progress) {
        tool.require_revolved("plan.pencil");
        plan::PencilOptions options;
        options.tolerance = tolerance, options.bitangency_angle = bitangency_angle;
        options.minimum_length = minimum_length, options.passes = passes, options.stepover = stepover;
        options.overthickness = overthickness;
        const auto work = [part, radius = plan::tip_ball_radius(tool, "tool"), options](const Progress& listener) {
          return pencil(*part, radius, options, listener);
        };
        return long_call(progress, work, [](plan::PencilResult&& found) { return from_result(std::move(found)); });
      },
      py::arg("part").none(false), py::arg("tool"), py::kw_only(), py::arg("tolerance"), py::arg("bitangency_angle"),
      py::arg("minimum_length"), py::arg("passes"), py::arg("stepover"), py::arg("overthickness"), py::arg("progress"),
      "For riffler.plan.pencil.");
}

}  // namespace riffler::bindings
