"""The picture of the force that the hand felt."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

INK, PAPER, GRID = "#22262b", "#fbfaf7", "#ddd9d0"
COLOURS = {"x": "#c8553d", "y": "#3f7d4f", "z": "#2f6690", "all": "#22262b"}
BANDS = ("#efe9dc", "#f6f2e9")


@dataclass(frozen=True)
class Felt:
    """One stroke: force (n, 3) in N and torque (n, 3) in N·mm about the tip, at the ends of moves (n,) in s."""

    name: str
    times: np.ndarray
    force: np.ndarray
    torque: np.ndarray


def groups(strokes: list[Felt]) -> list[tuple[str, float, float]]:
    """Strokes drawn together, as (label, from, to): the parts of a letter, the whiskers of a side."""
    merged: list[list] = []
    for stroke in strokes:
        label = label_of(stroke.name)
        if merged and merged[-1][0] == label:
            merged[-1][2] = stroke.times[-1]
        else:
            merged.append([label, stroke.times[0], stroke.times[-1]])
    return [tuple(group) for group in merged]


def label_of(name: str) -> str:
    """'word 3F.2' is a part of the third letter, F; 'whisker 2 left' one of the whiskers on the left."""
    words = name.split()
    if words[0] == "word":
        return words[1].split(".")[0]
    return " ".join(word for word in words if not word.isdigit())


def joined(strokes: list[Felt], what: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and rows of all strokes with a gap (NaN) after each."""
    times = np.concatenate([np.append(stroke.times, stroke.times[-1]) for stroke in strokes])
    gap = np.full((1, 3), np.nan)
    return times, np.concatenate([np.concatenate([getattr(stroke, what), gap]) for stroke in strokes])


def plot(path: Path, strokes: list[Felt], title: str) -> None:
    plt.rcParams.update({"font.size": 9, "axes.edgecolor": INK, "text.color": INK, "axes.labelcolor": INK})
    figure, axes = plt.subplots(3, 1, figsize=(13, 7.4), sharex=True, height_ratios=(1.15, 1, 1), facecolor=PAPER)
    magnitude, parts, turning = axes
    times, force = joined(strokes, "force")
    _, torque = joined(strokes, "torque")
    length = np.linalg.norm(force, axis=1)
    magnitude.fill_between(times, 0.0, length, color="#d8a657", alpha=0.55, linewidth=0)
    magnitude.plot(times, length, color=COLOURS["all"], linewidth=0.8)
    magnitude.set_ylabel("|force|  N")
    for k, letter in enumerate("xyz"):
        parts.plot(times, force[:, k], color=COLOURS[letter], linewidth=0.9, label=letter)
        turning.plot(times, torque[:, k], color=COLOURS[letter], linewidth=0.9, label=letter)
    parts.set_ylabel("force  N")
    turning.set_ylabel("torque about the tip  N·mm")
    turning.set_xlabel("time  s")
    lines, letters = parts.get_legend_handles_labels()
    figure.legend(lines, letters, loc="upper right", bbox_to_anchor=(0.985, 0.99), ncols=3, frameon=False)

    for index, (label, start, end) in enumerate(groups(strokes)):
        for axis in axes:
            axis.axvspan(start, end, color=BANDS[index % 2], zorder=0, linewidth=0)
        letter = label[0].isdigit()
        text = label[1:] if letter else label
        magnitude.annotate(
            text, ((start + end) / 2, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 5),
            textcoords="offset points", ha="center" if letter else "left", va="bottom",
            rotation=0 if letter else 38, rotation_mode="anchor", fontsize=12 if letter else 8.5,
            fontweight="bold" if letter else "normal",
        )  # fmt: skip
    for axis in axes:
        axis.set_facecolor("white")
        axis.grid(axis="y", color=GRID, linewidth=0.6)
        axis.spines[["top", "right"]].set_visible(False)
        axis.margins(x=0.005)
    magnitude.set_ylim(bottom=0.0)
    figure.suptitle(title, x=0.065, y=0.985, ha="left", fontsize=12.5)
    figure.subplots_adjust(left=0.065, right=0.985, top=0.865, bottom=0.07, hspace=0.09)
    figure.savefig(path, dpi=110, facecolor=PAPER)
    plt.close(figure)
