"""The plots of the jobs, drawn from their JSON files without measuring again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from riffler.command.plot_style import COLOURS, INK, MARKS, STYLE, TARGET, logarithmic

from . import (
    contact_plots,
    gouge_plots,
    haptic_plots,
    latency_plots,
    nc_plots,
    pencil_plots,
    surface_plots,
    verify_plots,
)
from .plotting import Data, colours, column, fit, pick, rows, target, title, values


def draw(data: Data, out: Path) -> list[Path]:
    """The plots of one job's JSON as PNG files in `out`; none for a job without plots."""
    paths = []
    with plt.rc_context(STYLE):
        for name, plot in PLOTS.get(data["job"], {}).items():
            figure = plot(data)
            if figure is None:
                continue
            path = out / f"{name}.png"
            figure.savefig(path, dpi=120, facecolor="white")
            plt.close(figure)
            paths.append(path)
    return paths


# ---- b5x


def b5x(data: Data) -> Figure:
    """Time of one move against largest and RMS error: a panel for each cutter, a point for each tolerance."""
    table = rows(data, "path")
    names, pitches = values(table, "cutter"), values(table, "pitch")
    times = column(table, "move_s")
    few = times.max() < 50 * times.min()  # room for more than the powers of ten
    figure, axes = plt.subplots(2, 3, figsize=(12.5, 7.4), sharex=True, sharey=True)
    for axis, name in zip(axes.flat, names, strict=True):
        for pitch, colour in zip(pitches, COLOURS, strict=False):
            mine = pick(table, cutter=name, pitch=pitch)
            times, asked = column(mine, "move_s", 1e6), column(mine, "tolerance")
            largest, rms = column(mine, "max_mm"), column(mine, "rms_mm")
            axis.vlines(times, rms, asked, color=colour, linewidth=0.7, alpha=0.5)
            axis.plot(times, largest, "-o", color=colour)
            axis.plot(times, rms, "--o", color=colour, markerfacecolor="white")
            axis.plot(times, asked, "_", color=INK, markersize=12, markeredgewidth=1.6)
            if pitch == pitches[0]:
                for x, y in zip(times, asked, strict=True):
                    axis.annotate(f"{y:g}", (x, y), xytext=(0, 4), textcoords="offset points", ha="center",
                                  fontsize=7.5)  # fmt: skip
        if 0.25 in pitches:
            goal = data["settings"]["targets"]["ball_s" if name.startswith("ball") else "other_s"]
            target(axis, x=1e6 * goal, text="")
        logarithmic(axis.xaxis, sub=few)
        logarithmic(axis.yaxis)
        axis.set_title(name, fontsize=10, loc="left")
    for axis in axes[-1]:
        axis.set_xlabel("time of one move  µs")
    for axis in axes[:, 0]:
        axis.set_ylabel("error  mm")
    marks = [
        Line2D(
            [], [], color=INK, marker="_", linestyle="", markersize=12, markeredgewidth=1.6, label="tolerance requested"
        ),
        Line2D([], [], color=INK, marker="o", label="largest error"),
        Line2D([], [], color=INK, marker="o", linestyle="--", markerfacecolor="white", label="RMS error"),
        *(Line2D([], [], color=c, linewidth=4, label=f"h = {h:g} mm") for h, c in zip(pitches, COLOURS, strict=False)),
        *([Line2D([], [], color=TARGET, linestyle=":", label="target at 0.01, h = 0.25")] if 0.25 in pitches else []),
    ]
    title(figure, data, "Five-axis moves (B5X): time against measured error")
    fit(figure, 0.05, 0.97)
    figure.legend(handles=marks, loc="lower right", ncols=len(marks), bbox_to_anchor=(1.0, 0.0))
    return figure


