"""The plots of the job haptic that are not of the cut alone: the whole step, its error, and a session."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from riffler.command.plot_style import COLOURS, INK, MARKS, logarithmic

from .plotting import Data, column, fit, pick, rows, target, title, values


def rendered(data: Data) -> Figure | None:
    """Left: 99 % of the whole step against pitch. Right: error of the force against the time that a step takes."""
    times, errors = rows(data, "rendered"), pick(rows(data, "force_error"), scene="wave")
    if not times or not errors:
        return None
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.6))
    for k, scene in enumerate(values(times, "scene")):
        table = pick(times, scene=scene)
        if table[0]["pitch"] is None:
            left.axhline(1e6 * table[0]["p99_s"], color=COLOURS[k], label=f"{scene} (a mesh: no pitch)")
            continue
        pitch = column(table, "pitch")
        left.plot(pitch, column(table, "p99_s", 1e6), MARKS[k] + "-", color=COLOURS[k], label=scene)
        left.plot(pitch, column(table, "p50_s", 1e6), MARKS[k] + ":", color=COLOURS[k], markersize=4, linewidth=0.9)
    goals = sorted(set(column(times, "target_s", 1e6)))
    for goal, text in zip(goals, ("target, contact", "target, cut"), strict=False):
        target(left, y=goal, text=text)
    left.set(xlabel="pitch  mm", ylabel="processor time of a step  µs")
    logarithmic(left.xaxis, sub=True)
    logarithmic(left.yaxis)
    left.set_xticks(sorted({row["pitch"] for row in times if row["pitch"]}))
    left.set_ylim(1)  # room for the legend
    left.legend(fontsize=8, loc="lower left", title="99 % (dotted: median)", title_fontsize=8)
    groups = {
        "1000 Hz, ": "1000 Hz, parts of a step",
        "budget": "16 parts, with a budget",
        "Hz, interp": "interpolated",
    }
    for k, (part, label) in enumerate(groups.items()):
        table = [row for row in errors if part in row["scheme"] and row["rms"] > 0]
        x, y = column(table, "mean_s", 1e6), column(table, "rms", 100)
        right.plot(x, y, MARKS[k] + ("-" if k == 0 else ""), color=COLOURS[k], label=label)
        for row, a, b in zip(table, x, y, strict=True):
            words = row["scheme"].split(", ")
            text = words[0] if k == 2 else words[-1].replace("budget ", "").replace(" parts", "").replace(" part", "")
            right.annotate(
                text, (a, b), xytext=(4, -11 if k == 1 else 4), textcoords="offset points", fontsize=7.5, color=INK
            )
    right.set(xlabel="mean processor time of a step  µs", ylabel="error of the force, RMS  % of the largest")
    logarithmic(right.xaxis, sub=True)
    logarithmic(right.yaxis, sub=True)
    right.margins(0.15)
    right.legend(fontsize=8, loc="upper right")
    title(figure, data, "Whole haptic step: time against pitch, and error of the force against time")
    fit(figure, 0.03, 0.97)
    return figure


def session(data: Data) -> Figure | None:
    """Left: share of steps that take longer than a time. Right: memory of the process over the run."""
    table = rows(data, "session")
    if not table:
        return None
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.4), width_ratios=(1.4, 1))
    for k, row in enumerate(table):
        label = f"{row['directions']}, {row['pitch']:g} mm"
        if row["stiffness"] != 1:
            label += f", {row['stiffness']:g} N/mm, jitter {row['jitter_us'] / 1e3:g} ms"
        slow = np.array(row["slowest_s"]) * 1e6
        count = len(slow)
        left.plot(slow, 0.02 * (1 - np.arange(count) / count), color=COLOURS[k], label=label)
        left.plot([1e6 * row["p50_s"]], [0.5], MARKS[k], color=COLOURS[k], markersize=5)
        memory = row["resident_mb"]
        right.plot(np.linspace(0, 100, len(memory)), memory, MARKS[k] + "-", color=COLOURS[k], markersize=4)
    target(left, x=500, text="target for 99 %")
    left.axhline(0.01, color="#777777", linewidth=0.8, linestyle="--")
    left.set(xlabel="processor time of a step  µs", ylabel="share of steps that take longer")
    logarithmic(left.xaxis, sub=True)
    logarithmic(left.yaxis)
    left.legend(fontsize=8, loc="lower left", title="stock (marks: median)", title_fontsize=8)
    right.set(xlabel="of the run  %", ylabel="memory of the process  MB")
    right.set_ylim(0)
    title(figure, data, "Sculpting with the simulated pen")
    fit(figure, 0.03, 0.97)
    return figure
