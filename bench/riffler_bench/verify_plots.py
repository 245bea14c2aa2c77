"""The plot of the job verify."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from riffler.command.plot_style import logarithmic

from .plotting import Data, colours, column, fit, pick, rows, title, values
from .report import grouped


def against_pitch(data: Data) -> Figure:
    """Error of what is left against pitch and against time; time against pitch; memory against the program's length."""
    table = rows(data, "pitch")
    figure, ((left, right), (below, last)) = plt.subplots(2, 2, figsize=(12, 8.4))
    for program, (colour, mark) in colours(values(table, "program")).items():
        mine = pick(table, program=program)
        h, seconds = column(mine, "pitch"), column(mine, "cpu_s")
        for key, line, fill, name in (("max_mm", "-", colour, "largest"), ("rms_mm", ":", "white", "RMS")):
            style = {"color": colour, "markerfacecolor": fill, "label": f"{program}, {name}"}
            left.plot(h, column(mine, key), f"{line}{mark}", **style)
            right.plot(seconds, column(mine, key), f"{line}{mark}", **style)
        above = program == "five axes"
        for x, y, pitch in zip(seconds, column(mine, "max_mm"), h, strict=True):
            right.annotate(f"{pitch:g}", (x, y), xytext=(4, 4) if above else (-4, -10), textcoords="offset points",
                           ha="left" if above else "right", fontsize=7, color=colour)  # fmt: skip
        below.plot(h, seconds, f"-{mark}", color=colour, label=program)
    gouges = pick(rows(data, "gouges"), directions="z")
    label = f"depth of gouges of {data['settings']['dip_mm']:g} mm"
    left.plot(column(gouges, "pitch"), column(gouges, "error_mm"), "-.^", color="#3f7d4f", label=label)
    order(left, h, "max_mm", mine, 1)
    order(below, h, "cpu_s", mine, -2)
    stream(last, rows(data, "memory"))
    for axis in (left, below):
        axis.set_xlabel("pitch  mm")
    left.set_ylabel("error  mm  (of surfaces: between the rays)")
    right.set(xlabel="processor time of the verification  s", ylabel="error between the rays  mm")
    below.set_ylabel(f"time for {grouped(table[0]['rows'])} rows  s")
    for axis in (left, right, below, last):
        logarithmic(axis.xaxis)
        logarithmic(axis.yaxis, sub=axis in (below, last))
        axis.margins(x=0.08, y=0.15)
        axis.legend(loc="best")
    last.xaxis.set_major_formatter(FuncFormatter(lambda value, _: grouped(value)))
    ticks = sorted(values(table, "pitch"))
    for axis in (left, below):
        axis.invert_xaxis()
        axis.set_xticks(ticks, [f"{h:g}" for h in ticks])
        axis.xaxis.minorticks_off()
    title(figure, data, "Verification: error of what is left, time and memory (a ball of 6 mm over waves)")
    fit(figure, 0.02, 0.97)
    return figure


def order(axis: Axes, h: np.ndarray, key: str, mine: list[Data], power: int) -> None:
    """A line of the slope that theory has for fine pitches, through the finest one."""
    fine = np.argmin(h)
    label = "in proportion to the pitch" if power == 1 else "in proportion to the rays"
    axis.plot(h, column(mine, key)[fine] * (h / h[fine]) ** power, "--", color="#777777", linewidth=1, label=label)


def stream(axis: Axes, table: list[Data]) -> None:
    for given, (colour, mark) in colours(values(table, "given")).items():
        mine = pick(table, given=given)
        axis.plot(column(mine, "rows"), column(mine, "verify_bytes", 1e-6), f"-{mark}", color=colour, label=given)
    before = float(np.median(column(table, "before_bytes", 1e-6)))
    axis.axhline(before, color="#777777", linewidth=1, linestyle="--", label="before the program")
    axis.set(xlabel="blocks", ylabel="peak memory of the process  MB")
    most = column(table, "verify_bytes", 1e-6).max()
    blocks = np.array(sorted(values(table, "rows")), float)
    blocks = np.geomspace(blocks[0], blocks[-1], 50)
    axis.plot(blocks, before + 16e-6 * blocks, ":", color="#777777", linewidth=1, label="and 16 bytes a block")
    axis.set_ylim(before / 1.5, 1.8 * most)
