"""Carve a block with the simulated pen: firmware, cable, driver, haptic step and force in real time, without hardware.

riffler pen simulate                        live in the terminal
riffler pen simulate --seconds 20 --plot run.png --out block.stl
riffler pen simulate --window               in a window, with matplotlib

A simulated hand makes passes over a block, each deeper than the last, until the tool reaches a table that it must not
enter. The command shows the tool's position, the force on the hand, the energy that may go to the hand (below zero the
pen would drive the hand), the removed volume, and the processor time per step.
"""

from __future__ import annotations

import argparse
import os
import sys
import threading
import time
from collections.abc import Callable
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import Material, Session, SessionFrame, Tool, pen
from ..formats import MESHES, VOLUMES
from .arguments import JOURNALS, length, output_file
from .console import Console, number
from .detail import add_detail, detail_of
from .devices import geometry_of
from .live import FRAMES, History, chart, screen, width_of_terminal
from .parser import Parser
from .pen_carving import REMOVAL, TOOL, block_at, hand_at, table_at
from .shapes import write_left

if TYPE_CHECKING:
    from rich.console import RenderableType

HELP = "carve with the simulated pen and watch it"
SHOWN = 10  # s that the charts show


def add_arguments(parser: Parser) -> None:
    parser.add_argument("--seconds", default="20", metavar="N", help="how long (default 20)")
    parser.add_argument("--stiffness", default="1", metavar="N/MM", help="stiffness between hand and tool (default 1)")
    parser.add_argument("--pitch", default="0.5", metavar="MM", help="pitch of the block (default 0.5)")
    parser.add_file("--plot", "a .png of the whole run; needs matplotlib", (".png",))
    parser.add_argument("--window", action="store_true", help="plots in a window while it runs; needs matplotlib")
    parser.add_file("--journal", "a new .rjournal of the strokes, for riffler nc post", JOURNALS)
    add_detail(parser)
    parser.add_file("--out", "the material that is left: .stl, .obj, .ply, .3mf or .rvol", MESHES + VOLUMES)


def run(arguments: argparse.Namespace, console: Console) -> int:
    seconds = length(arguments.seconds, "--seconds")
    stiffness = length(arguments.stiffness, "--stiffness")
    detail = detail_of(arguments)
    pitch = length(arguments.pitch, "--pitch")
    plot = None if arguments.plot is None else output_file(arguments.plot, (".png",), "--plot")
    out = None if arguments.out is None else output_file(arguments.out, MESHES + VOLUMES)
    journal = None if arguments.journal is None else output_file(arguments.journal, (".rjournal",), "--journal")
    if plot is not None or arguments.window:
        need_matplotlib()
    window = open_window() if arguments.window else None
    log = Log()
    device = pen.open("simulated")
    assert isinstance(device, pen.SimulatedPen)
    with device:
        home = homed(device)
        block = block_at(home, pitch)
        before = block.volume
        start, _ = hand_at(home, 0)
        come_to(device, start)
        # The tool is where the grip is: one frame for the pen, the block and the tool.
        session = Session(
            block,
            Tool.ball(TOOL, 40.0),
            device,
            obstacles=table_at(home),
            at=device.state().pose,
            stiffness=stiffness,
            material=Material(removal_constant=REMOVAL),
        )
        if journal is not None:
            session.journal(journal)
        session.start()
        try:
            carve(device, home, session, log, seconds, screen(console) if window is None else nullcontext(), window)
        finally:
            log.add(session.stop())
            log.trips = trips(session)
        link = device.health()
    data = log.summary() | {
        "stiffness": stiffness,
        "pitch": pitch,
        "lost": link.lost,
        "removed": before - block.volume,
    }
    written = {"plot": plot, "out": out, "journal": journal}
    if plot is not None:
        from .pen_plots import draw

        with console.writing(plot) as beside:
            draw(log, f"{stiffness:g} N/mm between hand and tool").savefig(
                beside, dpi=120, facecolor="white", format="png"
            )
    if out is not None:
        write_left(block, out, console, detail)
    data |= {key: None if path is None else str(path) for key, path in written.items()}
    console.result(data, f"simulated pen, {data['seconds']:.1f} s", table(data))
    return 0


