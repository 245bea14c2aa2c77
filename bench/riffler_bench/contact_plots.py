"""The plots of the job col."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from riffler.command.plot_style import COLOURS, INK, logarithmic

from .plotting import Data, colours, column, fit, pick, rows, target, title, values
from .report import grouped


def col(data: Data) -> Figure:
    """Share of poses that take longer than a time, for each part and tool. Rivals compute no force."""
    table = [row for row in rows(data, "times") if "times_us" in row]
    cases = list(dict.fromkeys((row["triangles"], row["tool"]) for row in table))
    wanted = [row for row in table if row["what"] in ("depth, force and torque", "all contacts", "first contact")]
    names = [
        n for n in values(wanted, "engine") if n != "FCL OBBRSS, tool mesh"
    ]  # differs from its OBB by the boxes only
    colour = colours(names)
    shape = (1, len(cases)) if len(cases) < 4 else (2, 2)
    figure, axes = plt.subplots(*shape, figsize=(12.5, 4.4 * shape[0]), squeeze=False, sharex=True, sharey=True)
    for axis, (triangles, tool) in zip(axes.flat, cases, strict=False):
        for row in pick(wanted, triangles=triangles, tool=tool):
            if row["engine"] not in names:
                continue
            us, first = np.array(row["times_us"]), row["what"] == "first contact"
            mine = row["engine"] == "Riffler"
            label = row["engine"] + (": depth, force, torque" if mine else f": {row['what']}")
            axis.plot(us, 1 - np.linspace(0, 1, len(us)), ":" if first else "-", color=colour[row["engine"]][0],
                      linewidth=2.4 if mine else 1.2, label=label)  # fmt: skip
        axis.axhline(0.01, color="#777777", linewidth=0.8, linestyle="--")
        target(axis, x=data["settings"]["targets"]["p99_us"], text="target for 99 %")
        axis.set_title(f"{grouped(triangles)} triangles, {tool} tool", fontsize=10, loc="left")
        axis.set_ylim(0.004, 1.1)
        logarithmic(axis.xaxis)
        logarithmic(axis.yaxis)
    for axis in axes[-1]:
        axis.set_xlabel("processor time of one pose  µs")
    for axis in axes[:, 0]:
        axis.set_ylabel("share of poses that take longer")
    title(figure, data, "Contact (COL): time of one pose, 2 000 poses" if not data["quick"] else "Contact (COL)")
    low = 0.18 if shape[0] == 1 else 0.1
    fit(figure, low, 0.97)
    labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(*labels, loc="lower right", ncols=4, bbox_to_anchor=(1.0, 0.05 if shape[0] == 1 else 0.02))
    return figure


def budgets(data: Data) -> Figure:
    """Largest and mean missed depth of queries with a budget, and their bounds, against the time taken."""
    table = rows(data, "budgets")
    sizes = values(table, "triangles")
    figure, axes = plt.subplots(1, len(sizes), figsize=(6.2 * len(sizes), 4.8), squeeze=False, sharey=True)
    least = 1e-4  # mm: the bottom of the log axis, where 0 is drawn
    for axis, triangles in zip(axes.flat, sizes, strict=True):
        mine = pick(table, triangles=triangles)
        time = column(mine, "mean_s", 1e6)
        for key, label, (colour, mark), line in (
            ("bound_max_mm", "largest bound given", colours("ab")["a"], "-"),
            ("bound_mean_mm", "mean bound given", colours("ab")["a"], ":"),
            ("missed_max_mm", "largest missed depth", colours("ab")["b"], "-"),
            ("missed_mean_mm", "mean missed depth", colours("ab")["b"], ":"),
        ):
            axis.plot(time, column(mine, key).clip(least), f"{line}{mark}", color=colour, label=label,
                      markerfacecolor=colour if line == "-" else "white")  # fmt: skip
        top = column(mine, "bound_max_mm").clip(least)
        for row, x, y in zip(mine, time, top, strict=True):
            if y <= least:
                continue
            text = "no limit" if row["budget_s"] >= 1 else f"{1e6 * row['budget_s']:g} µs"
            axis.annotate(text, (x, y), xytext=(3, 5), textcoords="offset points", fontsize=7.5)
        axis.axhline(least, color="#777777", linewidth=0.8, linestyle="--")
        axis.annotate("0, or less than this", (0.01, least), xycoords=("axes fraction", "data"), xytext=(0, -10),
                      textcoords="offset points", fontsize=7.5, color="#777777")  # fmt: skip
        axis.set_title(f"{grouped(triangles)} triangles", fontsize=10, loc="left")
        axis.set(xlabel="mean processor time of a query  µs", ylim=(least / 2, 4 * top.max()))
        logarithmic(axis.xaxis, sub=True)
        logarithmic(axis.yaxis)
        axis.margins(x=0.12)
    axes[0, 0].set_ylabel("depth  mm")
    title(figure, data, "Queries with a time budget: time against missed depth and its bound")
    axes[0, -1].legend(loc="lower left", bbox_to_anchor=(0.0, 0.08))
    fit(figure, 0.03, 0.97)
    return figure


def slide(data: Data) -> Figure:
    """Force against position over an edge, with the exact integral."""
    row = min(rows(data, "slide"), key=lambda r: r["step_mm"])
    figure, axis = plt.subplots(figsize=(8.5, 4.6))
    x = np.array(row["x_mm"])
    for key, label, colour in (("z", "up", COLOURS[0]), ("x", "off the edge", COLOURS[1])):
        axis.plot(x, row[f"force_{key}_N"], color=colour, label=label)
        axis.plot(x, row[f"reference_{key}_N"], "--", color=INK, linewidth=0.9)
    axis.plot([], [], "--", color=INK, linewidth=0.9, label="integral of stiffness × depth")
    axis.axvline(0, color="#777777", linewidth=0.8, linestyle=":")
    axis.annotate("edge", (0, 1), xycoords=("data", "axes fraction"), xytext=(3, -9), textcoords="offset points",
                  fontsize=7.5, color="#777777")  # fmt: skip
    axis.set(xlabel="tip beyond the edge  mm", ylabel="force on the tool  N")
    axis.legend()
    title(figure, data, "A ball R3, 0.2 mm deep, slides off a plane over its edge")
    fit(figure, 0.03, 0.97)
    return figure
