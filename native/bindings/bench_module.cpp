// The extension module riffler_bench._bench: scenes, yardstick and reference of `riffler bench`. It reads the objects
// of riffler._core, so both modules must be of one version.
#include "bench/busy_session.hpp"
#include "bench/capsule_loop.hpp"
#include "bench/contact_parts.hpp"
#include "bench/contact_run.hpp"
#include "bench/direction_run.hpp"
#include "bench/haptic_run.hpp"
#include "bench/hull_distance.hpp"
#include "bench/mesh_distance.hpp"
#include "bench/scenes.hpp"
#include "bench/sweep_error.hpp"
#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "stress/mesh_run.hpp"
#include "stress/sculpting_run.hpp"

namespace riffler::bindings {

namespace {

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
    const NoGil release;
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
    const NoGil release;
    out = bench::MeshDistance(mesh)(std::span(points, n));
  }
  return take<double>(std::move(out));
}

py::array_t<double> hull_distances(const Tool& tool, const Doubles& poses, double step, const Doubles& array) {
  const std::vector<RolledPose> path = to_rolled_poses(poses, "poses");
  const std::vector<Vec3> points = to_vec3s(array, "points");
  std::vector<double> out;
  {
    const NoGil release;
    out = bench::hull_distances(tool, path, step, points);
  }
  return take<double>(std::move(out));
}

py::array_t<double> contact_entries(const Mesh& mesh, const Tool& tool, const Doubles& array, double gap) {
  const std::vector<Pose> poses = to_poses(array, "poses");
  std::vector<std::array<double, 2>> out;
  {
    const NoGil release;
    out = bench::contact_entries(mesh, tool, poses, gap);
  }
  return take<double>(std::move(out), 2);
}

bench::ContactOptions contact_options(int squares, const std::string& tool, int poses, int repeats = 1) {
  bench::ContactOptions out;
  out.squares = squares, out.tool = tool, out.poses = poses, out.repeats = repeats;
  return out;
}

void bind_contact(py::module_& m) {
  using Unlocked = py::call_guard<NoGil>;
  m.def(
      "contact_times",
      [](int squares, const std::string& tool, int poses, int repeats, const std::string& part) {
        bench::ContactOptions options = contact_options(squares, tool, poses, repeats);
        options.part = part;
        return bench::contact_times(options);
      },
      py::arg("squares"), py::arg("tool"), py::arg("poses"), py::arg("repeats"), py::arg("part") = "", Unlocked(),
      "Times of queries on COL's scene, or on the part of that name (native/bench/contact_parts.hpp), without others: "
      "JSON (native/bench/contact_run.hpp).");
  m.def("contact_part_names", &bench::contact_part_names, "Parts that contact_times makes itself.");
  m.def(
      "contact_budgets",
      [](int squares, const std::string& tool, int poses, const std::vector<double>& budgets, const std::string& part) {
        bench::ContactOptions options = contact_options(squares, tool, poses);
        options.part = part;
        return bench::contact_budgets(options, budgets);
      },
      py::arg("squares"), py::arg("tool"), py::arg("poses"), py::arg("budgets"), py::arg("part") = "", Unlocked(),
      "Time, missed depth and its bound with budgets in s, on a part as for contact_times: JSON.");
  m.def(
      "contact_errors",
      [](int squares, const std::string& tool, int poses, std::size_t points, int brackets, double gap) {
        return bench::contact_errors(contact_options(squares, tool, poses), points, brackets, gap);
      },
      py::arg("squares"), py::arg("tool"), py::arg("poses"), py::arg("points"), py::arg("brackets"), py::arg("gap"),
      Unlocked(), "Depths against the independent reference: JSON.");
  m.def("contact_slide", &bench::contact_slide, py::arg("steps"), Unlocked(),
        "Force on a ball that slides over an edge: JSON.");
  m.def(
      "contact_entries", &contact_entries, py::arg("mesh"), py::arg("tool"), py::arg("poses"), py::arg("gap"),
      R"(How deep a mesh's surface enters a tool at poses, by the independent reference: (n, 2), mm, attained somewhere
and proven to be the most; at most ``gap`` apart, unless that takes more than a million triangles.)");
}

py::dict haptic_run(const std::string& scene, double pitch, int steps, int parts, const std::optional<double>& memory,
                    const std::optional<double>& budget, int period, double speed) {
  bench::HapticOptions options;
  options.scene = scene, options.pitch = pitch, options.steps = steps, options.parts = parts, options.memory = memory;
  options.budget = budget, options.period = period, options.speed = speed;
  bench::HapticRun run;
  {
    const NoGil release;
    run = bench::haptic_run(options);
  }
  const auto rows = [](const std::vector<Vec3>& all) {
    std::vector<std::array<double, 3>> out;
    for (const Vec3& v : all) out.push_back({v.x, v.y, v.z});
    return take<double>(std::move(out), 3);
  };
  return py::dict(py::arg("seconds") = take<double>(std::move(run.seconds)), py::arg("force") = rows(run.force),
                  py::arg("grip") = rows(run.grip), py::arg("removed") = run.removed,
                  py::arg("touching") = run.touching, py::arg("held") = run.held);
}

py::dict direction_run(const Doubles& array, const std::string& directions, double pitch, int shown) {
  const bench::DirectionOptions options{to_poses(array, "poses"), directions, pitch, shown};
  bench::DirectionRun run;
  {
    const NoGil release;
    run = bench::direction_run(options);
  }
  return py::dict(py::arg("seconds") = take<double>(std::move(run.seconds)), py::arg("removed") = run.removed,
                  py::arg("tested") = run.tested, py::arg("changed") = run.changed);
}

