"""Make a mesh of few triangles that is nowhere further from the fine one than a tolerance.

Shows: Mesh.decimate, Mesh.deviation, Volume.sphere and Volume.carve for something to decimate.
"""

import numpy as np
import riffler
from picture import BLUE, INK, STEEL, View, plt, save

# A ball of 20 mm with grooves: smooth where few triangles do, sharp where they must not move.
volume = riffler.Volume.sphere((0, 0, 0), 20, 1.0, "xyz")
for angle in np.arange(6) * np.pi / 6:
    turn = np.linspace(0, 2 * np.pi, 121)
    out = np.cos(turn)[:, None] * [np.cos(angle), np.sin(angle), 0] + np.sin(turn)[:, None] * [0, 0, 1]
    volume.carve(riffler.Tool.flat(3, 10), np.hstack([19 * out, out]))
fine = volume.to_mesh()

tolerances = (0.01, 0.03, 0.1, 0.3)
counts, moved = [], []
for tolerance in tolerances:
    mesh = fine.decimate(tolerance=tolerance)
    counts.append(len(mesh.triangles))
    moved.append(max(mesh.deviation(fine).max(), fine.deviation(mesh).max()))  # at the vertices of both
    print(f"tolerance {tolerance:g} mm: {counts[-1]} of {len(fine.triangles)} triangles, moved by {moved[-1]:.4f} mm")

figure, axes = plt.subplots(1, 2, figsize=(7, 3.6), width_ratios=(1, 1.2))
coarse = fine.decimate(tolerance=0.1)
view = View(coarse, azimuth=30, elevation=25, width=900)
view.show(axes[0], STEEL)
place, seen = view.project(coarse.vertices)
triangles = coarse.triangles[seen[coarse.triangles].all(axis=1)]
axes[0].triplot(*place.T, triangles, color=INK, lw=0.3)
axes[0].set_title("to 0.1 mm", loc="left")
axes[1].loglog(tolerances, counts, "o-", color=BLUE)
axes[1].axhline(len(fine.triangles), color=INK, lw=0.8, ls=":")
axes[1].text(0.3, len(fine.triangles), "the fine mesh", ha="right", va="bottom")
axes[1].set(xlabel="tolerance, mm", ylabel="triangles", yticks=(2000, 5000, 10000), xticks=tolerances)
axes[1].set_xticklabels(tolerances)
axes[1].set_yticklabels(("2 000", "5 000", "10 000"))
axes[1].minorticks_off()
figure.tight_layout()
save(figure, "decimate_with_tolerance.png")
