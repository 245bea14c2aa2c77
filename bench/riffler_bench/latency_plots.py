"""The plot of the job blender."""

from __future__ import annotations

import re

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from riffler.command.plot_style import COLOURS, INK

from .plotting import Data, fit, rows, title

STAGES = {
    "event_s": "event to the tool",
    "follow_s": "follow the surface",
    "cut_s": "cut",
    "mesh_s": "mesh",
    "transfer_s": "into Blender",
    "depsgraph_s": "dependency graph",
    "sculpt_s": "brush of sculpt mode",
    "draw_s": "draw",
    "other_s": "other",
}


def stages(data: Data) -> Figure | None:
    """What an event of a stroke takes: the medians of its stages on top of each other, and a mark at the whole's."""
    named = {window: table for window in (False, True) if (table := listed(data, window))}
    if not named:
        return None
    figure, axes = plt.subplots(1, len(named), figsize=(6 * len(named) + 1, 6.2), squeeze=False)
    shown = set()
    for axis, (window, table) in zip(axes[0], named.items(), strict=True):
        shown |= bars(axis, table)
        axis.set_title("in a window: event to picture" if window else "without a window, nothing drawn", loc="left")
        axis.set_xlabel("wall time of an event  ms")
    title(figure, data, "An event of a stroke: Riffler against Blender's sculpt mode", f"{data['cores']} cores")
    fit(figure, 0.13, 0.97)
    handles = [plt.Rectangle((0, 0), 1, 1, color=colour(key), label=STAGES[key]) for key in STAGES if key in shown]
    figure.legend(handles=handles, loc="lower right", ncols=3 if len(named) == 1 else 5, bbox_to_anchor=(1.0, 0.025))
    return figure


def listed(data: Data, window: bool) -> list[tuple[str, Data]]:
    """Names and rows, of the newest Blender first: ours and, below each, the brushes of the same Blender and size."""
    mine = [row for row in rows(data, "stroke") if row.get("window") is window and "p50_s" in row]
    mine.sort(key=lambda row: [-int(number) for number in re.findall(r"\d+", row["where"])])
    theirs = [row for row in rows(data, "sculpt") if row.get("window") is window and "p50_s" in row]
    out = []
    for row in mine:
        out.append((f"Riffler, {row['where'].removesuffix(', window')}, {row['size']}", row))
        same = [r for r in theirs if (r["where"], r["size"]) == (row["where"], row["size"])]
        out += [(r["brush"], r if window else {**r, "sculpt_s": r["p50_s"]}) for r in same]
    return out


def colour(key: str) -> str:
    return {"other_s": "#c9c4b8"}.get(key, COLOURS[list(STAGES).index(key) % len(COLOURS)])


def bars(axis: Axes, named: list[tuple[str, Data]]) -> set[str]:
    """The stages that some row has."""
    found = set()
    for k, (_, row) in enumerate(named):
        left = 0.0
        for key in STAGES:
            if row.get(key):
                axis.barh(k, 1e3 * row[key], left=left, color=colour(key), height=0.7)
                left += 1e3 * row[key]
                found.add(key)
        axis.plot([1e3 * row["p50_s"]], [k], "|", color=INK, markersize=12)
    axis.set_yticks(np.arange(len(named)), [name for name, _ in named], fontsize=7.5)
    axis.invert_yaxis()
    axis.grid(False, axis="y")
    axis.set_axisbelow(True)
    return found
