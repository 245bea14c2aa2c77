// What the binding files share: one bind_<topic> per folder of the core, and the conversions between numpy and it.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>
#include <string>

#include "bindings/gil.hpp"
#include "nc/options.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/collide/contact.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/geom/rolled_pose.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/plan/orientation.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bindings {

namespace py = pybind11;

/// The exceptions, and how others become Python's.
void bind_errors(py::module_& m);
/// The same translation for another extension module: `core` is riffler._core, which has the exceptions.
void translate_errors(const py::module_& core);
/// For all classes of the module: any use of an object that `__new__` made without `__init__` is a TypeError.
void refuse_objects_without_init(const py::module_& m);
/// A call of any function of the module whose arguments do not fit is answered by riffler.hints.
void answer_misfits(const py::module_& m);
void bind_files(py::module_& m);
void bind_mesh(py::module_& m);
void bind_tool(py::module_& m);
void bind_volume(py::module_& m);
void bind_smooth_dabs(py::module_& m);
void bind_mesher(py::module_& m);
void bind_program(py::module_& m);
void bind_program_file(py::module_& m);
void bind_cut_search(py::module_& m);
void bind_verify(py::module_& m);
void bind_cluster(py::module_& m);
void bind_pen(py::module_& m);
void bind_pen_device(py::module_& m);
void bind_journal(py::module_& m);
void bind_session(py::module_& m);
void bind_collide(py::module_& m);
void bind_path(py::module_& m);
void bind_pencil(py::module_& m);
void bind_strategies(py::module_& m);
void bind_plan(py::module_& m);
void bind_operations(py::module_& m);
void bind_tasks(py::module_& m);

/// A numpy array of doubles in C order; any array-like converts.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Throws ValueError naming `name` unless `array` has the shape (n, columns) and only finite values (naming the row).
/// Returns n.
std::size_t check_rows(const Doubles& array, std::size_t columns, const char* name);

/// Three numbers from any sequence; ValueError naming `name`.
Vec3 to_vec3(const py::object& object, const char* name);
py::array_t<double> from_vec3(const Vec3& v);
/// `own` with the corners that are not None; ValueError naming "lower" or "upper".
Box3 box_or(const Box3& own, const py::object& lower, const py::object& upper);
/// A (4, 4) matrix whose last row is 0, 0, 0, 1, as the map p → first p + second. ValueError naming the argument.
std::pair<Mat3, Vec3> to_affine(const py::object& object, const std::string& name);
/// (n, 3) copy.
py::array_t<double> from_vec3s(const std::vector<Vec3>& v);

/// (n, 3), checked as by check_rows.
std::vector<Vec3> to_vec3s(const Doubles& array, const char* name);

/// (n, 6): tip xyz, axis xyz; checked as by check_rows.
std::vector<Pose> to_poses(const Doubles& array, const char* name);
/// (n, 9): tip xyz, axis xyz, forward xyz; checked as by check_rows.
std::vector<RolledPose> to_rolled_poses(const Doubles& array, const char* name);
/// Whether tools of this kind, as in Tool.to_dict(), are hand tools.
bool is_hand_tool(const std::string& kind);
/// (n, 6) for a tool of revolution, (n, 9) for a hand tool; the other one is empty.
struct PosesOf {
  std::vector<Pose> plain;
  std::vector<RolledPose> rolled;
  std::size_t rows() const { return plain.size() + rolled.size(); }
};
PosesOf to_poses_of(const Tool& tool, const Doubles& array, const char* name);
/// (n, 6) and (n, 9) copies.
py::array_t<double> from_poses(const std::vector<Pose>& poses);
py::array_t<double> from_poses(const std::vector<RolledPose>& poses);

/// A Tool, its dict, or JSON text of it → JSON text in one form.
std::string tool_json(const py::object& tool);

/// From "remove" or "add"; ValueError with both.
sweep::CarveMode to_carve_mode(const std::string& mode);

/// "cutter", "shank", "holder" or "fixture".
const char* name_of(collide::Touch touch);

/// (axis, angle), or None: no limit.
std::optional<plan::AxisLimit> to_axis_limit(const py::object& object, bool project = false);

/// Hands a vector's storage to numpy without a copy; shape (rows, columns), or (rows,) for columns = 0.
template <class T, class V, class A>
py::array_t<T> take(std::vector<V, A>&& values, std::size_t columns = 0) {
  auto* owned = new std::vector<V, A>(std::move(values));
  const py::capsule free(owned, [](void* p) { delete static_cast<std::vector<V, A>*>(p); });
  const auto n = static_cast<py::ssize_t>(owned->size() * sizeof(V) / sizeof(T));
  const auto wide = static_cast<py::ssize_t>(columns);
  const T* data = reinterpret_cast<const T*>(owned->data());
  if (wide == 0) return py::array_t<T>(n, data, free);
  return py::array_t<T>({n / wide, wide}, data, free);
}

/// The class of tasks, by which `riffler.submit` asks a call for a task; null in modules without tasks.
PyObject*& task_request();
/// The error of a call that can give none.
PyObject*& task_refusal();

/// A Python callable as Progress, for calls that released the GIL: takes it back, lets Ctrl-C through, and cancels
/// where the callable returns False (None and anything else continue). Empty for None, but Ctrl-C still works.
Progress to_progress(const py::object& callable);

/// Options of machines and posts, from a dict or None: numbers, lists of them, bools, texts.
nc::Options to_options(const py::object& object);

}  // namespace riffler::bindings
