// Long calls: one way in which they run on the caller's thread or, as a Task, on one of their own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/background.hpp"
#include "bindings/bindings.hpp"

namespace riffler::bindings {

/// riffler.Task. All members are called with the GIL.
class Task {
 public:
  /// `work` runs at once and touches no Python; `convert` makes Python's result of what it left.
  Task(base::Background::Work work, std::function<py::object()> convert);
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  /// Cancels, and waits without the GIL.
  ~Task();

  const base::Background& background() const { return *background_; }
  void cancel() { background_->cancel(); }
  /// `more` is applied to what `result` would have given.
  void then(const py::object& more) {
    stages_.push_back([more](const py::object& found) { return more(found); });
  }
  /// Waits without the GIL, and lets Ctrl-C through; false after `timeout` s.
  bool wait(const std::optional<double>& timeout);
  /// Waits likewise. Throws what the work threw.
  py::object result();

 private:
  using Stage = std::function<py::object(const py::object&)>;

  std::shared_ptr<base::Background> background_;
  std::vector<Stage> stages_;  // the conversions that are still to be made
  py::object found_;           // null until the first of them is made
};

/// A T as Python has it, or a Task of one; signatures say T.
template <class T>
class ValueOrTask : public py::object {
 public:
  using py::object::object;
  explicit ValueOrTask(py::object&& found) : py::object(std::move(found)) {}
};

/// As Python has it.
template <class T>
py::object to_python_object(T&& value) {
  if constexpr (std::is_base_of_v<py::object, std::decay_t<T>>)
    return std::forward<T>(value);
  else
    return py::cast(std::forward<T>(value));
}

/// Whether `riffler.submit` gave the class of tasks as `progress`.
inline bool is_task_request(const py::object& progress) {
  return progress.ptr() == task_request();
}

/// A long call, with its arguments taken from Python: `work(progress)` runs without the GIL, touches no Python and owns
/// what it uses or shares what never changes; `convert(found)` makes Python's result of what it returned, with the GIL.
/// `progress` is what the caller gave: a callable or None, and the call is made here and now; or the class
/// riffler.Task, and a new Task makes it.
template <class Work, class Convert>
auto long_call(const py::object& progress, Work&& work, Convert convert) {
  using Value = std::invoke_result_t<Work&, const Progress&>;
  using Result = ValueOrTask<std::invoke_result_t<Convert&, Value&&>>;
  if (!is_task_request(progress)) {
    const Progress listener = to_progress(progress);
    Value value = [&] {
      const NoGil release;
      return work(listener);
    }();
    return Result(to_python_object(convert(std::move(value))));
  }
  const auto owned = std::make_shared<std::decay_t<Work>>(std::forward<Work>(work));
  const auto value = std::make_shared<std::optional<Value>>();
  return Result(
      py::cast(std::make_unique<Task>([owned, value](const Progress& listener) { value->emplace((*owned)(listener)); },
                                      [value, convert = std::move(convert)]() mutable -> py::object {
                                        return to_python_object(convert(std::move(value->value())));
                                      })));
}

/// For what is as Python has it already.
struct Identity {
  template <class T>
  T operator()(T&& value) const {
    return std::move(value);
  }
};

}  // namespace riffler::bindings

template <class T>
struct pybind11::detail::handle_type_name<riffler::bindings::ValueOrTask<T>> {
  static constexpr auto name = make_caster<T>::name;
};
