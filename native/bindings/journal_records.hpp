// The functions that Journal and JournalWriter share.
#pragma once

#include "bindings/journal_arguments.hpp"

namespace riffler::bindings {

/// `only_caller(T&)` returns a lock that lives during a call, or nothing that matters.
template <class Class, class Lock>
void add_records(Class& c, Lock only_caller) {
  using T = typename Class::type;
  c.def(
       "set_stock",
       [only_caller](T& self, const ArrayLike& lower, const ArrayLike& upper, double pitch,
                     const std::string& directions, const std::string& snapshot, const std::string& mask) {
         [[maybe_unused]] const auto only = only_caller(self);
         self.set_stock(to_stock(lower, upper, pitch, directions, snapshot, mask));
       },
       py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z", py::kw_only(),
       py::arg("snapshot") = "", py::arg("mask") = "",
       R"(Records the frame of the stock. Call it once.

Parameters
----------
lower, upper : array_like, shape (3,)
    Corners of its box, mm.
pitch : float
    mm.
directions : {"z", "xyz"}
    As of the Volume.
snapshot : str
    Name of the file with the stock, if it is not a full block.
mask : str
    Name of the file with the protected region, if any.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
>>> journal.stock.pitch
0.5
)")
      .def(
          "add_tool",
          [only_caller](T& self, int number, const ToolLike& tool) {
            const std::string text = tool_json(tool);
            [[maybe_unused]] const auto only = only_caller(self);
            self.add_tool(number, text);
          },
          py::arg("number"), py::arg("tool"),
          R"(Records a tool. The same number again is allowed for the same tool only.

Parameters
----------
number : int
    Number by which strokes refer to it.
tool : Tool, dict or str
    A Tool, its dict or JSON text of it.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> list(journal.tools)
[1]
)")
      .def(
          "add_note",
          [only_caller](T& self, const std::string& key, const std::string& value) {
            [[maybe_unused]] const auto only = only_caller(self);
            self.add_note(key, value);
          },
          py::arg("key"), py::arg("value"),
          R"(Adds one key/value note on where the journal comes from.

Parameters
----------
key, value : str
    If a key is given twice, the later value counts.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_note("operator", "Ada")
>>> journal.notes
{'operator': 'Ada'}
)")
      .def(
          "add_stroke",
          [only_caller](T& self, int tool, const Doubles& poses, const OptionalArrayLike& times, double tolerance,
                        const std::string& name, const OptionalArrayLike& forces, const OptionalArrayLike& removed,
                        const std::string& mode, double strength, double amount, const std::string& falloff) {
            session::JournalStroke stroke = to_rows(poses, times, forces, removed);
            stroke.tool = tool, stroke.tolerance = tolerance, stroke.name = name, stroke.mode = to_stroke_mode(mode);
            stroke.strength = strength, stroke.amount = amount, stroke.falloff = to_falloff(falloff);
            [[maybe_unused]] const auto only = only_caller(self);
            check_roll(self.rules(), stroke);
            self.add_stroke(stroke);
          },
          py::arg("tool"), py::arg("poses"), py::kw_only(), py::arg("times") = py::none(), py::arg("tolerance") = 0.01,
          py::arg("name") = "", py::arg("forces") = py::none(), py::arg("removed") = py::none(),
          py::arg("mode") = "remove", py::arg("strength") = 0.5, py::arg("amount") = 0.0, py::arg("falloff") = "smooth",
          R"(Records a stroke. Replay is exact to the bit for ``carve`` in mode "add" or with a mask only if each carve is one stroke.

Parameters
----------
tool : int
    Number of an added tool.
poses : array_like, shape (n, 6)
    Tip in mm and unit axis, n at least 1. For a hand tool (n, 9), as in ``Volume.carve``.
times : array_like, shape (n,), optional
    s, never falling.
tolerance : float
    mm, as in ``Volume.carve``.
name : str
    Name for users.
forces : array_like, shape (n, 6), optional
    N and N·mm as sent to the device for the hand, about the grip.
removed : array_like, shape (n,), optional
    mm³ by the move that ends at the row.
mode : {"remove", "add", "mask", "unmask", "soften", "beside", "build", "clay", "inflate", …}
    What the tool does where it sweeps: "remove" and "add" material, but not where it is protected; "mask" and "unmask":
    protect it, or no longer; "soften": a smoothing dab at each row's tip, as wide as the tool; "beside": remove as a
    Session does next to what is protected; "build": add as a Session does. Any brush of ``Volume.brush``: its dabs at
    the rows, as wide as the tool.
strength : float
    Of "soften" and brushes, 0 to 1.
amount : float
    Of brushes, mm or rad.
falloff : str
    Of brushes.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)], times=(0, 1))
>>> len(journal.strokes)
1
)")
      .def(
          "extend_stroke",
          [only_caller](T& self, const Doubles& poses, const OptionalArrayLike& times, const OptionalArrayLike& forces,
                        const OptionalArrayLike& removed) {
            const session::JournalStroke more = to_rows(poses, times, forces, removed);
            [[maybe_unused]] const auto only = only_caller(self);
            self.extend_stroke(more.rows());
          },
          py::arg("poses"), py::kw_only(), py::arg("times") = py::none(), py::arg("forces") = py::none(),
          py::arg("removed") = py::none(), R"(Adds rows to the last stroke, with the same columns.

Parameters
----------
poses : array_like, shape (n, 6)
    Tip in mm and unit axis; (n, 9) for a hand tool.
times, forces, removed : array_like, optional
    As of ``add_stroke``.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
>>> journal.extend_stroke([(20, 10, 8, 0, 0, 1)])
>>> len(journal.strokes[0])
2
)")
      .def(
          "undo",
          [only_caller](T& self, std::size_t n) {
            [[maybe_unused]] const auto only = only_caller(self);
            self.undo(n);
          },
          py::arg("n") = 1, R"(Undoes the last strokes: they no longer count.

Parameters
----------
n : int
    Number of strokes.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
>>> journal.undo()
>>> len(journal.strokes)
0
)")
      .def(
          "redo",
          [only_caller](T& self, std::size_t n) {
            [[maybe_unused]] const auto only = only_caller(self);
            self.redo(n);
          },
          py::arg("n") = 1, R"(Redoes the last strokes that were undone, unless a new stroke has begun.

Parameters
----------
n : int
    Number of strokes.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
>>> journal.undo()
>>> journal.redo()
>>> len(journal.strokes)
1
)");
}

}  // namespace riffler::bindings
