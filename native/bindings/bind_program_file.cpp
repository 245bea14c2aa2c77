// riffler.Program.save, .load, .to_bytes, and pickling: programs to the bit.
#include "base/bytes.hpp"
#include "bindings/program_arguments.hpp"
#include "riffler/nc/program_file.hpp"

namespace riffler::bindings {

namespace {

/// The bytes of a read-only buffer, which must outlive them.
ByteView view_of(const py::bytes& bytes) {
  const auto text = std::string_view(bytes);
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

py::bytes bytes_of(const nc::Program& program) {
  std::vector<std::uint8_t> bytes;
  {
    const NoGil release;
    bytes = to_bytes(program);
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

nc::Program program_of(const py::bytes& bytes) {
  const ByteView view = view_of(bytes);
  const NoGil release;
  return nc::parse_program(view, "program");
}

void save(const nc::Program& program, const std::filesystem::path& path, const py::object& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  save_program(program, path, listener);
}

nc::Program load(const std::filesystem::path& path, const py::object& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  return nc::load_program(path, listener);
}

}  // namespace

void bind_program_file(py::module_& m) {
  ProgramClass program = program_class(m);
  program
      .def("save", &save, py::arg("path"), py::arg("progress") = py::none(),
           R"(Writes a .rprog file, whole or not at all: everything to the bit, which NC code cannot keep.

The same program gives the same bytes.)")
      .def_static("load", &load, py::arg("path"), py::arg("progress") = py::none(),
                  "Reads a .rprog file; FormatError naming the byte where it is damaged or not one.")
      .def("to_bytes", &bytes_of, "The bytes of the .rprog file.")
      .def_static("from_bytes", &program_of, py::arg("data"), "A program from the bytes of a .rprog file.")
      .def(py::pickle(&bytes_of, &program_of));
}

}  // namespace riffler::bindings