def tolerance(data: Data) -> Figure:
    """Error and time against the tolerance, for all cutters."""
    table = rows(data, "path")
    table = pick(table, pitch=values(table, "pitch")[0])
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.8))
    for name, (colour, mark) in colours(values(table, "cutter")).items():
        mine = pick(table, cutter=name)
        asked = column(mine, "tolerance")
        left.plot(asked, column(mine, "max_mm"), f"-{mark}", color=colour, label=name)
        left.plot(asked, column(mine, "rms_mm"), f":{mark}", color=colour, markerfacecolor="white", linewidth=1)
        right.plot(asked, column(mine, "move_s", 1e6), f"-{mark}", color=colour, label=name)
    ends = np.array([min(column(table, "tolerance")), max(column(table, "tolerance"))])
    left.plot(ends, ends, color=TARGET, linewidth=1, linestyle=":")
    middle = np.sqrt(ends.prod())
    left.annotate("allowed", (middle, middle), xytext=(2, 4), textcoords="offset points", fontsize=8, color=TARGET)
    for axis in (left, right):
        axis.set_xlabel("tolerance requested  mm")
        logarithmic(axis.xaxis)
        logarithmic(axis.yaxis)
        axis.invert_xaxis()
    left.set_ylabel("measured error  mm  (filled: largest, open: RMS)")
    right.set_ylabel("time of one move  µs")
    right.axhline(1e6 * table[0]["move_s"] / table[0]["ratio"], color="#777777", linewidth=1, linestyle="--")
    right.annotate("plain capsule loop, straight moves", (0.02, 1e6 * table[0]["move_s"] / table[0]["ratio"]),
                   xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points", fontsize=7.5,
                   color="#777777")  # fmt: skip
    right.legend(loc="upper left", ncols=2)
    title(figure, data, f"Error and time of a tolerance (B5X, h = {table[0]['pitch']:g} mm)")
    fit(figure, 0.02, 0.97)
    return figure


def single(data: Data) -> Figure | None:
    """Single rotations: time against angle, and the used share of the tolerance for all motions and cutters."""
    table = rows(data, "single")
    asked = 0.01
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.8))
    turning = [row for row in table if row["angle"] and row["tolerance"] == asked]
    for name, (colour, mark) in colours(values(table, "cutter")).items():
        for about, line in (("tip", "-"), ("50 mm up", "--")):
            mine = pick(turning, cutter=name, about=about)
            left.plot(column(mine, "angle"), column(mine, "move_s", 1e3), f"{line}{mark}", color=colour,
                      markerfacecolor=colour if line == "-" else "white",
                      label=name if line == "-" else None)  # fmt: skip
    target(left, y=1e3 * data["settings"]["targets"]["single_s"], text="target for 60° to 120°")
    left.set(xlabel="angle of the move  degrees", ylabel="time of the move  ms")
    logarithmic(left.xaxis)
    logarithmic(left.yaxis)
    angles = values(turning, "angle")
    left.set_xticks(angles, [f"{a:g}" for a in angles])
    left.xaxis.minorticks_off()
    left.set_title(f"tolerance {asked:g} mm; solid: about the tip, dashed: 50 mm up", fontsize=9, loc="left")
    figure.legend(*left.get_legend_handles_labels(), loc="lower right", ncols=6, bbox_to_anchor=(1.0, 0.0))
    shares = [row for row in table if row["angle"] and row["share"] > 0]
    motions = values(shares, "motion")
    for name, (colour, mark) in colours(values(table, "cutter")).items():
        mine = [row for row in shares if row["cutter"] == name]
        places = [motions.index(row["motion"]) for row in mine]
        shift = 0.1 * (list(colours(values(table, "cutter"))).index(name) - 2.5)
        right.plot(column(mine, "share"), np.array(places) + shift, mark, color=colour, markersize=3.5, alpha=0.8)
    right.axvline(1, color=TARGET, linewidth=1, linestyle=":")
    right.set_xlabel("largest error ÷ tolerance, all tolerances")
    logarithmic(right.xaxis)
    right.set_yticks(range(len(motions)), motions)
    right.annotate("allowed", (1, 1), xycoords=("data", "axes fraction"), va="bottom", ha="center", fontsize=8,
                   color=TARGET, xytext=(0, 2), textcoords="offset points")  # fmt: skip
    title(figure, data, f"Single rotations (h = {table[0]['pitch']:g} mm)")
    fit(figure, 0.06, 0.97)
    return figure


# ---- the other jobs


