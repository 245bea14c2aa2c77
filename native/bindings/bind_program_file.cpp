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

void save(const nc::Program& program, const std::filesystem::path& path, const ProgressLike& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  save_program(program, path, listener);
}

nc::Program load(const std::filesystem::path& path, const ProgressLike& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  return nc::load_program(path, listener);
}

}  // namespace

void bind_program_file(py::module_& m) {
  ProgramClass program = program_class(m);
  program
      .def("save", &save, py::arg("path"), py::kw_only(), py::arg("progress") = py::none(),
           R"(Writes a .rprog file: everything to the bit, which NC code cannot keep.

Writes the whole file or none. The same program gives the same bytes.

Parameters
----------
path : path_like
    The file.
progress : callable, optional
    Called with the finished share; returning False cancels.

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> program.save("part.rprog")
>>> len(riffler.Program.load("part.rprog"))
5
)")
      .def_static("load", &load, py::arg("path"), py::kw_only(), py::arg("progress") = py::none(),
                  R"(Reads a .rprog file.

Parameters
----------
path : path_like
    The file.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
Program

Raises
------
FormatError
    Naming the byte, if the file is damaged or not a .rprog file.

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> program.save("part.rprog")
>>> bool((riffler.Program.load("part.rprog").poses == program.poses).all())
True
)")
      .def("to_bytes", &bytes_of, R"(The bytes of the .rprog file.

Returns
-------
bytes

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> len(riffler.Program.from_bytes(program.to_bytes()))
5
)")
      .def_static("from_bytes", &program_of, py::arg("data"), R"(A program from the bytes of a .rprog file.

Parameters
----------
data : bytes
    As ``to_bytes`` makes them.

Returns
-------
Program

Raises
------
FormatError
    Naming the byte.

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> len(riffler.Program.from_bytes(program.to_bytes()))
5
)")
      .def(py::pickle(&bytes_of, &program_of));
}

}  // namespace riffler::bindings
