// C++ exceptions as Python's, in one place.
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "bindings/bindings.hpp"
#include "riffler/base/error.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::bindings {

namespace {

/// A message may name a file whose name is not UTF-8: those bytes are written as \xNN.
void set(const py::handle& type, std::string_view message) {
  const auto text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(message.data(), static_cast<py::ssize_t>(message.size()), "backslashreplace"));
  if (text) PyErr_SetObject(type.ptr(), text.ptr());
}

/// What the caller calls the C++ type that a value was to become.
const char* expected(std::string_view type) {
  const auto has = [&](const char* name) { return type.find(name) != std::string_view::npos; };
  if (has("array_t") || has("vector")) return "an array of numbers";
  if (has("pair") || has("tuple")) return "a pair";
  if (has("basic_string")) return "text that is valid Unicode";
  if (has("bool")) return "True or False";
  if (has("double") || has("float")) return "a number";
  if (has("int") || has("long") || has("short")) return "a whole number in range";
  return "a value of another type";
}

/// pybind11's message names both types: "… of type <class 'str'> to C++ type 'double'".
std::string cast_message(std::string_view what) {
  const std::size_t from = what.find("<class '"), to = what.find("C++ type '");
  if (from == std::string_view::npos || to == std::string_view::npos) return "a value of another type was expected";
  const std::string_view given = what.substr(from + 8, what.find('\'', from + 8) - from - 8);
  return std::string(expected(what.substr(to + 10))) + " was expected, not this " + std::string(given);
}

PyObject* kind_of(const std::exception& e) {
  const auto is = [&](const auto* type) { return type != nullptr; };
  if (is(dynamic_cast<const std::bad_alloc*>(&e))) return PyExc_MemoryError;
  if (is(dynamic_cast<const std::out_of_range*>(&e)) || is(dynamic_cast<const py::index_error*>(&e)))
    return PyExc_IndexError;
  if (is(dynamic_cast<const std::overflow_error*>(&e))) return PyExc_OverflowError;
  if (is(dynamic_cast<const std::invalid_argument*>(&e)) || is(dynamic_cast<const std::domain_error*>(&e)) ||
      is(dynamic_cast<const std::length_error*>(&e)) || is(dynamic_cast<const std::range_error*>(&e)) ||
      is(dynamic_cast<const py::value_error*>(&e)))
    return PyExc_ValueError;
  if (is(dynamic_cast<const py::type_error*>(&e))) return PyExc_TypeError;
  if (is(dynamic_cast<const py::builtin_exception*>(&e))) return nullptr;
  return PyExc_RuntimeError;
}

py::handle format_error, cancelled;

void translate(std::exception_ptr p) {
  try {
    std::rethrow_exception(std::move(p));
  } catch (const py::error_already_set&) {
    throw;
  } catch (const py::cast_error& e) {
    set(PyExc_ValueError, cast_message(e.what()));
  } catch (const FormatError& e) {
    set(format_error, e.what());
  } catch (const Cancelled& e) {
    set(cancelled, e.what());
  } catch (const pen::OpenError& e) {
    set(py::module_::import("riffler._core").attr("PenError"), e.what());
  } catch (const std::exception& e) {
    PyObject* const kind = kind_of(e);
    if (!kind) throw;  // pybind11's own, such as the end of an iteration
    set(kind, e.what());
  }
}

/// What pybind11 calls for the storage of an object that no constructor has made, and would read as if one had.
void* refuse_unmade(std::size_t) {
  throw py::type_error("the object was made by __new__ alone: its __init__ was never called");
}

}  // namespace

void bind_errors(py::module_& m) {
  const auto format = py::register_exception<FormatError>(m, "FormatError", PyExc_ValueError);
  format.attr("__doc__") = "A file with invalid content. Names the file, the line or byte, and what was expected.";
  const auto cancel = py::register_exception<Cancelled>(m, "Cancelled", PyExc_RuntimeError);
  cancel.attr("__doc__") = "A long call was stopped by its progress callback. The object is unchanged.";
  translate_errors(m);
}

void translate_errors(const py::module_& core) {
  format_error = py::object(core.attr("FormatError")), cancelled = py::object(core.attr("Cancelled"));
  py::register_local_exception_translator(&translate);
}

void refuse_objects_without_init(const py::module_& m) {
  for (const auto& [name, value] : py::cast<py::dict>(m.attr("__dict__"))) {
    if (!PyType_Check(value.ptr())) continue;
    if (auto* const type = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr())))
      type->operator_new = &refuse_unmade;
  }
}

}  // namespace riffler::bindings
