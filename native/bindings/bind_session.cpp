// riffler.Session
#include "base/path_text.hpp"
#include "bindings/session_class.hpp"
#include "bindings/session_frame.hpp"
#include "riffler/dexel/file/file.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;
RIFFLER_TYPED(VolumeResult, "Volume")

/// The mode of all its strokes.
session::StrokeMode stroke_mode(const SharedSession& self) {
  if (self.mode == sweep::CarveMode::Add) return session::StrokeMode::Build;
  return self.mask ? session::StrokeMode::Beside : session::StrokeMode::Remove;
}

/// Writes stock and tool at the journal's beginning, then the strokes during the session.
void record(SharedSession& self, const std::filesystem::path& path, const py::dict& notes) {
  const Using use(self);
  if (self.sink) throw std::runtime_error("the session has a journal already");
  const auto beside = [&](const char* end) {
    std::filesystem::path p = path;
    return p.replace_extension().concat(end);
  };
  const std::filesystem::path snapshot = beside("-stock.rvol"), mask = beside("-mask.rvol");
  for (const std::filesystem::path& p : {path, snapshot, mask})
    if (std::filesystem::exists(p))
      throw py::value_error(base::file_name(p) + " is there already: take another name, or move it away");
  save(use.volume, snapshot);
  if (self.mask) save(*self.mask, mask);
  auto writer = std::make_unique<session::JournalWriter>(path, session::JournalWriter::Keep::Rules);
  const dexel::Frame& frame = use.volume.frame();
  for (const auto& [key, value] : notes) writer->add_note(py::cast<std::string>(key), py::cast<std::string>(value));
  writer->set_stock(
      {frame.box, frame.pitch, frame.directions, base::file_name(snapshot), self.mask ? base::file_name(mask) : ""});
  writer->add_tool(1, tool_json(py::cast(self.tool)));
  writer->sync();
  session::JournalStreamOptions options;
  options.mode = stroke_mode(self);
  auto sink = std::make_shared<session::JournalSink>(std::move(writer), 1, self.carving.tolerance, options);
  self.session->record(sink);
  self.sink = std::move(sink);
}

FrameView with_last(SharedSession& self, session::SessionFrame&& frame) {
  if (!frame.ticks.empty()) self.last = frame.ticks.back();
  return {std::move(frame), self.last};
}

FrameView frame(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  return with_last(self, self.session->frame(use.volume));
}

/// What the journal says of the session after its strokes.
session::JournalNotes last_notes(const SharedSession& self) {
  const session::SculptLoop* loop = self.session->loop();
  if (!loop || loop->held_steps() == 0) return {};
  return {{"waits", std::to_string(loop->held_steps()) + " steps: " + haptics::SculptStep::kHeldText}};
}

FrameView stop(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  bool kept = true;
  const auto close = [&] { kept = !self.sink || self.sink->close(last_notes(self)); };
  FrameView out;
  try {
    out = with_last(self, self.session->stop(use.volume));
  } catch (...) {
    if (!self.session->running()) close();
    throw;
  }
  close();
  if (!kept) throw std::runtime_error("the journal is not complete on the disk: " + self.sink->problem());
  return out;
}

template <std::size_t (session::Session::*Go)(Volume&)>
std::size_t go(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  return (self.session.get()->*Go)(use.volume);
}

session::SculptLoop& running(SharedSession& self) {
  if (!self.session->running()) throw std::runtime_error("the session does not run");
  return *self.session->loop();
}

TripList trips(SharedSession& s) {
  py::list out;
  if (!s.session->loop()) return out;
  const py::object trip = py::module_::import("riffler.program_results").attr("Trip");
  std::array<haptics::Trip, haptics::TripLog::kCapacity> trips{};
  std::uint64_t from = 0;
  const std::size_t n = s.session->loop()->trips().read(from, trips);
  for (std::size_t k = 0; k < n; ++k)
    out.append(trip(trips[k].time, name(trips[k].state), sentence(trips[k].cause), trips[k].value));
  return out;
}

}  // namespace