def b200(data: Data) -> Figure:
    """Bars of the ratio to the yardstick for every cutter, pitch and kind."""
    table = rows(data, "carve")
    kinds = {"plain": "z", "force": "z, with force", "tri": "tri-dexel"}
    names, pitches = values(table, "cutter"), values(table, "pitch")
    width = max(4.2 * len(pitches), 7.6)  # in: the title's
    figure, axes = plt.subplots(1, len(pitches), figsize=(width, 4.6), sharey=True, squeeze=False)
    for axis, pitch in zip(axes.flat, pitches, strict=True):
        mine = pick(table, pitch=pitch)
        for k, (kind, label) in enumerate(kinds.items()):
            places = np.arange(len(names)) + 0.27 * (k - 1)
            ratios = column(mine, f"{kind}_ratio")
            axis.bar(places, ratios, 0.25, color=COLOURS[k], label=label)
            for x, y in zip(places, ratios, strict=True):
                axis.annotate(f"{y:.3g}", (x, y), ha="center", va="bottom", fontsize=6.5, rotation=90,
                              xytext=(0, 2), textcoords="offset points")  # fmt: skip
        target(axis, y=data["settings"]["target_ratio"], text="")
        logarithmic(axis.yaxis)
        axis.set_xticks(range(len(names)), names, rotation=35, ha="right")
        axis.set_title(f"h = {pitch:g} mm; loop {1e6 * mine[0]['loop_s']:.3g} µs a move", fontsize=9, loc="left")
        axis.grid(axis="x", visible=False)
        axis.margins(y=0.12)
    axes.flat[0].set_ylabel("time ÷ plain capsule loop")
    title(figure, data, "Straight moves (B200): time of one move against the plain capsule loop in the same run")
    fit(figure, 0.06, 0.97)
    marks = [
        Line2D([], [], color=TARGET, linestyle=":", label="target for z"),
        *axes.flat[0].get_legend_handles_labels()[0],
    ]
    figure.legend(handles=marks, loc="lower right", ncols=4, bbox_to_anchor=(1.0, 0.0))
    return figure


def haptic(data: Data) -> Figure | None:
    """Share of steps that take longer than a time."""
    table = rows(data, "steps")
    if not table:
        return None
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.4), width_ratios=(1.5, 1))
    for k, row in enumerate(table):
        label = f"{row['side']}² rays, {row['axis']} axis"
        times = np.array(row["times_s"]) * 1e3
        left.plot(np.arange(1, len(times) + 1), times, color=COLOURS[k], linewidth=0.8, label=label)
        right.plot(np.sort(times), 1 - np.arange(len(times)) / len(times), color=COLOURS[k], label=label)
    goal = 1e3 * data["settings"]["target_s"]
    target(left, y=goal, text="target for 99 %")
    target(right, x=goal)
    right.axhline(0.01, color="#777777", linewidth=0.8, linestyle="--")
    left.set(xlabel="step", ylabel="processor time  ms")
    right.set(xlabel="processor time  ms", ylabel="share of steps that take longer")
    logarithmic(left.yaxis, sub=True)
    logarithmic(right.xaxis, sub=True)
    logarithmic(right.yaxis)
    figure.legend(*left.get_legend_handles_labels(), loc="lower right", ncols=4, bbox_to_anchor=(1.0, 0.0))
    title(figure, data, "Haptic step: Ø20 ball, 0.5 mm a step, h = 0.1 mm, force and torque included")
    fit(figure, 0.06, 0.97)
    return figure