def trips(session: Session) -> dict[str, int]:
    """How often the force was switched off, by reason; releasing the button does not count."""
    found: dict[str, int] = {}
    for _, _, why, _ in session.trips:
        if "dead-man" not in why:
            found[why] = found.get(why, 0) + 1
    return found


def homed(device: pen.PenDevice) -> np.ndarray:
    """Waits until the pen is homed; returns its home pose."""
    end = time.monotonic() + 5
    while not device.state().homed:
        if time.monotonic() > end:
            raise pen.PenError(f"the simulated pen does not start: {device.health().problem or 'no report'}")
        time.sleep(0.01)
    geometry = geometry_of(device)
    return geometry.forward([geometry.home])[0]


def come_to(device: pen.SimulatedPen, pose: np.ndarray) -> None:
    """Moves the hand to a pose; waits at most two seconds."""
    device.aim(pose)
    end = time.monotonic() + 2
    while np.linalg.norm(device.state().pose[:3] - pose[:3]) > 0.3 and time.monotonic() < end:
        time.sleep(0.02)


def carve(
    device: pen.SimulatedPen, home: np.ndarray, session: Session, log: Log, seconds: float, live: Any, window: Any
) -> None:
    """Moves the hand and shows the run until the time is over; Ctrl-C ends it sooner.

    The last picture includes all frames: it stays in the terminal, and on a busy machine it may be the only one.
    """
    start = time.monotonic()
    shown = -np.inf
    with live as draw, Hand(device, home):
        show: Callable[[Log], bool] | None = None
        if window is not None:
            show = window.show
        elif draw is not None:
            show = lambda log: draw(log.picture(width_of_terminal())) or True  # noqa: E731
        try:
            while (now := time.monotonic()) - start < seconds:
                log.add(session.frame())
                if log.state == "tripped" and not device.state().fault:
                    session.reset()  # as a person does after seeing the reason
                if show is not None and now - shown > 1 / FRAMES:
                    shown = now
                    if not show(log):
                        return
                time.sleep(0.01)
        except KeyboardInterrupt:
            pass
        if show is not None:
            show(log)


class Hand:
    """Moves the simulated hand in a separate thread, so that slow drawing does not stop the hand."""

    def __init__(self, device: pen.SimulatedPen, home: np.ndarray) -> None:
        self.device, self.home = device, home
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self._move, daemon=True)

    def __enter__(self) -> None:
        self.thread.start()

    def __exit__(self, *_: object) -> None:
        self.ended.set()
        self.thread.join()

    def _move(self) -> None:
        start = time.monotonic()
        while not self.ended.wait(0.01):
            pose, buttons = hand_at(self.home, time.monotonic() - start)
            self.device.aim(pose, buttons=buttons)
        self.device.aim(hand_at(self.home, 0)[0])


