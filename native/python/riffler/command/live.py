"""Drawings in the terminal while a command runs: a canvas of braille dots, a history of values, charts."""

from __future__ import annotations

import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .console import Console

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.text import Text

FRAMES = 10  # per second: faster changes cannot be read, and terminals over a network do not keep up
# Bits of the eight dots of a braille character (Unicode 16, block 2800), of its two columns from the top down.
DOTS = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))
COLOURS = ("cyan", "magenta", "yellow", "green", "red", "blue")
SCALE = 9  # width of the numbers next to a chart, in characters


class Braille:
    """Dots, two by four in each character. Dot (0, 0) is the lower left one; dots outside are left out."""

    def __init__(self, columns: int, rows: int) -> None:
        if columns < 1 or rows < 1:
            raise ValueError(f"columns and rows must be at least 1, not {columns} and {rows}")
        self.width, self.height = 2 * columns, 4 * rows
        self.cells = np.zeros((rows, columns), np.uint8)

    def dot(self, x: int, y: int) -> None:
        if 0 <= x < self.width and 0 <= y < self.height:
            row, below = divmod(self.height - 1 - y, 4)
            self.cells[row, x // 2] |= DOTS[x % 2][below]

    def column(self, x: int, low: int, high: int) -> None:
        """Sets the dots from low to high."""
        for y in range(max(low, 0), min(high, self.height - 1) + 1):
            self.dot(x, y)

    def line(self, x0: float, y0: float, x1: float, y1: float) -> None:
        """Draws a straight line, a dot for each step of its longer side."""
        steps = max(1, round(max(abs(x1 - x0), abs(y1 - y0))))
        for k in range(steps + 1):
            t = k / steps
            self.dot(round(x0 + t * (x1 - x0)), round(y0 + t * (y1 - y0)))

    def lines(self) -> list[str]:
        return ["".join(chr(0x2800 + int(cell)) for cell in row) for row in self.cells]


class History:
    """The values of the last `seconds`, each row at its time; times must not fall."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.rows: deque[tuple[float, tuple[float, ...]]] = deque()

    def add(self, time: float, *values: float) -> None:
        self.rows.append((time, values))
        # One older row stays: its value holds at the left edge.
        while len(self.rows) > 2 and self.rows[1][0] < time - self.seconds:
            self.rows.popleft()

    def bands(self, columns: int) -> np.ndarray:
        """(columns, values, 2): minimum and maximum of each value in each column's share of the time, with the last
        value of the column before included; NaN before the first row."""
        if not self.rows:
            return np.full((columns, 0, 2), np.nan)
        times = np.array([time for time, _ in self.rows])
        values = np.array([row for _, row in self.rows], float)
        start = times[-1] - self.seconds
        at = np.floor((times - start) / self.seconds * columns).astype(int)
        at = np.minimum(at, columns - 1)
        out = np.full((columns, values.shape[1], 2), np.nan)
        last = values[0] if at[0] < 0 else None
        for column in range(columns):
            inside = values[at == column]
            if last is not None:
                inside = np.vstack([last, inside])
            if len(inside):
                out[column, :, 0], out[column, :, 1] = inside.min(axis=0), inside.max(axis=0)
                last = inside[-1]
        return out


def span(low: float, high: float, least: float) -> tuple[float, float]:
    """Range that a chart shows: at least `least` long, and a little more than the values cover."""
    if not (np.isfinite(low) and np.isfinite(high)):
        return -least / 2, least / 2
    more = max(0.05 * (high - low), (least - (high - low)) / 2)
    return low - more, high + more


def short(value: float) -> str:
    """A number for the side of a chart: four characters or a few more."""
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def chart(
    title: str, names: Sequence[str], history: History, width: int, rows: int, *, least: float, zero: bool = False
) -> Text:
    """Values of the last seconds as lines of different colours. The chart spans at least `least`.

    `width` is that of the whole chart in characters. With `zero`, the chart includes zero.
    """
    from rich.text import Text

    columns = max(8, width - SCALE)
    bands = history.bands(2 * columns)
    seen = bands[np.isfinite(bands)]
    low, high = (seen.min(), seen.max()) if seen.size else (np.nan, np.nan)
    low, high = span(min(low, 0.0), max(high, 0.0), least) if zero else span(low, high, least)
    canvases = [Braille(columns, rows) for _ in names]
    for canvas, lines in zip(canvases, np.moveaxis(bands, 1, 0), strict=False):
        to_dots = (canvas.height - 1) / (high - low)
        for x, (bottom, top) in enumerate(lines):
            if np.isfinite(bottom):
                canvas.column(x, round((bottom - low) * to_dots), round((top - low) * to_dots))
    out = Text(title, style="bold", no_wrap=True)
    for name, colour in zip(names, COLOURS, strict=False):
        out.append(f"  {name}", style=f"not bold {colour}")
    for row in range(rows):
        label = short(high) if row == 0 else short(low) if row == rows - 1 else ""
        out.append(f"\n{label:>{SCALE - 2}} ", style="not bold dim")
        out.append("│", style="not bold dim")
        for column in range(columns):
            cell, colour = 0, ""
            for canvas, mine in zip(canvases, COLOURS, strict=False):
                if canvas.cells[row, column]:
                    cell, colour = cell | int(canvas.cells[row, column]), mine
            out.append(chr(0x2800 + cell), style=f"not bold {colour}" if colour else "not bold")
    left, right = f"-{history.seconds:g} s", "now"
    out.append(f"\n{'':>{SCALE - 1}}└{left}{right:>{columns - len(left)}}", style="not bold dim")
    return out


@contextmanager
def screen(console: Console) -> Iterator[Callable[[RenderableType], None] | None]:
    """Yields a function that draws over the last picture; None if stdout is not a terminal or is for ``--json``."""
    if console.json_output or not sys.stdout.isatty():
        yield None
        return
    from rich.console import Console as Rich
    from rich.live import Live

    with Live(console=Rich(file=sys.stdout, highlight=False), auto_refresh=False, vertical_overflow="crop") as live:
        yield lambda picture: live.update(picture, refresh=True)


def width_of_terminal() -> int:
    from rich.console import Console as Rich

    return Rich(file=sys.stdout).width


class Enter:
    """Notices when the user presses Enter; a separate thread waits for it."""

    def __init__(self) -> None:
        self.pressed = threading.Event()
        threading.Thread(target=self._wait, daemon=True).start()

    def _wait(self) -> None:
        sys.stdin.readline()
        self.pressed.set()


def polyline(canvas: Braille, points: np.ndarray) -> None:
    """Draws joined straight lines through (n, 2) points in dots."""
    for (x0, y0), (x1, y1) in pairwise(points):
        canvas.line(x0, y0, x1, y1)