def force(data: Data) -> Figure:
    """Force over a part of the stroke at every rate, and ripple against step ÷ pitch."""
    table = rows(data, "stroke")
    names, rates, pitches = values(table, "cutter"), values(table, "rate"), values(table, "pitch")
    figure, axes = plt.subplots(2, len(pitches) + 1, figsize=(4.1 * (len(pitches) + 1), 6.8), squeeze=False)
    colour = dict(zip(rates, COLOURS, strict=False))
    for line, name in zip(axes, names, strict=True):
        for axis, pitch in zip(line, pitches, strict=False):
            for rate in reversed(rates):
                (row,) = pick(table, cutter=name, pitch=pitch, rate=rate)
                times, felt = np.array(row["times_s"]), np.array(row["force_N"])
                # The force of a step is the mean over it.
                axis.stairs(felt, np.append(0, times), color=colour[rate], linewidth=0.8 if rate > 1000 else 1.2,
                            label=f"{rate} Hz", baseline=None)  # fmt: skip
            axis.axhline(row["exact_N"], color=INK, linewidth=0.9, linestyle="--", label="closed form")
            axis.set(xlim=(0, 0.36), ylim=(0, 2.2 * row["exact_N"]))
            axis.set_title(f"{name}, h = {pitch:g} mm", fontsize=9.5, loc="left")
        line[0].set_ylabel("force against the motion  N")
        for pitch, mark in zip(pitches, MARKS, strict=False):
            mine = pick(table, cutter=name, pitch=pitch)
            line[-1].plot(column(mine, "step_share"), column(mine, "ripple", 100), f"-{mark}", color=INK,
                          markerfacecolor="white", label=f"h = {pitch:g}", linewidth=1)  # fmt: skip
        line[-1].set_ylabel("ripple (RMS)  % of the mean")
        logarithmic(line[-1].xaxis)
        logarithmic(line[-1].yaxis, sub=True)
        line[-1].set_title(f"{name}, steady part", fontsize=9.5, loc="left")
        line[-1].legend()
    for axis in axes[-1][:-1]:
        axis.set_xlabel("time  s")
    axes[-1][-1].set_xlabel("length of a step ÷ h")
    axes[0][0].legend(loc="lower right")
    title(figure, data, "Force of one straight stroke at different rates and pitches, unfiltered")
    fit(figure, 0.02, 0.97)
    return figure


def pitch(data: Data) -> Figure:
    """Time, memory and error of the mesh against pitch."""
    table = rows(data, "b200")
    figure, ((left, middle), (right, last)) = plt.subplots(2, 2, figsize=(12, 8.4))
    for (directions, label), (colour, mark) in zip(
        (("z", "one direction"), ("xyz", "tri-dexel")), colours("ab").values(), strict=True
    ):
        mine = pick(table, directions=directions)
        h = column(mine, "pitch")
        left.plot(h, column(mine, "move_s", 1e6), f"-{mark}", color=colour, label=label)
        middle.plot(h, column(mine, "mesh_s", 1e3), f"-{mark}", color=colour, label=label)
        right.plot(h, column(mine, "carved_bytes", 1e-6), f"-{mark}", color=colour, label=f"volume, {label}")
        right.plot(h, column(mine, "peak_bytes", 1e-6), f":{mark}", color=colour, markerfacecolor="white",
                   label=f"process with mesh, {label}")  # fmt: skip
    mine = pick(table, directions="z")
    left.plot(column(mine, "pitch"), column(mine, "loop_s", 1e6), "--", color="#777777", label="plain capsule loop")
    surface = rows(data, "surface")
    for directions, (colour, mark) in colours(values(surface, "directions")).items():
        mine = pick(surface, directions=directions)
        for which, line, fill in (("max", "-", colour), ("rms", ":", "white")):
            worst = np.max([column(mine, f"{slope}_{which}_mm") for slope in ("gentle", "middling", "steep")], axis=0)
            label = f"{'one direction' if directions == 'z' else 'tri-dexel'}, {'largest' if which == 'max' else 'RMS'}"
            last.plot(column(mine, "pitch"), worst, f"{line}{mark}", color=colour, markerfacecolor=fill, label=label)
    last.plot(column(mine, "pitch"), column(mine, "half_mm"), "--", color="#777777", linewidth=1, label="h ÷ 2")
    last.plot(column(mine, "pitch"), column(mine, "sag_mm"), "-.", color="#777777", linewidth=1, label="h² ÷ 4 R")
    labels = ("carving, one move  µs", "whole volume to mesh  ms", "memory  MB", "error of the mesh, R = 3 mm  mm")
    ticks = sorted(values(table, "pitch"))
    for axis, label in zip((left, middle, right, last), labels, strict=True):
        axis.set(xlabel="pitch  mm", ylabel=label)
        logarithmic(axis.xaxis)
        logarithmic(axis.yaxis)
        axis.invert_xaxis()
        axis.set_xticks(ticks, [f"{h:g}" for h in ticks])
        axis.xaxis.minorticks_off()
        axis.margins(y=0.25)
        axis.legend(loc="upper left")
    right.legend(loc="lower right")
    last.legend(loc="lower left", ncols=2)
    if 0.15 in ticks:
        right.plot([0.15], [100], "_", color=TARGET, markersize=14, markeredgewidth=1.5)
        right.annotate("target: below 100 MB\nin all at 0.15", (0.15, 100), xytext=(-4, 8), textcoords="offset points",
                       fontsize=7.5, color=TARGET, ha="right")  # fmt: skip
    title(figure, data, "Time, memory and the mesh's error against pitch (Ø6 ball)")
    fit(figure, 0.02, 0.97)
    return figure


