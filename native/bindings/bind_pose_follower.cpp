// riffler._core._PoseFollower: leads a pen's grip along a path and records counters and currents.
#include <memory>

#include "bindings/pen_calls.hpp"
#include "pen/pose_follower.hpp"
#include "riffler/pen/device.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;

/// A follower that is the step of an open device, until end() or the end of this object.
class Following {
 public:
  Following(std::shared_ptr<pen::Pen> device, const Doubles& times, const Doubles& poses, const Doubles& wrenches,
            bool leads, double gravity, double weight, double hook)
      : device_(std::move(device)) {
    if (device_->geometry() == nullptr) throw std::invalid_argument(device_->kind() + " has no arms to lead");
    pen::FollowerSettings settings;
    settings.gravity = gravity, settings.weight = weight, settings.hook = hook;
    if (!leads) settings.coupling = {0, 0, 0, 0, 1, 0.5};
    step_ = std::make_shared<pen::PoseFollower>(*device_->geometry(), keys_of(times, poses, wrenches), settings);
    const NoGil release;
    if (!device_->set_step(step_)) throw std::invalid_argument(device_->kind() + " cannot be led");
  }
  Following(const Following&) = delete;
  Following& operator=(const Following&) = delete;
  ~Following() { end(); }

  pen::PoseFollower& step() { return *step_; }
  void end() {
    if (!device_) return;
    step_->stop();
    device_->set_step(nullptr);
    device_.reset();
  }

 private:
  static std::vector<pen::FollowerKey> keys_of(const Doubles& times, const Doubles& poses, const Doubles& wrenches) {
    const std::vector<Pose> where = to_poses(poses, "poses");
    const std::size_t rows = check_rows(wrenches, 6, "wrenches");
    if (static_cast<std::size_t>(times.size()) != where.size() || rows != where.size())
      throw std::invalid_argument("times, poses and wrenches must have the same number of rows");
    std::vector<pen::FollowerKey> out;
    for (std::size_t k = 0; k < rows; ++k) {
      const double* const w = wrenches.data() + 6 * k;
      out.push_back({times.data()[k], where[k], {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}}});
    }
    return out;
  }

  std::shared_ptr<pen::Pen> device_;
  std::shared_ptr<pen::PoseFollower> step_;
};

/// The reason why the grip is no longer led, or none.
std::optional<std::string> why(Following& f) {
  switch (f.step().reason()) {
    case pen::FollowerStop::None:
      return {};
    case pen::FollowerStop::Asked:
      return "stopped";
    case pen::FollowerStop::Silent:
      return "the program did not answer for half a second";
    case pen::FollowerStop::Astray:
      return "the grip is too far from its target";
    case pen::FollowerStop::Safety:
      break;
  }
  return sentence(f.step().cause());
}

/// (n,) sequence numbers and s, (n, 6) counts and mA.
py::tuple records(Following& f) {
  const std::vector<pen::FollowerRecord> found = f.step().records();
  std::vector<std::uint64_t> sequence;
  std::vector<double> times;
  std::vector<std::int32_t> counts;
  std::vector<std::int16_t> currents;
  for (const pen::FollowerRecord& r : found) {
    sequence.push_back(r.sequence), times.push_back(r.time);
    counts.insert(counts.end(), r.counts.begin(), r.counts.end());
    currents.insert(currents.end(), r.currents.begin(), r.currents.end());
  }
  return py::make_tuple(take<std::uint64_t>(std::move(sequence)), take<double>(std::move(times)),
                        take<std::int32_t>(std::move(counts), pen::kPenChannels),
                        take<std::int16_t>(std::move(currents), pen::kPenChannels));
}

}  // namespace

void bind_pose_follower(py::module_& m) {
  py::class_<Following>(m, "_PoseFollower", "Leads the grip of an open pen along a path: pen/pose_follower.hpp.")
      .def(py::init<std::shared_ptr<pen::Pen>, const Doubles&, const Doubles&, const Doubles&, bool, double, double,
                    double>(),
           "device"_a, "times"_a, "poses"_a, "wrenches"_a, py::kw_only(), "leads"_a = true, "gravity"_a = 1.0,
           "weight"_a = 0.0, "hook"_a = 0.0)
      .def("alive", [](Following& f) { f.step().alive(); })
      .def("stop", [](Following& f) { f.step().stop(); })
      .def("end", &Following::end, py::call_guard<NoGil>())
      .def("records", &records)
      .def_property_readonly("state", [](Following& f) { return name(f.step().state()); })
      .def_property_readonly("why", &why)
      .def_property_readonly("time", [](Following& f) { return f.step().time(); });
}

}  // namespace riffler::bindings
