// What riffler.files is made of. Not public.
#include "base/atomic_file.hpp"
#include "base/io.hpp"
#include "bindings/bindings.hpp"

namespace riffler::bindings {

void bind_files(py::module_& m) {
  py::class_<base::AtomicFileWriter>(m, "AtomicFileWriter", R"(A file that takes the place of ``path`` at ``commit``.

Links are followed; permissions and owner of a file that is there are kept; RuntimeError if it is not a regular file.)")
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
      py::arg("path"), "The file's bytes. FormatError where there is none, and for a folder, a pipe or a device.");
  m.def("replaceable", &base::replaceable, py::arg("path"),
        "Where a path leads, links followed. RuntimeError if it is not a regular file.");
  m.def("replace_file", &base::replace_file, py::arg("draft"), py::arg("path"),
        "``draft``, on the same file system, takes the place of ``path`` as an AtomicFileWriter's does.");
  m.def("draft_prefix", &base::draft_prefix, py::arg("path"), "Path with which the names of drafts of ``path`` begin.");
  m.def("clear_drafts", &base::clear_drafts, py::arg("path"),
        "Removes drafts of ``path`` that no process has locked: processes that were killed left them.");
}

}  // namespace riffler::bindings
