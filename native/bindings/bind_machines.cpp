// riffler.machines, riffler.machine_options, and the options of machines and posts.
#include "bindings/program_arguments.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/option_texts.hpp"
#include "nc/machine/post_options.hpp"

namespace riffler::bindings {

namespace {

StringDict machine_list() {
  py::dict out;
  for (const base::DescriptionEntry& entry : nc::machines()) out[py::str(entry.name)] = entry.description;
  return out;
}

py::object value_of(const nc::OptionValue& value) {
  return std::visit([](const auto& v) -> py::object { return py::cast(v); }, value);
}

const char* name_of(nc::OptionFact::Kind kind) {
  static constexpr const char* kNames[] = {"number", "positive", "numbers", "range", "flag", "word", "path"};
  return kNames[static_cast<std::size_t>(kind)];
}

MachineOptions option_list(const std::string& machine, const OptionsLike& options) {
  using namespace py::literals;
  py::list out;
  for (const nc::MachineOption& option : nc::machine_options(machine, to_options(options))) {
    const nc::OptionFact& fact = option.fact;
    out.append(program_result(
        "MachineOption",
        py::dict("name"_a = fact.name, "kind"_a = name_of(fact.kind), "count"_a = fact.most, "unit"_a = option.unit,
                 "words"_a = fact.words, "value"_a = fact.value ? value_of(*fact.value) : py::object(py::none()),
                 "needed"_a = fact.needed, "own"_a = option.own, "about"_a = fact.about)));
  }
  return out;
}

MachineTextsResult texts(const std::string& machine) {
  using namespace py::literals;
  const nc::MachineTexts found = nc::texts_of_machine(machine);
  return program_result("MachineTexts", py::dict("description"_a = found.summary, "language"_a = found.language,
                                                 "extension"_a = nc::file_extension(found.language),
                                                 "translations"_a = found.translations));
}

/// A dict of numbers, such as tool_diameters, as a list: each key before its value.
std::vector<double> to_pairs(const py::dict& dict, const std::string& name) {
  std::vector<double> out;
  for (const auto& [key, value] : dict) {
    try {
      out.push_back(py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(key))));
      out.push_back(py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(value))));
    } catch (const py::error_already_set&) {
      throw py::value_error("option " + name + " must have numbers only");
    }
  }
  return out;
}

}  // namespace

nc::Options to_options(const py::object& object) {
  nc::Options out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("options must be a dict");
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    const std::string name = py::cast<std::string>(py::str(key));
    if (py::isinstance<py::bool_>(value)) {
      out[name] = py::cast<bool>(value);
    } else if (py::isinstance<py::str>(value)) {
      out[name] = py::cast<std::string>(value);
    } else if (py::isinstance<py::dict>(value)) {
      out[name] = to_pairs(py::reinterpret_borrow<py::dict>(value), name);
    } else {
      const Doubles array = to_doubles(value, "option " + name);
      if (array.ndim() > 1)
        throw py::value_error("option " + name + " must be a number, a list of them, a bool or a str");
      if (array.ndim() == 0)
        out[name] = *array.data();
      else
        out[name] = std::vector<double>(array.data(), array.data() + array.size());
    }
  }
  return out;
}

void bind_machines(py::module_& m) {
  m.def("machines", &machine_list,
        R"(The machines that riffler can write and read programs for, shipped ones and your own.

A post has its machine's name. Instead of a machine's name you can pass the path of a .toml file that describes one.

Returns
-------
dict
    Name to description.

Examples
--------
>>> "linuxcnc-xyzac" in riffler.machines()
True
)");

  m.def("machine_texts", &texts, py::arg("machine"),
        R"(The texts of a machine's file, and the language of its control.

Parameters
----------
machine : str
    A name of ``machines``, or the path of a .toml file.

Returns
-------
MachineTexts

Raises
------
ValueError
    For an unknown machine, and a file that cannot be read.

Examples
--------
>>> riffler.machine_texts("heidenhain").extension
'.h'
)");

  m.def("machine_options", &option_list, py::arg("machine"), py::kw_only(), py::arg("options") = py::none(),
        R"(The options that a machine takes, its own first, and those of the code that is written for it.

Parameters
----------
machine : str
    A name of ``machines``, or the path of a .toml file.
options : dict, optional
    Given options, which may make others required.

Returns
-------
list of MachineOption

Raises
------
ValueError
    For an unknown machine, and for wrong options.

Examples
--------
>>> [option.name for option in riffler.machine_options("linuxcnc-xyzac") if option.own]
['offset', 'rot_point', 'tool_offset']
)");
}

}  // namespace riffler::bindings
