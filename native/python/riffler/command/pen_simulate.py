"""Carve a block with the simulated pen: firmware, cable, driver and force in real time, without hardware.

riffler pen simulate                        live in the terminal
riffler pen simulate --seconds 20 --plot run.png
riffler pen simulate --window               a window instead, with matplotlib

A simulated hand makes passes over a block, each deeper than the last. Shown are where it is, what pushes it, the energy
that it has given to what it feels (below zero it would be driven), and the processor's time of a step.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import pen
from .arguments import finite, length, output_file
from .console import Console, number
from .live import FRAMES, History, chart, screen, width_of_terminal
from .pen_carving import Carving, Frame, PushedField, block_at, hand_at

if TYPE_CHECKING:
    from rich.console import RenderableType

HELP = "carve with the simulated pen, and see it"
HOME = 0.5  # s until the hand begins
SHOWN = 10  # s that the charts show


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seconds", default="20", metavar="N", help="how long (default 20)")
    parser.add_argument("--stiffness", default="0.5", metavar="N/MM", help="of what the tool meets (default 0.5)")
    parser.add_argument("--pitch", default="0.5", metavar="MM", help="of the block (default 0.5)")
    parser.add_argument("--plot", metavar="FILE", help="a .png of the whole run; needs matplotlib")
    parser.add_argument("--window", action="store_true", help="plots in a window while it runs; needs matplotlib")


def run(arguments: argparse.Namespace, console: Console) -> int:
    seconds = length(arguments.seconds, "--seconds")
    stiffness = finite(arguments.stiffness, "--stiffness")
    if stiffness < 0:
        raise ValueError(f"--stiffness must not be negative, not {arguments.stiffness}")
    pitch = length(arguments.pitch, "--pitch")
    plot = None if arguments.plot is None else output_file(arguments.plot, (".png",), "--plot")
    if plot is not None or arguments.window:
        need_matplotlib()
    window = open_window() if arguments.window else None
    with pen.open("simulated") as device:
        home = homed(device)
        log = Log()
        carving: Carving = PushedField(device, block_at(home, pitch), stiffness)
        carving.start()
        try:
            carve(device, home, carving, log, seconds, console, window)
        finally:
            carving.stop()
        log.add(carving.frame())
        health = device.health()
    data = log.summary() | {"stiffness": stiffness, "lost": health["lost"], "plot": None if plot is None else str(plot)}
    if plot is not None:
        from .pen_plots import draw

        with console.writing(plot) as beside:
            draw(log, f"{stiffness:g} N/mm").savefig(beside, dpi=120, facecolor="white", format="png")
    console.result(data, f"simulated pen, {data['seconds']:.1f} s", table(data))
    return 0


def homed(device: pen.PenDevice) -> np.ndarray:
    """The home pose, once the pen is there."""
    end = time.monotonic() + 5
    while not device.state().homed:
        if time.monotonic() > end:
            raise pen.PenError(f"the simulated pen does not come up: {device.health()['problem'] or 'no report'}")
        time.sleep(0.01)
    return device.geometry.forward([device.geometry.home])[0]


def carve(
    device: pen.PenDevice, home: np.ndarray, carving: Carving, log: Log, seconds: float, console: Console, window: Any
) -> None:
    """Moves the hand, and shows what happens, until the time is over; Ctrl-C ends it sooner."""
    start = time.monotonic()
    shown = start
    try:
        with screen(console) if window is None else nullcontext() as draw:
            while (now := time.monotonic() - start) < seconds:
                pose, buttons = hand_at(home, max(0.0, now - HOME))
                device.aim(pose, buttons=buttons if now > HOME else 0)
                log.add(carving.frame())
                if time.monotonic() - shown > 1 / FRAMES:
                    shown = time.monotonic()
                    if draw is not None:
                        draw(log.picture(width_of_terminal()))
                    elif window is not None and not window.show(log):
                        break
                time.sleep(0.015)
    except KeyboardInterrupt:
        pass
    device.aim(home)


class Log:
    """The frames of a run."""

    def __init__(self) -> None:
        self.frames: list[Frame] = []
        self.removed = [0.0]
        self.frame_times = [0.0]
        self.start = time.monotonic()
        self.newest = Frame()
        self.causes: list[str] = []
        self.first: np.ndarray | None = None
        self.charts = {"position": History(SHOWN), "force": History(SHOWN), "energy": History(SHOWN)}

    def add(self, frame: Frame) -> None:
        self.frames.append(frame)
        self.newest = frame
        self.removed.append(self.removed[-1] + frame.removed)
        now = time.monotonic() - self.start
        self.frame_times.append(now)
        for at, pose, force in zip(frame.times, frame.poses, frame.forces, strict=True):
            if self.first is None:
                self.first = pose[:3]
            self.charts["position"].add(at, *(pose[:3] - self.first))
            self.charts["force"].add(at, *force[:3])
        self.charts["energy"].add(now, frame.energy)
        if frame.cause is not None and (not self.causes or self.causes[-1] != frame.cause):
            self.causes.append(frame.cause)

    def column(self, name: str) -> np.ndarray:
        parts = [getattr(frame, name) for frame in self.frames if len(frame.times)]
        return np.concatenate(parts) if parts else getattr(Frame(), name)

    def energies(self) -> np.ndarray:
        """After each frame, N·mm."""
        return np.array([frame.energy for frame in self.frames])

    def summary(self) -> dict[str, Any]:
        times, spent = self.column("times"), 1e6 * self.column("step_seconds")
        forces = np.linalg.norm(self.column("forces")[:, :3], axis=1)
        p50, p99 = np.percentile(spent, [50, 99]) if len(spent) else (0.0, 0.0)
        seconds = self.frame_times[-1]
        return {
            "seconds": round(seconds, 3),
            "steps": len(times),
            "steps_per_s": round(len(times) / seconds, 1),
            "late": self.newest.late,
            "step_us": {"p50": round(float(p50), 1), "p99": round(float(p99), 1)},
            "force_n": round(float(forces.max(initial=0.0)), 4),
            "energy": round(self.newest.energy, 4),
            "energy_least": round(float(self.energies().min(initial=0.0)), 4),
            "removed": round(self.removed[-1], 4),
            "state": self.newest.state,
            "causes": self.causes,
        }

    def picture(self, width: int) -> RenderableType:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        grid = Table(show_header=False, box=None, padding=(0, 1))
        grid.add_column(style="cyan", no_wrap=True)
        grid.add_column(overflow="fold")
        for name, value in table(self.summary()):
            grid.add_row(Text(name), Text(value))
        charts = [
            chart("position from the start  mm", "xyz", self.charts["position"], width, 7, least=1),
            chart("force felt  N", "xyz", self.charts["force"], width, 6, least=0.2, zero=True),
            chart("energy given by the hand  N·mm", [""], self.charts["energy"], width, 4, least=1, zero=True),
        ]
        return Group(grid, *charts, Text("Ctrl-C ends it", style="dim"))


def table(data: dict[str, Any]) -> list[tuple[str, str]]:
    rows = [
        ("steps", f"{number(data['steps'])}, {data['steps_per_s']:.0f}/s, {data['late']} late"),
        ("a step", f"{data['step_us']['p50']:.0f} µs of the processor at p50, {data['step_us']['p99']:.0f} at p99"),
        ("force", f"{data['force_n']:.2f} N at most; {data['state']}"),
        ("energy", f"{data['energy']:.1f} N·mm, {data['energy_least']:.1f} at the least"),
        ("removed", number(data["removed"], "mm³")),
        *(("cause", cause) for cause in data["causes"]),
    ]
    if data.get("plot"):
        rows.append(("written", data["plot"]))
    return rows


def need_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise ValueError("--plot and --window need matplotlib: pip install matplotlib") from None


def open_window() -> Any:
    """A window, or ValueError where there is no display for one."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise ValueError("--window needs a display, and there is none (DISPLAY and WAYLAND_DISPLAY are not set); "
                         "take --plot FILE.png, or neither for plots in the terminal")  # fmt: skip
    from .pen_plots import Window

    return Window()
