"""Figures of a run of the simulated pen: a file of the whole run, or a window while it runs."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from .plot_style import COLOURS, INK, STYLE, TARGET, logarithmic

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .pen_simulate import Log


def draw(log: Log, what: str) -> Figure:
    """Plots position, force, energy and removed volume against time, and the distribution of the steps' durations."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(11, 7.2))
        panels = figure.subplots(3, 2, gridspec_kw={"width_ratios": (2, 1)})
        fill(panels, log)
        figure.suptitle(f"Simulated pen carving a block, {what}", x=0.01, ha="left", fontsize=12)
        figure.tight_layout(rect=(0, 0, 1, 0.98))
    return figure


def fill(panels: np.ndarray, log: Log) -> None:
    times, poses, forces = log.column("times"), log.column("poses"), log.column("applied")
    (place, above), (push, spent), (energy, removed) = panels
    for k, name in enumerate("xyz"):
        place.plot(times, poses[:, k] - (poses[0, k] if len(poses) else 0), color=COLOURS[k], label=name)
        push.plot(times, forces[:, k], color=COLOURS[k], label=name)
    place.set_ylabel("tool from the start  mm")
    push.set_ylabel("force on the hand  N")
    for axis in (place, push):
        axis.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3)  # over the panel, where no line is
    energy.plot(times, log.column("energy"), color=COLOURS[3])
    energy.axhline(0, color=TARGET, linewidth=1, linestyle=":")
    energy.set_ylabel("energy for the hand  N·mm")
    removed.plot(times, np.cumsum(log.column("removed")), color=COLOURS[2])
    removed.set_ylabel("removed  mm³")
    for axis in (place, push, energy, removed):
        axis.set_xlim(0, max(times[-1] if len(times) else 0, 1))
        axis.set_xlabel("time  s")
    above.plot(poses[:, 0], poses[:, 1], color=INK, linewidth=0.8)
    above.set(xlabel="x  mm", ylabel="y  mm")
    above.set_aspect("equal", adjustable="datalim")
    above.ticklabel_format(useOffset=False)
    above.set_title("tool from above", fontsize=9, loc="left")
    steps(spent, 1e6 * log.column("step_seconds"))


def steps(axis: Axes, spent: np.ndarray) -> None:
    """Plots the share of steps that took longer than a time: its tail is the measure of a haptic loop."""
    spent = np.sort(spent[spent > 0])
    if len(spent):
        axis.plot(spent, 100 * (1 - np.arange(len(spent)) / len(spent)), color=COLOURS[4])
    logarithmic(axis.xaxis, sub=len(spent) > 0 and spent[-1] < 100 * spent[0])  # the axis is short
    logarithmic(axis.yaxis)
    axis.set(xlabel="processor time per step  µs", ylabel="steps that took longer  %")


class Window:
    """The same panels on a display, drawn again a few times a second."""

    def __init__(self) -> None:
        import matplotlib.pyplot as plt

        if plt.get_backend().lower() in ("agg", "pdf", "svg", "ps", "cairo", "template"):
            raise ValueError(f"--window: matplotlib cannot open a window here ({plt.get_backend()}): "
                             "install PyQt or tkinter, or use --plot FILE.png")  # fmt: skip
        self.plt = plt
        plt.ion()
        with plt.rc_context(STYLE):
            self.figure, self.panels = plt.subplots(3, 2, figsize=(11, 7.2), gridspec_kw={"width_ratios": (2, 1)})
        self.next = 0.0

    def show(self, log: Log) -> bool:
        """Draws the log if it is time; returns False once the window is closed."""
        if not self.plt.fignum_exists(self.figure.number):
            return False
        began = time.monotonic()
        if began >= self.next:
            for axis in self.panels.flat:
                axis.clear()
            with self.plt.rc_context(STYLE):
                fill(self.panels, log)
            self.figure.tight_layout()
            self.figure.canvas.draw()
            # Leaves at least two thirds of the time to the pen.
            self.next = time.monotonic() + max(0.3, 2 * (time.monotonic() - began))
        self.figure.canvas.flush_events()
        return True
