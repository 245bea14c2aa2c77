// Calls whose arguments do not fit are answered by riffler.hints; calls whose arguments fit pay nothing for it.
//
// pybind11 makes each function a PyCFunction whose method table belongs to this function alone. Here its entry is
// replaced by one that calls the old entry and looks at an error only. The function stays what it was for pickle, help
// and isinstance; a signature at the head of its docstring lets inspect.signature see the arguments. Entries of
// pybind11 3.0 take a tuple and a dict, those of 3.1 take an array and names (METH_FASTCALL).
#include <cstring>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bindings/bindings.hpp"

namespace riffler::bindings {

namespace {

struct Known {
  std::string name;    // "Volume.carve"
  PyObject* function;  // lives as long as the module
};

/// By the record that a function hands to its entry as `self`.
std::unordered_map<PyObject*, Known>& known() {
  static auto* const all = new std::unordered_map<PyObject*, Known>;  // functions may be called until Python is gone
  return *all;
}

using FastEntry = PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*);

// pybind11's own entry, the same for every function: one of the two is set.
PyCFunctionWithKeywords dispatch = nullptr;
FastEntry dispatch_fast = nullptr;

/// pybind11's words for arguments that fit no overload of this function, and not those of a callback's call.
bool is_misfit(const std::string& message, const std::string& name) {
  const std::string own = name.substr(name.rfind('.') + 1) + "(): incompatible ";
  return message.starts_with(own);
}

/// With the TypeError pending: what riffler.hints returns for the call, or null with the error it raises.
PyObject* answer(PyObject* record, PyObject* args, PyObject* kwargs) {
  const auto found = known().find(record);
  if (found == known().end()) return nullptr;
  py::error_already_set error;
  try {
    const auto message = py::cast<std::string>(py::str(error.value()));
    if (!is_misfit(message, found->second.name)) {
      error.restore();
      return nullptr;
    }
    const py::object keywords = kwargs ? py::reinterpret_borrow<py::object>(kwargs) : py::dict();
    return py::module_::import("riffler.hints")
        .attr("answer_native")(found->second.name, py::handle(found->second.function), py::handle(args), keywords)
        .release()
        .ptr();
  } catch (py::error_already_set& raised) {
    raised.restore();
    return nullptr;
  }
}

PyObject* call(PyObject* record, PyObject* args, PyObject* kwargs) {
  PyObject* const found = dispatch(record, args, kwargs);
  if (found || !PyErr_ExceptionMatches(PyExc_TypeError)) return found;
  return answer(record, args, kwargs);
}

PyObject* call_fast(PyObject* record, PyObject* const* args, Py_ssize_t count, PyObject* names) {
  PyObject* const found = dispatch_fast(record, args, count, names);
  if (found || !PyErr_ExceptionMatches(PyExc_TypeError)) return found;
  py::error_already_set error;
  py::tuple positional(count);
  py::dict keywords;
  for (Py_ssize_t k = 0; k < count; ++k) positional[static_cast<std::size_t>(k)] = py::handle(args[k]);
  for (Py_ssize_t k = 0; names && k < PyTuple_GET_SIZE(names); ++k)
    keywords[py::handle(PyTuple_GET_ITEM(names, k))] = py::handle(args[count + k]);
  error.restore();
  return answer(record, positional.ptr(), keywords.ptr());
}

/// Reads the first line of a docstring of pybind11, "name(self: T, a: X, b: Y = 1) -> Z", argument by argument.
class SignatureReader {
 public:
  explicit SignatureReader(std::string_view line) : line_(line) {}

  /// "name(self, a, b=1)", or nothing if the line is not such a signature.
  std::string plain() {
    const std::size_t open = line_.find('(');
    if (open == std::string_view::npos) return {};
    std::string out(line_.substr(0, open + 1));
    std::size_t begin = open + 1;
    int depth = 0;
    char quote = 0;
    for (std::size_t k = begin; k < line_.size(); ++k) {
      const char c = line_[k];
      if (quote) {
        if (c == quote) quote = 0;
      } else if (c == '\'' || c == '"') {
        quote = c;
      } else if (depth == 0 && (c == ',' || c == ')')) {
        add(out, line_.substr(begin, k - begin));
        begin = k + 1;
        if (c == ')') return out + ")";
      } else {
        depth += (c == '(' || c == '[' || c == '{') - (c == ')' || c == ']' || c == '}');
      }
    }
    return {};
  }

 private:
  static std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
  }

