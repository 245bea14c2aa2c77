// riffler.Task and the number of threads.
#include "bindings/task.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::bindings {

namespace {

/// Of all tasks there are, under the GIL.
std::vector<std::weak_ptr<base::Background>>& running() {
  static std::vector<std::weak_ptr<base::Background>> all;
  return all;
}

void remember(const std::shared_ptr<base::Background>& background) {
  std::erase_if(running(), [](const std::weak_ptr<base::Background>& b) { return b.expired(); });
  running().push_back(background);
}

/// Before the interpreter goes: a thread that ran on while the process takes itself apart would use what is gone.
void end_all() {
  std::vector<std::shared_ptr<base::Background>> all;
  for (const std::weak_ptr<base::Background>& b : running())
    if (auto held = b.lock()) all.push_back(std::move(held));
  for (const auto& b : all) b->cancel();
  const NoGil release;
  for (const auto& b : all) b->wait();
}

}  // namespace

Task::Task(base::Background::Work work, std::function<py::object()> convert)
    : background_(std::make_shared<base::Background>(std::move(work))) {
  stages_.push_back([convert = std::move(convert)](const py::object&) { return convert(); });
  remember(background_);
}

Task::~Task() {
  const NoGil release;
  background_.reset();
}

py::object Task::result() {
  // As often as a person at a keyboard notices.
  for (bool ended = background_->done(); !ended;) {
    {
      const NoGil release;
      ended = background_->wait(std::chrono::milliseconds(30));
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  background_->check();
  // A stage may run Python, and with it another thread that asks; one that failed is not made again.
  const std::vector<Stage> stages = std::exchange(stages_, {});
  if (stages.empty() && !found_) throw std::runtime_error("the result is being made by another thread, or was lost");
  py::object found = std::exchange(found_, {});
  for (const Stage& stage : stages) found = stage(found);
  return found_ = std::move(found);
}

void bind_tasks(py::module_& m) {
  py::class_<Task>(m, "Task",
                   R"(A long call on a native thread, which runs no Python: made by the functions of riffler.tasks.

What the call was given is taken when it is made, volumes by a snapshot; what is done with them afterwards changes
nothing. A Task that nobody holds any more is cancelled and waited for; so are all when Python ends.)")
      .def_property_readonly(
          "share", [](const Task& t) { return t.background().share(); },
          "The finished share, in [0, 1]: never goes back, and 1 only where the call came to its end.")
      .def_property_readonly(
          "done", [](const Task& t) { return t.background().done(); },
          "Whether ``result`` is there at once: the call has ended, by itself, by an error or cancelled.")
      .def("cancel", &Task::cancel,
           "Asks the call to end with Cancelled, and does not wait; without effect where it has ended.")
      .def("result", &Task::result,
           "What the call returns, the same object each time; waits for it, other threads go on. Raises what the call "
           "raises, Cancelled after ``cancel``. Ctrl-C ends the waiting, not the call.")
      .def("__repr__", [](const Task& t) {
        const base::Background& b = t.background();
        const int percent = static_cast<int>(100 * b.share());
        return std::string("<riffler.Task: ") + (b.done() ? "done" : std::to_string(percent) + " %") + ">";
      });
  m.def(
      "then",
      [](const py::object& found, const py::object& convert) -> py::object {
        if (!py::isinstance<Task>(found)) return convert(found);
        found.cast<Task&>().then(convert);
        return found;
      },
      py::arg("found"), py::arg("convert"), "convert(found); of a Task, that it will be done by its result().");
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_all));

  m.def("threads", &base::thread_count,
        "Threads that a parallel call uses: what set_threads() says, else RIFFLER_THREADS where that is set, else as "
        "many "
        "as the process may run on.");
  m.def(
      "set_threads", [](std::optional<int> n) { base::set_thread_count(n); }, py::arg("n"),
      R"(Says how many threads parallel calls use from now on, in all of the process; those that run keep theirs.

``n``: 1 to 256, or None: RIFFLER_THREADS decides again, or the CPU affinity. Results are the same bytes for any number.
ValueError for others.)");
}

}  // namespace riffler::bindings
