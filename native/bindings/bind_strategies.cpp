// Strategies other than the pencil cut: engraving and swarf.
#include <memory>

#include "bindings/program_arguments.hpp"
#include "riffler/plan/engrave.hpp"
#include "riffler/plan/swarf.hpp"

namespace riffler::bindings {

namespace {

py::list engraved(const Mesh& part, const ArraysLike& arrays, const Tool& tool, const plan::EngraveOptions& options,
                  const ProgressLike& callable) {
  const std::vector<std::vector<Vec3>> curves = to_curves(arrays, "curves");
  const Progress progress = to_progress(callable);
  std::vector<plan::Engraved> found;
  {
    const NoGil release;
    found = engrave(part, curves, tool, options, progress);
  }
  py::list out;
  for (const plan::Engraved& e : found)
    out.append(py::make_tuple(from_poses(e.poses), from_vec3s(e.contacts), from_vec3s(e.normals)));
  return out;
}

SwarfResult cut_with_flank(const plan::PencilPath& path, const Mesh& part, const Tool& tool,
                           const plan::SwarfOptions& options, const ProgressLike& callable) {
  const Progress progress = to_progress(callable);
  plan::Swarf found;
  {
    const NoGil release;
    found = swarf(path, part, tool, options, progress);
  }
  py::list fits;
  for (const auto& [first, last] : found.fits) fits.append(py::make_tuple(first, last));
  using namespace py::literals;
  return plan_result("strategies.swarf", "Swarf",
                     py::dict("path"_a = std::make_shared<plan::PencilPath>(std::move(found.path)),
                              "height"_a = take<double>(std::move(found.height)),
                              "error"_a = take<double>(std::move(found.error)), "fits"_a = fits));
}

}  // namespace

void bind_strategies(py::module_& m) {
  m.def(
      "engrave",
      [](const Mesh& part, const ArraysLike& curves, const Tool& tool, double depth, double inclination, double tilt,
         double tolerance, double turn, double crease, double reach, const ProgressLike& progress) {
        tool.require_revolved("plan.engrave");
        return engraved(part, curves, tool, {depth, inclination, tilt, tolerance, turn, crease, reach}, progress);
      },
      py::arg("part"), py::arg("curves"), py::arg("tool"), py::kw_only(), py::arg("depth"), py::arg("inclination"),
      py::arg("tilt"), py::arg("tolerance"), py::arg("turn"), py::arg("crease"), py::arg("reach"), py::arg("progress"),
      "For riffler.plan.engrave.");
  m.def(
      "swarf",
      [](const plan::PencilPath& path, const Mesh& part, const Tool& tool, int side, std::optional<double> height,
         double tolerance, const ProgressLike& progress) {
        tool.require_revolved("plan.swarf");
        return cut_with_flank(path, part, tool, {side, height, tolerance}, progress);
      },
      py::arg("path"), py::arg("part"), py::arg("tool"), py::kw_only(), py::arg("side"), py::arg("height"),
      py::arg("tolerance"), py::arg("progress"), "For riffler.plan.swarf.");
}

}  // namespace riffler::bindings
