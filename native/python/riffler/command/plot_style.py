"""Shared by all plots: colours, style, logarithmic axes. Needs matplotlib."""

from __future__ import annotations

from matplotlib.axis import XAxis, YAxis
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

INK, GRID, TARGET = "#22262b", "#e3dfd6", "#c8553d"
COLOURS = ("#2f6690", "#c8553d", "#3f7d4f", "#d08c2a", "#7a5195", "#5b6770", "#a3475d", "#4a8f9e")
MARKS = "osD^vPX<"
STYLE = {
    "font.size": 9,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "axes.grid": True,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "legend.fontsize": 8,
    "lines.linewidth": 1.4,
    "lines.markersize": 5,
}


def logarithmic(axis: XAxis | YAxis, sub: bool = False) -> None:
    """Sets a log scale with plain numbers; with `sub`, ticks at 2 and 5 too."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})  # pyright: ignore[reportAttributeAccessIssue]
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    if sub:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_minor_formatter(NullFormatter())
