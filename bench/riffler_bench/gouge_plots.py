"""The plot of the job gouge."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from riffler.command.plot_style import COLOURS, logarithmic

from .plotting import Data, fit, rows, target, title, values

LEAST = 1e-4  # mm: what is drawn at the bottom of the log axis is nothing, or less


def entries(data: Data) -> Figure:
    """How deep part and vise enter the tool along the paths: at their points unlifted, and along the moves made."""
    table = [row for row in rows(data, "paths") if "rule" in row]
    parts, rules = values(table, "part"), values(table, "rule")
    shape = len(parts), len(rules)
    figure, axes = plt.subplots(
        *shape, figsize=(4.2 * shape[1], 2.0 * shape[0] + 0.9), squeeze=False, sharey=True, sharex="row"
    )
    allowed = data["settings"]["tolerance_mm"]
    for row in table:
        axis = axes[parts.index(row["part"]), rules.index(row["rule"])]
        for key, label, style, colour in (
            ("before", "at the path's points, not lifted", ".", COLOURS[1]),
            ("after", "along the moves made", "-", COLOURS[0]),
        ):
            entry = np.array(row[f"{key}_entry_mm"]).clip(LEAST)
            axis.plot(row[f"{key}_place_mm"], entry, style, color=colour, label=label, markersize=3, linewidth=0.8)
        target(axis, y=allowed, text="tolerance" if axis is axes[0, 0] else "")
        axis.set_title(f"{row['part']}, {row['rule']}", fontsize=9, loc="left")
        axis.set_ylim(LEAST / 1.5, 60)
        logarithmic(axis.yaxis)
    for axis in axes[:, 0]:
        axis.set_ylabel("deepest entry  mm")
    for axis in axes[-1]:
        axis.set_xlabel("along the paths, one after the other  mm")
    title(figure, data, "Part and vise in cutter, shank or holder, by the independent judge (lowest: nothing, or less)")
    low = 0.35 / figure.get_figheight()
    fit(figure, low, 0.98)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="lower right", ncols=2, bbox_to_anchor=(1.0, 0.0))
    return figure