class Log:
    """The frames of a run."""

    COLUMNS = ("times", "poses", "applied", "energy", "removed", "step_seconds", "missed")

    def __init__(self) -> None:
        self.parts: dict[str, list[np.ndarray]] = {name: [] for name in self.COLUMNS}
        self.begin = self.now = time.monotonic()
        self.state, self.strokes, self.dropped_ticks = "off", 0, 0
        self.why: str | None = None  # reason if there is no force, or no cutting, now
        self.trips: dict[str, int] = {}
        self.removed = 0.0
        self.first: np.ndarray | None = None
        self.charts = {"position": History(SHOWN), "force": History(SHOWN), "energy": History(SHOWN)}

    def add(self, frame: SessionFrame) -> None:
        self.now = time.monotonic()
        self.state, self.strokes, self.dropped_ticks = frame.state, frame.strokes, frame.dropped_ticks
        self.why = frame.problem or (frame.cause if frame.state != "ready" else None)
        if not len(frame):
            return
        for name, parts in self.parts.items():
            parts.append(getattr(frame, name))
        poses, applied, energy = frame.poses, frame.applied, frame.energy
        self.removed += float(frame.removed.sum())
        if self.first is None:
            self.first = poses[0, :3]
        # A chart has some 200 columns for its ten seconds: every fifth step is more than it can show.
        for k in range(0, len(frame), 5):
            at = float(frame.times[k])
            self.charts["position"].add(at, *(poses[k, :3] - self.first))
            self.charts["force"].add(at, *applied[k, :3])
            self.charts["energy"].add(at, energy[k])

    def column(self, name: str) -> np.ndarray:
        empty = np.zeros((0, 6) if name in ("poses", "applied") else 0)
        return np.concatenate([empty, *self.parts[name]])

    def summary(self) -> dict[str, Any]:
        times, spent = self.column("times"), 1e6 * self.column("step_seconds")
        forces, energy = np.linalg.norm(self.column("applied")[:, :3], axis=1), self.column("energy")
        p50, p99 = np.percentile(spent, [50, 99]) if len(spent) else (0.0, 0.0)
        seconds = float(times[-1]) if len(times) else 0.0
        return {
            "seconds": round(seconds, 3),
            "steps": len(times) + self.dropped_ticks,
            "machine_seconds": round(self.now - self.begin, 3),
            "missed": int(self.column("missed").sum()),
            "step_us": {"p50": round(float(p50), 1), "p99": round(float(p99), 1)},
            "force_n": round(float(forces.max(initial=0.0)), 4),
            "energy": round(float(energy[-1]) if len(energy) else 0.0, 4),
            "energy_least": round(float(energy.min()) if len(energy) else 0.0, 4),
            "removed": self.removed,
            "strokes": self.strokes,
            "state": self.state,
            "why": self.why,
            "trips": self.trips,
        }

    def picture(self, width: int) -> RenderableType:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        grid = Table(show_header=False, box=None, padding=(0, 1))
        grid.add_column(style="cyan", no_wrap=True)
        grid.add_column(overflow="fold")
        for name, value in [*table(self.summary()), ("now", self.why or "nothing is wrong")]:
            grid.add_row(Text(name), Text(value))
        charts = [
            chart("tool from the start  mm", "xyz", self.charts["position"], width, 7, least=1),
            chart("force felt  N", "xyz", self.charts["force"], width, 6, least=0.2, zero=True),
            chart("energy that may go to the hand  N·mm", [""], self.charts["energy"], width, 4, least=1, zero=True),
        ]
        return Group(grid, *charts, Text("Ctrl-C ends it", style="dim"))


def table(data: dict[str, Any]) -> list[tuple[str, str]]:
    rows = [
        ("time", f"{data['seconds']:.1f} s of the pen in {data['machine_seconds']:.1f} s of this machine"),
        ("steps", f"{number(data['steps'])}, {data['missed']} held over"),
        ("a step", f"{data['step_us']['p50']:.0f} µs of the processor at p50, {data['step_us']['p99']:.0f} at p99"),
        ("force", f"{data['force_n']:.2f} N at most; {data['state']}"),
        ("energy", f"{data['energy']:.2f} N·mm may go to the hand, {data['energy_least']:.2f} at the least"),
        ("removed", f"{number(data['removed'], 'mm³')} in {data['strokes']} strokes"),
        *(("trips", f"{count} × {why}") for why, count in data["trips"].items()),
    ]
    for key in ("plot", "journal", "out"):
        if data.get(key):
            rows.append((key, data[key]))
    return rows


def need_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise ValueError("--plot and --window need matplotlib: pip install matplotlib") from None


def open_window() -> Any:
    """A window, or ValueError if there is no display for one."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise ValueError("--window needs a display, and there is none (DISPLAY and WAYLAND_DISPLAY are not set); "
                         "use --plot FILE.png, or neither for plots in the terminal")  # fmt: skip
    from .pen_plots import Window

    return Window()
