"""The plot of the job surfaces."""

from __future__ import annotations

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from riffler.command.plot_style import COLOURS, logarithmic

from .plotting import Data, column, fit, rows, target, title


def surfaces(data: Data) -> Figure:
    """Time of a query against its errors: triangles of several tolerances, and the exact surface."""
    table = rows(data, "torus")
    flat, exact = [r for r in table if r["tolerance"]], [r for r in table if not r["tolerance"]]
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 4.2), sharey=True)
    kinds = (
        ("depth_mm", 1.0, "depth off by  mm"),
        ("ripple", 100.0, "force ripples by  %"),
        ("cl_mm", 1.0, "cutter location off by  mm"),
    )
    for axis, (key, factor, text) in zip(axes, kinds, strict=True):
        axis.plot(column(flat, key, factor), column(flat, "mean_s", 1e6), "-o", color=COLOURS[0], label="triangles")
        axis.plot(column(exact, key, factor), column(exact, "mean_s", 1e6), "D", color=COLOURS[1], label="exact")
        for row in flat:
            axis.annotate(f"{row['tolerance']:g}", (row[key] * factor, row["mean_s"] * 1e6), xytext=(0, 6),
                          textcoords="offset points", ha="center", fontsize=8)  # fmt: skip
        logarithmic(axis.xaxis)
        logarithmic(axis.yaxis)
        axis.set_xlabel(text)
    target(axes[1], x=100 * data["settings"]["ripple"])
    axes[0].set_ylabel("processor time of a query, mean  µs")
    axes[0].legend()
    title(figure, data, "A ball on a torus: time and error; labels: tolerance of the triangles, mm")
    fit(figure, 0, 0.95)
    return figure
