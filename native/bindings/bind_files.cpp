// What riffler.files is made of. Not public.
#include "base/atomic_file.hpp"
#include "base/io.hpp"
#include "bindings/bindings.hpp"

namespace riffler::bindings {

void bind_files(py::module_& m) {
  py::class_<base::AtomicFileWriter>(m, "AtomicFileWriter", R"(A file that replaces ``path`` at ``commit``.

Follows links; keeps permissions and owner of an existing file. RuntimeError if ``path`` is not a regular file.)")
      .def(py::init<const std::filesystem::path&>(), py::arg("path"))
      .def("fileno", &base::AtomicFileWriter::descriptor,
           "File descriptor of the draft, which is written to; -1 after ``commit``.")
      .def(
          "commit",
          [](base::AtomicFileWriter& self) {
            if (self.descriptor() < 0) throw std::runtime_error("the file is written already");
            // With the GIL: another thread's call would find the descriptor closed.
            self.commit();
          },
          "Once.");
  m.def(
      "read_file",
      [](const std::filesystem::path& path) {
        std::vector<std::uint8_t> bytes;
        {
          const NoGil release;
          bytes = base::read_file(path);
        }
        return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      },
      py::arg("path"), "The file's bytes. FormatError if there is no file, and for a folder, a pipe or a device.");
  m.def("replaceable", &base::replaceable, py::arg("path"),
        "Target of a path after following links. RuntimeError if it is not a regular file.");
  m.def("replace_file", &base::replace_file, py::arg("draft"), py::arg("path"),
        "Replaces ``path`` with ``draft``, on the same file system, like AtomicFileWriter.");
  m.def("draft_prefix", &base::draft_prefix, py::arg("path"), "Path with which the names of drafts of ``path`` begin.");
  m.def("clear_drafts", &base::clear_drafts, py::arg("path"),
        "Removes drafts of ``path`` that no process has locked: processes that were killed left them.");
}

}  // namespace riffler::bindings
