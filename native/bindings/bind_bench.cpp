// riffler._core.bench: what `riffler bench` measures with.
#include "bench/capsule_loop.hpp"
#include "bench/mesh_distance.hpp"
#include "bench/scenes.hpp"
#include "bench/sweep_error.hpp"
#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "stress/mesh_run.hpp"

namespace riffler {

namespace {

py::array_t<double> from_poses(const std::vector<Pose>& poses) {
  static_assert(sizeof(Pose) == 6 * sizeof(double));
  return take<double>(std::vector<Pose>(poses), 6);
}

py::list cutters() {
  py::list out;
  for (const bench::NamedCutter& c : bench::named_cutters())
    out.append(py::make_tuple(c.name, c.tool.named(c.name), c.centre_height));
  return out;
}

py::dict sweep_errors(SharedVolume& volume, const Tool& tool, const Doubles& array, double tolerance, int rays,
                      std::uint64_t seed) {
  const std::vector<Pose> poses = to_poses(array, "poses");
  const Volume state = Reading(volume).volume.snapshot();
  bench::SweepErrors errors;
  {
    const py::gil_scoped_release release;
    errors = bench::sweep_errors(state, tool, poses, tolerance, rays, seed);
  }
  std::vector<double> all;
  std::vector<bool> grazes;
  for (const bench::EndError& e : errors.ends) all.push_back(e.error()), grazes.push_back(e.grazes);
  py::dict out;
  out["error"] = take<double>(std::move(all));
  out["grazes"] = py::cast(grazes);
  out["points"] = errors.points, out["wrong"] = errors.wrong;
  return out;
}

py::array_t<double> mesh_distances(const Doubles& array, const Mesh& mesh) {
  const std::size_t n = check_rows(array, 3, "points");
  const auto* points = reinterpret_cast<const Vec3*>(array.data());
  std::vector<double> out;
  {
    const py::gil_scoped_release release;
    out = bench::MeshDistance(mesh)(std::span(points, n));
  }
  return take<double>(std::move(out));
}

py::dict mesh_stress(std::uint64_t volumes, std::uint64_t seed, const py::object& progress) {
  stress::MeshOptions options;
  options.seed = seed;
  const Progress report = to_progress(progress);
  stress::MeshResults results;
  {
    const py::gil_scoped_release release;
    results = stress::run_meshes(options, volumes, [&](const stress::MeshResults& now) {
      const long done = now.total().volumes;
      return done % 64 != 0 || report(static_cast<double>(done) / static_cast<double>(volumes));
    });
  }
  py::list scenes, failures;
  for (std::size_t k = 0; k < results.scenes.size(); ++k) {
    const stress::MeshTally& t = results.scenes[k];
    scenes.append(py::dict(py::arg("scene") = name(static_cast<stress::MeshScene>(k)), py::arg("volumes") = t.volumes,
                           py::arg("empty") = t.empty, py::arg("triangles") = t.triangles,
                           py::arg("failures") = t.failures));
  }
  for (const stress::MeshFailure& f : results.failures)
    failures.append(std::string(name(f.scene)) + ": " + f.problem + "; again: " + reproducer(f));
  return py::dict(py::arg("scenes") = scenes, py::arg("failures") = failures,
                  py::arg("thread_checks") = results.thread_checks);
}

}  // namespace

void bind_bench(py::module_& parent) {
  py::module_ m = parent.def_submodule("bench", "What the benchmark measures with: scenes, yardstick, reference.");
  m.attr("MOVES") = bench::kMoves;
  m.def("cutters", &cutters, "[(name, tool, height of the point that follows the path)], one of each kind.");
  m.def(
      "path", [](double centre_height, bool turning) { return from_poses(bench::path(centre_height, turning)); },
      py::arg("centre_height"), py::arg("turning"), "Poses (201, 6) of B200, or of B5X where turning.");
  m.def(
      "sweep_errors", &sweep_errors, py::arg("volume"), py::arg("tool"), py::arg("poses"), py::arg("tolerance"),
      py::arg("rays"), py::arg("seed") = 1,
      R"(Compares random rays of a carved block with the independent reference: a dict of ``error`` (n,), mm along the ray
or, where it grazes, in space; ``grazes`` (n,); ``points`` compared and how many of them are ``wrong``.)");
  m.def("mesh_distances", &mesh_distances, py::arg("points"), py::arg("mesh"),
        "Distance (n,) of points from a mesh, mm, by a search of its own; for points that are close to it.");
  m.def(
      "mesh_stress", &mesh_stress, py::arg("volumes"), py::arg("seed") = 1, py::arg("progress") = py::none(),
      R"(Meshes random volumes from the degenerate limits and checks each mesh: a dict of ``scenes`` (what was meshed),
``failures`` (what was wrong, and the command that shows it again) and how many ``thread_checks`` there were.)");
  py::class_<bench::CapsuleLoop>(m, "CapsuleLoop", "The yardstick: B200 with bare capsules on a plain height map.")
      .def(py::init<double>(), py::arg("pitch"))
      .def("reset", &bench::CapsuleLoop::reset)
      .def("run", &bench::CapsuleLoop::run, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("removed", &bench::CapsuleLoop::removed);
}

}  // namespace riffler
