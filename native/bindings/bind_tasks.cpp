// Tasks, which riffler.Future waits for, and the number of threads.
#include <algorithm>
#include <chrono>

#include "bindings/task.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::bindings {

namespace {

/// All tasks there are; used under the GIL.
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
  wait(std::nullopt);
  background_->check();
  // A stage may run Python, and with it another thread that asks; one that failed is not made again.
  const std::vector<Stage> stages = std::exchange(stages_, {});
  if (stages.empty() && !found_) throw std::runtime_error("the result is being made by another thread, or was lost");
  py::object found = std::exchange(found_, {});
  for (const Stage& stage : stages) found = stage(found);
  return found_ = std::move(found);
}

bool Task::wait(const std::optional<double>& timeout) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  const Clock::time_point begin = Clock::now();
  while (!background_->done()) {
    Seconds step(0.03);  // as often as a person at a keyboard notices
    if (timeout) step = std::min(step, Seconds(*timeout - Seconds(Clock::now() - begin).count()));
    if (!(step.count() > 0)) return false;
    {
      const NoGil release;
      background_->wait(std::chrono::milliseconds(1 + static_cast<int>(1000 * step.count())));
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return true;
}

void bind_tasks(py::module_& m) {
  static const py::handle not_a_task = PyErr_NewException("riffler._core.NotATask", PyExc_TypeError, nullptr);
  m.attr("NotATask") = not_a_task;
  py::class_<Task>(m, "Task",
                   R"(A long call on a native thread that runs no Python; a riffler.Future waits for it.

What the call was given is taken when it is made, volumes by a snapshot; what is done with them afterwards changes
nothing. A Task that nobody holds any more is cancelled and waited for; so are all when Python ends.)")
      .def_property_readonly(
          "share", [](const Task& t) { return t.background().share(); },
          "The finished share, in [0, 1]. Never decreases; 1 only if the call has finished.")
      .def_property_readonly(
          "done", [](const Task& t) { return t.background().done(); },
          "Whether ``result`` returns at once: the call has finished, failed or been cancelled.")
      .def("cancel", &Task::cancel,
           "Asks the call to end with Cancelled, and does not wait. No effect if the call has ended.")
      .def("result", &Task::result,
           "What the call returns, the same object each time; waits for it without blocking other threads. Raises what "
           "the call raises, Cancelled after ``cancel``. Ctrl-C ends the waiting, not the call.")
      .def("wait", &Task::wait, py::arg("timeout") = py::none(),
           "Waits until the call has ended, at most this many seconds. Returns whether it has ended. Other threads run "
           "meanwhile.")
      .def("__repr__", [](const Task& t) {
        const base::Background& b = t.background();
        const int percent = static_cast<int>(100 * b.share());
        return std::string("<riffler.Task: ") + (b.done() ? "done" : std::to_string(percent) + " %") + ">";
      });
  task_request() = py::type::of<Task>().ptr();
  task_refusal() = not_a_task.ptr();
  m.def(
      "then",
      [](const py::object& found, const py::object& convert) -> py::object {
        if (!py::isinstance<Task>(found)) return convert(found);
        found.cast<Task&>().then(convert);
        return found;
      },
      py::arg("found"), py::arg("convert"), "convert(found); of a Task, that it will be done by its result().");
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_all));

  m.def("threads", &base::thread_count, R"(Number of threads of a parallel call.

The number given to `set_threads`, else RIFFLER_THREADS if set, else the number of processors that the process may use.

Returns
-------
int
    1 to 256.

Examples
--------
>>> 1 <= riffler.threads() <= 256
True
)");
  m.def(
      "set_threads", [](std::optional<int> n) { base::set_thread_count(n); }, py::arg("n"),
      R"(Sets the number of threads of parallel calls in the whole process. Running calls keep theirs.

Results are the same bytes for any number.

Parameters
----------
n : int from 1 to 256, or None
    None: as set by RIFFLER_THREADS, or by the CPU affinity.

Raises
------
ValueError
    Another number.

Examples
--------
>>> riffler.set_threads(1)
>>> riffler.threads()
1
>>> riffler.set_threads(None)
)");
}

}  // namespace riffler::bindings
