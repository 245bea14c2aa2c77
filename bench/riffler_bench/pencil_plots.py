"""The plots of the job ``pencil``."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from riffler.command.plot_style import COLOURS, INK, TARGET, logarithmic

from .plotting import Data, colours, column, fit, pick, rows, title, values

CLAY, LIGHT = np.array(to_rgb("#cfc8ba")), np.array([-0.35, -0.5, 0.8])
EXACT, FOUND = "#2f6690", TARGET
SHARP = 25.0  # degrees: edges that are drawn


def valleys(data: Data) -> Figure | None:
    """Every part with its exact curves and the paths found on it."""
    table = [row for row in rows(data, "valleys") if "drawn" in row]
    across = min(6, len(table))
    down = -(-len(table) // across)
    height = 2.35 * down + 0.9
    figure = plt.figure(figsize=(2.5 * across, height))
    for k, row in enumerate(table):
        axis = figure.add_subplot(down, across, k + 1, projection="3d", computed_zorder=False)
        part(axis, row["drawn"])
        if row["hausdorff_mm"] is None:
            told = "paths where there are none" if row["true_mm"] == 0 else "no path where there is one"
        else:
            told = f"{row['hausdorff_mm']:.1g} mm" if row["true_mm"] else "no path"
        axis.set_title(f"{row['part']}\n{told}", fontsize=8, pad=-6)
    figure.subplots_adjust(0, 0.3 / height, 1, 1 - 0.85 / height, wspace=0, hspace=0.18)
    title(figure, data, "Parts with known pencil curves, and the largest distance between these and the paths found")
    marks = [
        Line2D([], [], color=EXACT, linewidth=5, alpha=0.45, label="exact curve of the ball's centre"),
        Line2D([], [], color=FOUND, linewidth=1.2, label="path found"),
    ]
    figure.legend(handles=marks, loc="lower right", ncols=2, bbox_to_anchor=(1.0, 0.0))
    return figure


def part(axis, drawn: Data) -> None:
    """Flat shaded and translucent, so that curves below an overhang are seen."""
    points, triangles = np.array(drawn["vertices"]), np.array(drawn["triangles"])
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    shade = 0.62 + 0.38 * np.clip(normals @ LIGHT / np.linalg.norm(LIGHT), 0, 1)
    axis.view_init(*drawn["view"])
    elevation, azimuth = np.radians(drawn["view"])
    eye = [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    # Faces that look away are not drawn: what they would hide is the inside of the valleys.
    seen = normals @ eye > 0
    order = np.flatnonzero(seen)[np.argsort(corners[seen].mean(1) @ eye)]
    faces = Poly3DCollection(
        corners[order], facecolors=np.clip(shade[order, None] * CLAY, 0, 1), edgecolors="none", alpha=0.75, zorder=1
    )
    axis.add_collection3d(faces)
    edges = sharp(points, triangles, normals)
    if len(edges):  # a sphere has none
        axis.add_collection3d(Line3DCollection(edges, colors=INK, linewidths=0.4, alpha=0.45, zorder=2))
    for name, colour, width, alpha in (("true", EXACT, 4.5, 0.45), ("found", FOUND, 1.1, 1.0)):
        for line in drawn[name]:
            axis.plot(*np.array(line).T, color=colour, linewidth=width, alpha=alpha, zorder=3, solid_capstyle="butt")
    low, high = points.min(0), points.max(0)
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axis.set_box_aspect(high - low, zoom=0.98)
    axis.set_axis_off()


def sharp(points: np.ndarray, triangles: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """The ends (n, 2, 3) of the edges to draw."""
    face = {}
    found = []
    for k, (a, b, c) in enumerate(triangles):
        for edge in ((a, b), (b, c), (c, a)):
            other = face.pop(edge[::-1], None)
            if other is None:
                face[edge] = k
            elif normals[k] @ normals[other] < np.cos(np.radians(SHARP)):
                found.append(points[list(edge)])
    return np.array(found).reshape(-1, 2, 3)


def tolerance(data: Data) -> Figure:
    """Run time against error: error against the tolerance, time against the tolerance, and one against the other."""
    table = rows(data, "tolerance")
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.6))
    for name, (colour, mark) in colours(values(table, "part")).items():
        mine = pick(table, part=name)
        asked, error = column(mine, "tolerance"), np.maximum(column(mine, "hausdorff_mm"), FLOOR)
        seconds = column(mine, "cpu_s", 1e3)
        left.plot(asked, error, f"-{mark}", color=colour, label=name)
        middle.plot(asked, seconds, f"-{mark}", color=colour)
        right.plot(seconds, error, f"-{mark}", color=colour)
    ends = np.array([column(table, "tolerance").min(), column(table, "tolerance").max()])
    left.plot(ends, ends, color=TARGET, linewidth=1, linestyle=":")
    left.annotate("allowed", (ends.prod() ** 0.5, ends.prod() ** 0.5), xytext=(2, 5), textcoords="offset points",
                  fontsize=8, color=TARGET)  # fmt: skip
    left.set(xlabel="tolerance requested  mm", ylabel="Hausdorff distance from the exact curves  mm")
    middle.set(xlabel="tolerance requested  mm", ylabel="processor time  ms")
    right.set(xlabel="processor time  ms", ylabel="Hausdorff distance from the exact curves  mm")
    seconds = column(table, "cpu_s")
    for axis, shown in ((left, ends), (middle, ends), (right, np.array([seconds.min(), seconds.max()]))):
        logarithmic(axis.yaxis)
        logarithmic(axis.xaxis, sub=shown[1] < 20 * shown[0])
    for axis in (left, middle):
        axis.invert_xaxis()
    for axis in (left, right):
        axis.axhline(FLOOR, color=COLOURS[5], linewidth=0.8, linestyle="--")
    left.annotate("this or less", (0.02, FLOOR), xycoords=("axes fraction", "data"), xytext=(0, 3),
                  textcoords="offset points", fontsize=7.5, color=COLOURS[5])  # fmt: skip
    title(figure, data, "Pencil curves: what a tolerance costs and what it gives")
    fit(figure, 0.07, 0.97)
    figure.legend(*left.get_legend_handles_labels(), loc="lower right", ncols=4, bbox_to_anchor=(1.0, 0.0))
    return figure


FLOOR = 1e-6  # mm: below it lies rounding
