// Slabs as values that go to other processes and machines: pickled as tuples of arrays, volumes and tools.
#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "verify/task.hpp"

namespace riffler {

namespace {

std::shared_ptr<SharedVolume> share(const Volume& volume) {
  return std::make_shared<SharedVolume>(volume.snapshot());
}

template <class T>
py::array_t<T> copied(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

template <class T>
std::vector<T> to_vector(const py::handle& object) {
  const auto array = py::cast<py::array_t<T, py::array::c_style>>(object);
  return {array.data(), array.data() + array.size()};
}

py::tuple task_state(const SlabTask& t) {
  py::object part = py::none(), target = py::none();
  if (t.part) part = py::cast(std::const_pointer_cast<Mesh>(t.part));
  if (t.target) target = py::cast(share(*t.target));
  return py::make_tuple(t.job, t.fixture, t.slab, share(t.material), from_poses(t.poses), copied(t.rows),
                        copied(t.tool), copied(t.rapid), t.tools,
                        py::make_tuple(t.tolerance, t.gouge_tolerance, t.beyond, t.pitch, t.top), part, target);
}

SlabTask task_from(const py::tuple& s) {
  if (s.size() != 12) throw py::value_error("a pickled SlabTask has twelve parts");
  const auto numbers = py::cast<std::array<double, 5>>(s[9]);
  SlabTask t{.fixture = py::cast<std::int32_t>(s[1]),
             .slab = py::cast<std::size_t>(s[2]),
             .material = py::cast<SharedVolume&>(s[3]).volume,
             .poses = {},
             .rows = to_vector<std::int64_t>(s[5]),
             .tool = to_vector<std::uint32_t>(s[6]),
             .rapid = to_vector<std::uint8_t>(s[7]),
             .tools = py::cast<std::vector<Tool>>(s[8]),
             .tolerance = numbers[0],
             .gouge_tolerance = numbers[1],
             .beyond = numbers[2],
             .pitch = numbers[3],
             .top = numbers[4],
             .part = nullptr,
             .target = {},
             .job = py::cast<std::size_t>(s[0])};
  // As they are: poses that are normalised again may differ in their last bit.
  const auto poses = py::cast<Doubles>(s[4]);
  t.poses.resize(static_cast<std::size_t>(poses.size()) / 6);
  std::copy_n(poses.data(), poses.size(), reinterpret_cast<double*>(t.poses.data()));
  if (!s[10].is_none()) t.part = py::cast<std::shared_ptr<Mesh>>(s[10]);
  if (!s[11].is_none()) t.target = py::cast<SharedVolume&>(s[11]).volume;
  return t;
}

constexpr std::size_t kEvent = 9;  // numbers of an event; doubles hold rows exactly

py::tuple result_state(const SlabResult& r) {
  std::vector<std::int64_t> rows;
  std::vector<double> removed, events;
  for (const auto& [row, taken] : r.report.removed) rows.push_back(row), removed.push_back(taken);
  for (const Event& e : r.report.events)
    for (const double x : {static_cast<double>(e.kind), static_cast<double>(e.member), static_cast<double>(e.fixture),
                           static_cast<double>(e.row), e.value, e.worst, e.point.x, e.point.y, e.point.z})
      events.push_back(x);
  const VerifyStats& s = r.stats;
  return py::make_tuple(r.job, share(r.material), copied(rows), copied(removed), copied(events), r.report.strikes,
                        py::make_tuple(s.moves, s.slabs, s.probes, s.probed_moves, s.bisections, s.skipped));
}

SlabResult result_from(const py::tuple& s) {
  if (s.size() != 7) throw py::value_error("a pickled SlabResult has seven parts");
  SlabResult r{py::cast<std::size_t>(s[0]), py::cast<SharedVolume&>(s[1]).volume, {}, {}};
  const auto rows = to_vector<std::int64_t>(s[2]);
  const auto removed = to_vector<double>(s[3]), events = to_vector<double>(s[4]);
  if (rows.size() != removed.size() || events.size() % kEvent != 0)
    throw py::value_error("a pickled SlabResult whose parts differ in length");
  for (std::size_t k = 0; k < rows.size(); ++k) r.report.removed.emplace_back(rows[k], removed[k]);
  for (std::size_t k = 0; k < events.size(); k += kEvent) {
    const double* e = events.data() + k;
    r.report.events.push_back({static_cast<Kind>(e[0]),
                               static_cast<Member>(e[1]),
                               static_cast<std::int32_t>(e[2]),
                               static_cast<std::int64_t>(e[3]),
                               e[4],
                               e[5],
                               {e[6], e[7], e[8]}});
  }
  r.report.strikes = py::cast<std::uint64_t>(s[5]);
  const auto n = py::cast<std::array<std::uint64_t, 6>>(s[6]);
  r.stats.moves = n[0], r.stats.slabs = n[1], r.stats.probes = n[2], r.stats.probed_moves = n[3],
  r.stats.bisections = n[4], r.stats.skipped = n[5];
  return r;
}

}  // namespace

void bind_slab_task(py::module_& m) {
  py::class_<SlabResult>(m, "SlabResult", "What a SlabTask found; can be pickled.")
      .def(py::pickle(&result_state, &result_from));
  py::class_<SlabTask>(m, "SlabTask", "One slab's share of a verification; can be pickled, and run anywhere.")
      .def(
          "run",
          [](const SlabTask& task) {
            const py::gil_scoped_release release;
            return simulate(task);
          },
          "The SlabResult.")
      .def_property_readonly(
          "moves", [](const SlabTask& t) { return t.rows.size(); }, "Moves that can touch the slab.")
      .def(py::pickle(&task_state, &task_from));
}

}  // namespace riffler