py::dict busy_session(double seconds, int load, bool real_time) {
  bench::BusyRun run;
  {
    const NoGil release;
    run = bench::busy_session({seconds, load, real_time});
  }
  return py::dict(py::arg("step") = take<double>(std::move(run.step)),
                  py::arg("period") = take<double>(std::move(run.period)), py::arg("level") = run.priority.level,
                  py::arg("priority") = run.priority.text);
}

py::dict mesh_stress(std::uint64_t volumes, std::uint64_t seed, const py::object& progress) {
  stress::MeshOptions options;
  options.seed = seed;
  const Progress report = to_progress(progress);
  stress::MeshResults results;
  {
    const NoGil release;
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

py::dict sculpting(double seconds, double pitch, const std::string& directions, double stiffness, bool controlled,
                   std::int64_t jitter_us) {
  stress::SculptingOptions options;
  options.seconds = seconds, options.pitch = pitch, options.directions = directions;
  options.stiffness = stiffness, options.controlled = controlled, options.jitter_us = jitter_us;
  options.warm = std::min(options.warm, 0.3 * seconds);
  stress::SculptingRun run;
  {
    const NoGil release;
    run = stress::sculpting_run(options);
  }
  py::dict out;
  out["seconds"] = take<float>(std::move(run.step_seconds));
  out["resident_mb"] = run.resident;
  out["removed"] = run.removed, out["gained"] = run.gained, out["given"] = run.given, out["account"] = run.account;
  out["greatest"] = run.greatest, out["steps"] = run.steps, out["strokes"] = run.strokes, out["missed"] = run.missed;
  out["frames"] = run.frames, out["tiles"] = run.tiles, out["from_system"] = run.from_system;
  out["replayed"] = run.replayed, out["triangles"] = run.triangles;
  return out;
}

void bind(py::module_& m) {
  m.doc() = "What the benchmark measures with: scenes, yardstick, reference.";
  m.attr("__version__") = RIFFLER_VERSION;
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
  m.def(
      "hull_distances", &hull_distances, py::arg("tool"), py::arg("poses"), py::arg("step"), py::arg("points"),
      "Signed distances (mm) of points from a hand tool at poses (n, 9), by poses that lie densely in time: no corner "
      "moves farther than `step` between two. Above 1 mm, any value above it.");
  m.def("mesh_distances", &mesh_distances, py::arg("points"), py::arg("mesh"),
        "Distance (n,) of points from a mesh, mm, by a search of its own; for points that are close to it.");
  bind_contact(m);
  m.def(
      "haptic_run", &haptic_run, py::arg("scene"), py::arg("pitch") = 0.1, py::arg("steps") = 600, py::arg("parts") = 1,
      py::arg("memory") = py::none(), py::arg("budget") = py::none(), py::arg("period") = 1, py::arg("speed") = 1.0,
      R"(A stroke of the haptic step (native/bench/haptic_run.hpp): a dict of ``seconds`` of processor time of every step,
``force`` (n, 3) N on the hand and ``grip`` (n, 3) mm at every ms, mm³ ``removed``, and the shares of steps ``touching``
and ``held`` for want of time. ``period`` above 1: a step every so many ms and straight lines between.)");
  m.def(
      "direction_run", &direction_run, py::arg("poses"), py::arg("directions"), py::arg("pitch") = 0.2,
      py::arg("shown") = 33,
      R"(A stroke of a Ø20 ball with rays in these directions (native/bench/direction_run.hpp): a dict of ``seconds`` of
processor time of every step, mm³ ``removed``, and the rays ``tested`` and ``changed``.)");
  m.def("busy_session", &busy_session, py::arg("seconds") = 5.0, py::arg("load") = 4, py::arg("real_time") = true,
        R"(A session in real time while ``load`` threads compute (native/bench/busy_session.hpp): a dict of ``step`` and
``period`` (n,), s of the clock on the wall, the ``level`` of real-time priority, 0 for none, and ``priority`` in words.)");
  m.def("sculpting", &sculpting, py::arg("seconds") = 600.0, py::arg("pitch") = 0.25, py::arg("directions") = "z",
        py::arg("stiffness") = 1.0, py::arg("controlled") = true, py::arg("jitter_us") = 200,
        R"(Minutes of sculpting with the simulated pen on a virtual clock (native/stress/sculpting_run.hpp): a dict of
``seconds`` of processor time of every step after the warm-up, ``resident_mb`` after each tenth, mm³ ``removed``, N·mm that
the hand ``gained`` at most and that were ``given`` in all, N ``greatest``, and counts.)");
  m.def(
      "mesh_stress", &mesh_stress, py::arg("volumes"), py::arg("seed") = 1, py::arg("progress") = py::none(),
      R"(Meshes random volumes from the degenerate limits and checks each mesh: a dict of ``scenes`` (what was meshed),
``failures`` (what was wrong, and the command that shows it again) and how many ``thread_checks`` there were.)");
  py::class_<bench::CapsuleLoop>(m, "CapsuleLoop", "The yardstick: B200 with bare capsules on a plain height map.")
      .def(py::init<double>(), py::arg("pitch"))
      .def("reset", &bench::CapsuleLoop::reset)
      .def("run", &bench::CapsuleLoop::run)
      .def_property_readonly("removed", &bench::CapsuleLoop::removed);
}

}  // namespace

}  // namespace riffler::bindings

PYBIND11_MODULE(_bench, m) {
  riffler::bindings::translate_errors(
      riffler::bindings::py::module_::import("riffler._core"));  // whose classes are now known, too
  riffler::bindings::bind(m);
  riffler::bindings::refuse_objects_without_init(m);
}