void bind_session(py::module_& m) {
  py::class_<SharedSession> session = bind_session_class(m);
  session
      .def(
          "start",
          [](SharedSession& s) {
            const NoGil release;
            const Using use(s);
            s.session->start();
          },
          R"(Starts sculpting, in the pen's own thread. Call it once.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
>>> session.start()
>>> frame = session.stop()
)")
      .def("stop", &stop,
           R"(Ends the force. Everything that was cut is in the volume and in the journal on the disk, if any.

Returns
-------
SessionFrame
    The steps since the last frame.

Raises
------
RuntimeError
    If the journal is not complete on the disk; the session has stopped.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
>>> session.start()
>>> session.stop().strokes
0
)")
      .def("frame", &frame, R"(Brings the volume up to date and returns what happened since the last call.

Waits for the next step, 3 ms at most.

Returns
-------
SessionFrame

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
...     frame = session.frame()
>>> frame.tiles.shape
(0, 2)
)")
      .def("journal", &record, "path"_a, py::kw_only(), "notes"_a = py::dict(),
           R"(Records every stroke in a new file: poses, times, forces, what was cut. Call it before ``start``.

Writes the stock (``NAME-stock.rvol``) and the protected region (``NAME-mask.rvol``) next to it. The file survives
a crash but for the last second at most, and ``Session.replay`` replays it.

Parameters
----------
path : path_like
    The .rjournal file.
notes : dict
    Strings that the journal keeps.

Raises
------
ValueError
    If one of the files is there already.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
>>> session.journal("first.rjournal", notes={"operator": "Ada"})
>>> with session:
...     frame = session.frame()
>>> riffler.Session.replay("first.rjournal").volume
4000.0
)")
      .def("undo", &go<&session::Session::undo>,
           R"(Undoes the last stroke, or the last few if they ended between two frames.

Returns
-------
int
    How many strokes were undone; 0: there is none.

Raises
------
RuntimeError
    During a stroke.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
...     print(session.undo())
0
)")
      .def("redo", &go<&session::Session::redo>, R"(Redoes undone strokes, unless a new stroke has begun.

Returns
-------
int
    How many strokes were redone.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
...     print(session.redo())
0
)")
      .def(
          "reset", [](SharedSession& s) { running(s).reset(); },
          R"(Clears a trip that does not clear itself: ``SessionFrame.cause`` gives its reason.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
...     session.reset()
)")
      .def(
          "set_workspace",
          [](SharedSession& s, double scale, const OptionalArrayLike& turn, std::uint32_t dead_man,
             std::uint32_t clutch, double pivot) {
            const haptics::WorkspaceSettings settings{scale, to_turn(turn), clutch, dead_man, pivot};
            session::SculptLoop& loop = running(s);
            const NoGil release;
            loop.set_workspace(settings);
          },
          py::kw_only(), "scale"_a = 1.0, "turn"_a = py::none(),
          "dead_man_mask"_a = haptics::WorkspaceSettings().dead_man_mask,
          "clutch_mask"_a = haptics::WorkspaceSettings().clutch_mask, "pivot"_a = 0.0,
          R"(Changes scale, view or buttons from the next step on. The tool does not jump.

Parameters
----------
scale : float
    mm of the tool per mm of the hand.
turn : array_like, shape (3, 3), optional
    Rotation from the hand's frame to the tool's; None: none.
dead_man_mask, clutch_mask : int
    Buttons, as bits: cut while one is held; move the hand without the tool.
pivot : float
    mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
    torque. 0: the tip. Without effect for devices in the part's frame.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
...     session.set_workspace(scale=0.5)
)")
      .def_static(
          "replay",
          [](const std::filesystem::path& path, const ProgressLike& progress) -> VolumeResult {
            const py::object journal = py::type::of<session::Journal>().attr("load")(path);
            return journal.attr("replay")(path.parent_path(), py::arg("progress") = progress);
          },
          "path"_a, py::kw_only(), "progress"_a = py::none(),
          R"(The stock of a session at its end, to the bit. The initial stock must be next to the journal.

Parameters
----------
path : path_like
    The .rjournal file.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
Volume

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
>>> session.journal("first.rjournal")
>>> with session:
...     frame = session.frame()
>>> riffler.Session.replay("first.rjournal").to_bytes() == stock.to_bytes()
True
)")
      .def_property_readonly(
          "running", [](const SharedSession& s) { return s.session->running(); },
          "Whether the session was started and not stopped.")
      .def_property_readonly(
          "priority", [](const SharedSession& s) { return to_priority(s.session->priority()); },
          "How the system runs the thread of the steps: ThreadPriority.")
      .def_property_readonly(
          "volume", [](const SharedSession& s) { return s.volume; }, "The displayed volume.")
      .def_property_readonly(
          "pen", [](const SharedSession& s) { return s.pen; }, "The device.")
      .def_property_readonly("trips", &trips, "Times at which the force was removed, with the reasons.")
      .def_property_readonly(
          "journal_problem",
          [](const SharedSession& s) -> std::optional<std::string> {
            const std::string text = s.sink ? s.sink->problem() : "";
            return text.empty() ? std::nullopt : std::optional(text);
          },
          "Why strokes wait for the disk, or None.")
      .def(
          "journal_written",
          [](const SharedSession& s, double seconds) {
            const NoGil release;
            return !s.sink || s.sink->written(seconds);
          },
          "seconds"_a = 2.0,
          R"(Waits until all rows that were made so far are in the journal's file, which is some 50 ms behind.

Parameters
----------
seconds : float
    Longest time to wait.

Returns
-------
bool
    False if some are not.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
>>> session.journal_written()
True
)")
      .def("__enter__",
           [](const py::object& self) -> Self {
             self.attr("start")();
             return self;
           })
      .def("__exit__", [](const py::object& self, const py::args&) { self.attr("stop")(); });
}

}  // namespace riffler::bindings
