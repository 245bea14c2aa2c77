// The two ends of a verification on a cluster. Not public: riffler.cluster is.
#include <pybind11/typing.h>

#include "bindings/bindings.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/shared_report.hpp"
#include "bindings/typed.hpp"
#include "bindings/verify_arguments.hpp"
#include "verify/remote.hpp"
#include "verify/verify_plan.hpp"

namespace riffler::bindings {

namespace {

py::bytes to_python(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The bytes stay the Python object's, which the caller holds.
std::span<const std::uint8_t> to_span(const py::bytes& bytes) {
  const std::string_view view = bytes;
  return {reinterpret_cast<const std::uint8_t*>(view.data()), view.size()};
}

class SharedPlan : Guarded {
 public:
  SharedPlan(verify::VerifyArguments arguments, const Progress& progress) : plan_(std::move(arguments), progress) {}

  /// f(plan) without the GIL.
  template <class F>
  auto run(const F& f) {
    const OneCaller only(*this, "the plan");
    const NoGil release;
    return f(plan_);
  }

 private:
  verify::VerifyPlan plan_;
};

using ShareList = py::typing::List<py::typing::Tuple<std::size_t, std::size_t, py::bytes>>;

ShareList add_chunk(SharedPlan& self, const nc::Program& chunk, const ProgressLike& progress) {
  const Progress listener = to_progress(progress);
  std::vector<verify::VerifyPlan::Share> shares =
      self.run([&](verify::VerifyPlan& plan) { return plan.add(chunk, listener); });
  ShareList out;
  for (verify::VerifyPlan::Share& share : shares) {
    out.append(py::make_tuple(share.slab, share.moves, to_python(share.packet)));
    share.packet = {};
  }
  return out;
}

void bind_worker(py::module_& m) {
  py::class_<verify::SlabWorker>(m, "SlabWorker", "Simulates slabs of a VerifyPlan: made from its ``context``.")
      .def(py::init([](const py::bytes& context) {
             const std::span<const std::uint8_t> bytes = to_span(context);
             const NoGil release;
             return std::make_unique<verify::SlabWorker>(bytes);
           }),
           py::arg("context"))
      .def(
          "run",
          [](const verify::SlabWorker& self, const py::bytes& task, const std::vector<py::bytes>& moves) {
            const std::span<const std::uint8_t> slab = to_span(task);
            std::vector<std::span<const std::uint8_t>> packets;
            for (const py::bytes& packet : moves) packets.push_back(to_span(packet));
            std::vector<std::uint8_t> result;
            {
              const NoGil release;
              result = self.run(slab, packets);
            }
            return to_python(result);
          },
          py::arg("task"), py::arg("moves"), "What VerifyPlan.accept takes. FormatError for damaged bytes.");
}

}  // namespace

void bind_cluster(py::module_& m) {
  bind_worker(m);
  py::class_<SharedPlan> bound(m, "VerifyPlan",
                               "A verification whose slabs run elsewhere; arguments as of riffler.verify.");
  define_with_arguments(
      [&](const auto&... arguments) { bound.def(py::init(with_arguments<>(&make_of<SharedPlan>)), arguments...); });
  bound
      .def("add", &add_chunk, py::arg("program"), py::kw_only(), py::arg("progress") = py::none(),
           "List of (slab, number of moves, bytes) of the chunk: the moves that can touch each slab.")
      .def(
          "context",
          [](SharedPlan& self) { return to_python(self.run([](verify::VerifyPlan& plan) { return plan.context(); })); },
          "What SlabWorker is made of, after the last chunk.")
      .def(
          "task",
          [](SharedPlan& self, std::size_t slab) {
            return to_python(self.run([&](verify::VerifyPlan& plan) { return plan.task(slab); }));
          },
          py::arg("slab"), "The slab as it stands.")
      .def(
          "accept",
          [](SharedPlan& self, std::size_t slab, const py::bytes& result, bool last) {
            const std::span<const std::uint8_t> bytes = to_span(result);
            self.run([&](verify::VerifyPlan& plan) { plan.accept(slab, bytes, last); });
          },
          py::arg("slab"), py::arg("result"), py::arg("last"),
          "A result of SlabWorker.run; ``last``: the slab has no more moves. FormatError for damaged bytes.")
      .def(
          "finish",
          [](SharedPlan& self, const ProgressLike& progress) {
            const Progress listener = to_progress(progress);
            return share(self.run([&](verify::VerifyPlan& plan) { return plan.finish(listener); }));
          },
          py::kw_only(), py::arg("progress") = py::none(), "The VerifyReport, after the results of all slabs.");
}

}  // namespace riffler::bindings
