"""NC code and programs to read and write, made from closed forms."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

ROT_POINT, OFFSET = np.array([12.0, -7.0, 30.0]), np.array([3.0, 4.0, -25.0])


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _raster(count: int) -> np.ndarray:
    """(n, 3): lines over a wavy sheet of 100 × 100 mm."""
    side = int(np.ceil(np.sqrt(count)))
    k = np.arange(count)
    line, place = k // side, k % side
    x = np.where(line % 2, side - 1 - place, place) * (100 / side)
    y = line * (100 / side)
    return np.column_stack([x, y, -3 + 2 * np.sin(0.2 * x) * np.cos(0.15 * y)])


def _tilts(count: int) -> np.ndarray:
    """(n, 2): degrees, tilting and rotary axis, as a smooth path has them."""
    t = np.linspace(0, 40, count)
    return np.column_stack([20 + 15 * np.sin(t), 40 * t + 30 * np.cos(0.7 * t)])


def plain(count: int) -> tuple[str, np.ndarray]:
    """G1 with X Y Z; and where the blocks end, (n, 6)."""
    tips = np.round(_raster(count), 4)
    return _code(["G1 F1200"], map("X%.4f Y%.4f Z%.4f".__mod__, map(tuple, tips))), _with_turns(
        tips, np.zeros((count, 2))
    )


def five_axis(count: int) -> tuple[str, np.ndarray]:
    """The tip and A C in every block, under G94."""
    tips, turns = np.round(_raster(count), 4), np.round(_tilts(count), 5)
    lines = map("X%.4f Y%.4f Z%.4f A%.5f C%.5f".__mod__, map(tuple, np.hstack([tips, turns])))
    return _code(["G1 F1200"], lines), _with_turns(tips, turns)


def inverse_time(count: int) -> tuple[str, np.ndarray]:
    """The same words under G93, with F in every block."""
    tips, turns = np.round(_raster(count), 4), np.round(_tilts(count), 5)
    rates = np.full((count, 1), 1800.25)
    lines = map("X%.4f Y%.4f Z%.4f A%.5f C%.5f F%.2f".__mod__, map(tuple, np.hstack([tips, turns, rates])))
    return _code(["G93"], lines, first="G1 "), _with_turns(tips, turns)


def arcs(count: int) -> tuple[str, np.ndarray]:
    """Quarter circles of 1 mm in a row: G3 about a centre above its start, G2 about one below, in turn."""
    climb = np.where(np.arange(count) % 2, -1.0, 1.0)
    ends = np.column_stack([np.arange(1.0, count + 1), np.cumsum(climb), np.zeros(count)])
    words = zip(np.where(climb > 0, "G3", "G2"), ends[:, 0], ends[:, 1], climb, strict=True)
    lines = map("%s X%.4f Y%.4f I0 J%.0f".__mod__, words)
    return _code(["G1 F1200"], lines, start="X0 Y0 Z0"), _with_turns(ends, np.zeros((count, 2)))


def _with_turns(tips: np.ndarray, turns: np.ndarray) -> np.ndarray:
    joints = np.zeros((len(tips), 6))
    joints[:, :3], joints[:, [3, 5]] = tips, turns
    return joints


def _code(modes: list[str], lines: Iterable[str], start: str = "X-1 Y-1 Z5", first: str = "") -> str:
    head = ["G21 G90 G94 G17 G40 G54", "T1 M6", "S8000 M3", f"G0 {start}", *modes]
    return "\n".join(head) + "\n" + first + "\n".join(lines) + "\nM5\nM30\n"


CODE: dict[str, Callable[[int], tuple[str, np.ndarray]]] = {
    "G1, X Y Z": plain,
    "G1, X Y Z A C": five_axis,
    "G1, X Y Z A C F, G93": inverse_time,
    "G2 and G3": arcs,
}


# ---- programs to write


def sheet(count: int, tilted: bool) -> np.ndarray:
    """(n, 6) poses over the sheet."""
    tips = _raster(count)
    if not tilted:
        return np.hstack([tips, np.tile([0.0, 0.0, 1.0], (count, 1))])
    t = 0.05 * tips
    return np.hstack([tips, unit(np.column_stack([0.3 * np.sin(t[:, 0]), 0.3 * np.cos(t[:, 1]), np.ones(count)]))])


def paths(count: int) -> dict[str, np.ndarray]:
    """(n, 6) poses: paths of the tool's axis that ask much of rotary tables."""
    t = np.linspace(0, 1, count)[:, None]
    one = np.ones_like(t)
    wave = np.hstack([80 * t, 20 * np.sin(9 * t), -5 * t])
    return {
        "smooth": np.hstack([wave, unit(np.hstack([np.sin(7 * t), np.sin(5 * t) - 0.3, one]))]),
        "near the pole": np.hstack([np.hstack([60 * t, 5 * t, 0 * t]), unit(np.hstack([t - 0.5, 0.01 * one, one]))]),
        "wound up": np.hstack(
            [
                np.hstack([20 * np.cos(30 * t), 20 * np.sin(30 * t), -9 * t]),
                unit(np.hstack([np.cos(30 * t), np.sin(30 * t), 2 * one])),
            ]
        ),
    }
