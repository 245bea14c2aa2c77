"""What the benchmark's plots share: titles, targets, and how figures are picked from a job's JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from riffler.command.plot_style import COLOURS, MARKS, TARGET

Data = dict[str, Any]


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


def fit(figure: Figure, low: float, high: float) -> None:
    """Places the axes so that they and their labels fill the figure between two heights, fractions of the figure's.

    Like `tight_layout` with `rect`, which measures every label twice: margins and gaps keep their sizes here.
    """
    figure.tight_layout()
    fitted, grid = figure.subplotpars, figure.axes[0].get_gridspec()
    height, rows = fitted.top - fitted.bottom, grid.nrows
    gap = fitted.hspace * height / (rows + fitted.hspace * (rows - 1))
    bottom, top = fitted.bottom + low, fitted.top + high - 1
    figure.subplots_adjust(bottom=bottom, top=top, hspace=gap * rows / (top - bottom - gap * (rows - 1)))


def target(axis: Axes, x: float | None = None, y: float | None = None, text: str = "target") -> None:
    """A line at a target, labelled next to it; with an empty text, by the figure's legend."""
    if x is not None:
        axis.axvline(x, color=TARGET, linewidth=1, linestyle=":")
        axis.annotate(text, (x, 1), xycoords=("data", "axes fraction"), rotation=90, va="top", ha="right",
                      fontsize=7.5, color=TARGET, xytext=(-2, -2), textcoords="offset points")  # fmt: skip
    if y is not None:
        axis.axhline(y, color=TARGET, linewidth=1, linestyle=":")
        axis.annotate(text, (1, y), xycoords=("axes fraction", "data"), va="bottom", ha="right", fontsize=7.5,
                      bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
                      color=TARGET, xytext=(-2, 2), textcoords="offset points")  # fmt: skip