  static void add(std::string& out, std::string_view argument) {
    argument = trimmed(argument);
    if (argument.empty()) return;
    if (!out.ends_with('(')) out += ", ";
    out += trimmed(argument.substr(0, argument.find(':')));
    if (const std::size_t equals = argument.rfind(" = "); equals != std::string_view::npos)
      out += "=" + std::string(literal(argument.substr(equals + 3)));
  }

  /// A default as Python's parser of such signatures takes it: anything but a literal is written as "...".
  static std::string_view literal(std::string_view text) {
    const bool plain = text.find('<') == std::string_view::npos && text.find("inf") == std::string_view::npos &&
                       text.find("nan") == std::string_view::npos;
    return plain ? text : "...";
  }

  std::string_view line_;
};

std::string signature_in(const char* doc) {
  const std::string_view text(doc);
  return SignatureReader(text.substr(0, text.find('\n'))).plain();
}

/// Python takes what stands before the dashes for the signature, and leaves it out of __doc__.
std::string with_signature(const std::string& signature, const char* doc) {
  return signature + "\n--\n\n" + doc;
}

PyObject* plain_function(PyObject* object) {
  if (PyInstanceMethod_Check(object)) object = PyInstanceMethod_GET_FUNCTION(object);
  if (Py_IS_TYPE(object, &PyStaticMethod_Type)) {
    const py::object inner = py::reinterpret_borrow<py::object>(object).attr("__func__");
    object = inner.ptr();  // which the static method keeps
  }
  return PyCFunction_CheckExact(object) ? object : nullptr;
}

/// Puts our entry in the place of the one in a method table, and keeps that in `own`. Returns whether it did: every
/// function of pybind11 has the same entry, and others are left alone.
template <typename Entry>
bool replace_entry(PyMethodDef& table, Entry& own, Entry ours) {
  const auto entry = reinterpret_cast<Entry>(reinterpret_cast<void (*)()>(table.ml_meth));
  if (!own) own = entry;
  if (entry != own) return false;
  table.ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(ours));
  return true;
}

/// Puts our entry in the place of pybind11's. Returns the signature, empty where there is none.
std::string hook(PyObject* function, const std::string& name) {
  PyMethodDef* const table = reinterpret_cast<PyCFunctionObject*>(function)->m_ml;
  PyObject* const record = PyCFunction_GET_SELF(function);
  if (!record || known().contains(record)) return {};
  const bool replaced = table->ml_flags == (METH_VARARGS | METH_KEYWORDS) ? replace_entry(*table, dispatch, &call)
                        : table->ml_flags == (METH_FASTCALL | METH_KEYWORDS)
                            ? replace_entry(*table, dispatch_fast, &call_fast)
                            : false;
  if (!replaced) return {};
  known().emplace(record, Known{name, function});
  if (!table->ml_doc) return {};
  const std::string signature = signature_in(table->ml_doc);
  if (signature.empty()) return {};
  // pybind11 frees it with free().
  char* const text = ::strdup(with_signature(signature, table->ml_doc).c_str());
  std::free(const_cast<char*>(table->ml_doc));
  table->ml_doc = text;
  return signature;
}

/// inspect.signature(Class) reads the head of the class's docstring: the arguments of __init__ without self.
void set_class_signature(PyTypeObject* type, const std::string& init) {
  const std::size_t comma = init.find(", ");
  const std::string arguments = comma == std::string::npos ? ")" : init.substr(comma + 2);
  const std::string_view full(type->tp_name);
  const std::string name(full.substr(full.rfind('.') + 1));
  const std::string text = with_signature(name + "(" + arguments, type->tp_doc ? type->tp_doc : "");
  auto* const owned = static_cast<char*>(PyObject_Malloc(text.size() + 1));
  if (!owned) return;
  std::memcpy(owned, text.c_str(), text.size() + 1);
  PyObject_Free(const_cast<char*>(type->tp_doc));
  type->tp_doc = owned;
}

void hook_class(const py::handle& type, const std::string& name) {
  for (const auto& [key, value] : py::dict(type.attr("__dict__"))) {
    PyObject* const function = plain_function(value.ptr());
    if (!function) continue;
    const auto method = py::cast<std::string>(key);
    const std::string signature = hook(function, name + "." + method);
    if (method == "__init__" && !signature.empty())
      set_class_signature(reinterpret_cast<PyTypeObject*>(type.ptr()), signature);
  }
}

}  // namespace

void answer_misfits(const py::module_& m) {
  for (const auto& [key, value] : py::cast<py::dict>(m.attr("__dict__"))) {
    const auto name = py::cast<std::string>(key);
    if (PyType_Check(value.ptr()) && py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr())))
      hook_class(value, name);
    else if (PyObject* const function = plain_function(value.ptr()))
      hook(function, name);
  }
}

}  // namespace riffler::bindings
