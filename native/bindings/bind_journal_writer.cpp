// riffler.JournalWriter
#include "bindings/journal_records.hpp"
#include "bindings/one_caller.hpp"
#include "riffler/session/journal_file.hpp"

namespace riffler::bindings {

namespace {

/// Syncing waits for the disk without the GIL.
struct SharedWriter : session::JournalWriter, Guarded {
  using session::JournalWriter::JournalWriter;
};

/// Held while a journal is written to.
OneCaller only_caller(SharedWriter& writer) {
  return {writer, "the journal"};
}

void close(SharedWriter& writer) {
  const OneCaller only = only_caller(writer);
  writer.close();
}

}  // namespace

void bind_journal_writer(py::module_& m) {
  py::class_<SharedWriter> writer(m, "JournalWriter", R"(Appends to a journal file, record by record. Context manager.

Continues an existing file, after cutting off a damaged tail, or begins a new one. Each record is passed to the
system before the call returns.

Parameters
----------
path : path_like
    The .rjournal file.
keep : bool
    False: holds no strokes in memory, for long sessions; ``journal`` cannot be used then.

Examples
--------
>>> with riffler.JournalWriter("a.rjournal") as writer:
...     writer.set_stock((0, 0, 0), (20, 20, 10), 0.5)
...     writer.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
...     writer.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
>>> len(riffler.Journal.load("a.rjournal").strokes)
1
)");
  writer
      .def(py::init([](const std::filesystem::path& path, bool keep) {
             return std::make_unique<SharedWriter>(
                 path, keep ? session::JournalWriter::Keep::Everything : session::JournalWriter::Keep::Rules);
           }),
           py::arg("path"), py::kw_only(), py::arg("keep") = true)
      .def(
          "sync",
          [](SharedWriter& self) {
            const OneCaller only = only_caller(self);
            const NoGil release;
            self.sync();
          },
          R"(Waits until everything is on the disk.

Examples
--------
>>> with riffler.JournalWriter("a.rjournal") as writer:
...     writer.sync()
)")
      .def("close", &close, R"(Closes the file; later calls raise RuntimeError.

Examples
--------
>>> writer = riffler.JournalWriter("a.rjournal")
>>> writer.close()
)")
      .def_property_readonly(
          "journal", [](const SharedWriter& self) { return std::make_shared<session::Journal>(self.journal()); },
          "A copy of everything in the file.")
      .def("__enter__", [](const py::object& self) -> Self { return self; })
      .def("__exit__", [](SharedWriter& self, const py::args&) { close(self); });
  add_records(writer, &only_caller);
}

}  // namespace riffler::bindings
