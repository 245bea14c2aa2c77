"""What plots share: colours, titles, axes, and how figures are picked from a job's JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

Data = dict[str, Any]
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


def rows(data: Data, section: str) -> list[Data]:
    return data["sections"][section]["rows"]


def values(rows: Iterable[Data], key: str) -> list[Any]:
    """The different values of a column, in order."""
    return list(dict.fromkeys(row[key] for row in rows))


def pick(rows: Iterable[Data], **wanted: Any) -> list[Data]:
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def column(rows: Iterable[Data], key: str, factor: float = 1.0) -> np.ndarray:
    return np.array([row[key] for row in rows], float) * factor


def colours(names: Iterable[Any]) -> dict[Any, tuple[str, str]]:
    """A colour and a mark for each name."""
    return {name: (COLOURS[k % len(COLOURS)], MARKS[k % len(MARKS)]) for k, name in enumerate(names)}


def title(figure: Figure, data: Data, text: str, threads: str = "one thread") -> None:
    figure.suptitle(text, x=0.01, ha="left", fontsize=12)
    source = f"{data['processor']}, {threads}; riffler {data['riffler']}, {data['date']}"
    figure.text(0.01, 0.005, source + ("; --quick" if data["quick"] else ""), fontsize=7, color="#777777")


def target(axis: Axes, x: float | None = None, y: float | None = None, text: str = "target") -> None:
    """A line at a target, named beside it; with an empty text, by the figure's legend."""
    if x is not None:
        axis.axvline(x, color=TARGET, linewidth=1, linestyle=":")
        axis.annotate(text, (x, 1), xycoords=("data", "axes fraction"), rotation=90, va="top", ha="right",
                      fontsize=7.5, color=TARGET, xytext=(-2, -2), textcoords="offset points")  # fmt: skip
    if y is not None:
        axis.axhline(y, color=TARGET, linewidth=1, linestyle=":")
        axis.annotate(text, (1, y), xycoords=("axes fraction", "data"), va="bottom", ha="right", fontsize=7.5,
                      bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
                      color=TARGET, xytext=(-2, 2), textcoords="offset points")  # fmt: skip


def logarithmic(axis: Axis, sub: bool = False) -> None:
    """A log scale with plain numbers, at 2 and 5 too where `sub`."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    if sub:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_minor_formatter(NullFormatter())