def mesh(data: Data) -> Figure:
    """Error of B200's mesh against pitch, and against time together with rivals' meshes."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5.2))
    table = rows(data, "error")
    for directions, (colour, mark) in colours(values(table, "directions")).items():
        mine = pick(table, directions=directions)
        label = "one direction" if directions == "z" else "tri-dexel"
        h = column(mine, "pitch")
        left.plot(h, column(mine, "max_mm"), f"-{mark}", color=colour, label=f"{label}, largest")
        left.plot(h, column(mine, "rms_mm"), f":{mark}", color=colour, markerfacecolor="white", label=f"{label}, RMS")
    h = np.array(sorted(values(table, "pitch")))
    start = pick(table, directions="xyz", pitch=h[-1])[0]
    for power, line in ((1, "--"), (2, "-.")):
        at = start["max_mm" if power == 1 else "rms_mm"] * (h / h[-1]) ** power
        left.plot(h, at, line, color="#777777", linewidth=1, label=f"order {power}")
    timed = [row for row in rows(data, "b200") if row.get("threads") == "1"]
    beside = ((3, 3, "left"), (-3, -9, "right"), (3, -9, "left"), (-3, 3, "right"))  # lines lie on each other
    for k, (engine, (colour, mark)) in enumerate(colours(values(timed, "engine")).items()):
        *off, side = beside[k % len(beside)]
        mine = pick(timed, engine=engine)
        right.plot(column(mine, "cpu_s"), column(mine, "rms_mm"), f"-{mark}", color=colour, label=engine)
        for row in mine:
            right.annotate(f"{row['pitch']:g}", (row["cpu_s"], row["rms_mm"]), xytext=off, ha=side,
                           textcoords="offset points", fontsize=6.5, color=colour)  # fmt: skip
    left.set(xlabel="pitch  mm", ylabel="distance of vertices from the exact surface  mm")
    right.set(xlabel="processor time of the mesh  s", ylabel="RMS distance of vertices from the exact surface  mm")
    for axis in (left, right):
        logarithmic(axis.xaxis)
        logarithmic(axis.yaxis)
    left.legend(loc="lower left")
    left.invert_xaxis()
    left.set_xticks(h, [f"{x:g}" for x in h])
    left.xaxis.minorticks_off()
    title(figure, data, "B200 to a mesh: error against pitch and against time")
    fit(figure, 0.1, 0.97)
    figure.legend(*right.get_legend_handles_labels(), loc="lower right", ncols=4, bbox_to_anchor=(1.0, 0.0))
    return figure


# ---- col


PLOTS: dict[str, dict[str, Callable[[Data], Figure | None]]] = {
    "b200": {"b200": b200},
    "b5x": {"b5x": b5x, "b5x-tolerance": tolerance, "b5x-single": single},
    "haptic": {"haptic": haptic, "rendered": haptic_plots.rendered, "session": haptic_plots.session},
    "force": {"force": force},
    "pitch": {"pitch": pitch},
    "mesh": {"mesh": mesh},
    "col": {"col": contact_plots.col, "col-budgets": contact_plots.budgets, "col-slide": contact_plots.slide},
    "gouge": {"gouge": gouge_plots.entries},
    "nc": {"nc": nc_plots.between},
    "surfaces": {"surfaces": surface_plots.surfaces},
    "blender": {"blender": latency_plots.stages},
    "verify": {"verify": verify_plots.against_pitch},
    "pencil": {"pencil": pencil_plots.valleys, "pencil-tolerance": pencil_plots.tolerance},
}
