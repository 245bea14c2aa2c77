"""The plot of the job nc."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from riffler.command.plot_style import logarithmic

from .plotting import Data, colours, column, fit, pick, rows, title, values


def between(data: Data) -> Figure:
    """Measured error against the requested tolerance, and blocks and time against the error: one column a post."""
    table = rows(data, "between")
    posts = values(table, "post")
    figure, axes = plt.subplots(3, len(posts), figsize=(4.1 * len(posts), 9.2), squeeze=False, sharey="row")
    for (top, middle, bottom), post in zip(axes.T, posts, strict=True):
        # Where the control keeps the tip, it is the axis that tells.
        tip = max(column(pick(table, post=post), "tip_mm")) > 1e-4
        key, asked, unit = ("tip_mm", "tolerance", "tip  mm") if tip else ("axis_rad", "axis_tolerance", "axis  mrad")
        scale = 1 if tip else 1e3
        for path, (colour, mark) in colours(values(table, "path")).items():
            mine = pick(table, post=post, path=path)
            wanted, error = column(mine, asked, scale), column(mine, key, scale)
            top.plot(wanted, error / wanted, f"-{mark}", color=colour, label=path)
            middle.plot(error, column(mine, "blocks"), f"-{mark}", color=colour)
            bottom.plot(error, column(mine, "seconds", 1e3), f"-{mark}", color=colour)
        reach = np.array([min(wanted), max(wanted)])
        top.axhline(1, color="#777777", linewidth=1, linestyle="--")
        mine = pick(table, post=post, path=values(table, "path")[-1])
        error, blocks = column(mine, key, scale), column(mine, "blocks")
        half = blocks[-1] * np.sqrt(error[-1] / error)
        middle.plot(error, half, ":", color="#777777", linewidth=1, label="1 ÷ √error")
        top.set_xlim(reach[0] / 2, reach[1] * 2)
        top.set_title(post, fontsize=9.5, loc="left")
        top.set_xlabel(f"tolerance of the {unit}")
        for axis in (middle, bottom):
            axis.set_xlabel(f"worst error of the {unit}")
            logarithmic(axis.yaxis, sub=True)
        for axis in (top, middle, bottom):
            logarithmic(axis.xaxis)
            axis.invert_xaxis()
        top.set_ylim(0, 1.15)
    axes[0, 0].set_ylabel("worst error ÷ tolerance")
    axes[1, 0].set_ylabel(f"blocks for {table[0]['rows']} rows")
    axes[2, 0].set_ylabel("time to write the file  ms")
    title(figure, data, "What the axes do between blocks: error, blocks and time")
    fit(figure, 0.04, 0.98)
    handles = [*axes[0, 0].get_legend_handles_labels()[0], *axes[1, 0].get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="lower right", ncols=4, bbox_to_anchor=(1.0, 0.0))
    return figure
