"""The map of a verification: a relief finished with a ball, one strip of it with a tool length measured wrong.

python docs/gallery/verify_map.py
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import riffler
from riffler import plan

OUT = Path(__file__).parents[1] / "images" / "verification.png"
SIZE, BALL, OVER, WRONG = 60.0, 3.0, 1.6, 0.12


def relief(n: int) -> riffler.Mesh:
    """A hilly block of `n` × `n` cells."""
    x, y = np.meshgrid(*[np.linspace(0, SIZE, n + 1)] * 2, indexing="ij")
    z = -4 + 1.8 * np.sin(x / 6) * np.cos(y / 7) + 1.0 * np.sin((x + 2 * y) / 11)
    top = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    low = top * [1, 1, 0] + [0, 0, -10]
    k = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]))
    up = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    rim = np.concatenate([k[:, 0], k[-1, 1:], k[-2::-1, -1], k[0, -2:0:-1]])
    nxt, under = np.roll(rim, -1), (n + 1) ** 2
    sides = np.concatenate([np.column_stack([rim + under, nxt + under, nxt]),
                            np.column_stack([rim + under, nxt, rim])])  # fmt: skip
    return riffler.Mesh(np.concatenate([top, low]), np.concatenate([up, up[:, ::-1] + under, sides]))


def finishing(part: riffler.Mesh, tool: riffler.Tool, step: float) -> riffler.Program:
    x = np.arange(-2, SIZE + 2, step)
    rows = []
    for k, y in enumerate(np.arange(0, SIZE + OVER, OVER)):
        at = np.column_stack([x[:: -1 if k % 2 else 1], np.full(len(x), y), np.zeros(len(x))])
        height, _ = plan.drop(at, tool, part)
        at[:, 2] = np.where(np.isnan(height), 0, height) - (WRONG if 24 < y < 34 else 0)
        rows.append(np.hstack([at, np.tile([0.0, 0, 1], (len(at), 1))]))
    return riffler.Program(np.concatenate(rows), 1200.0, spindle=12000, tools={1: tool})


def draw(report: riffler.VerifyReport) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    mesh, distance = report.stock_deviation()
    vertices = mesh.vertices
    upper = vertices[mesh.triangles].mean(axis=1)[:, 2] > -9.5
    figure, axis = plt.subplots(figsize=(6.6, 5.6), dpi=100)
    faces = axis.tripcolor(
        vertices[:, 0], vertices[:, 1], mesh.triangles[upper], distance, cmap="RdBu", vmin=-0.2, vmax=0.2,
        shading="gouraud",
    )  # fmt: skip
    gouges = [f for f in report.findings if f.kind == "gouge"]
    worst = max(gouges, key=lambda f: f.value)
    axis.plot(*worst.point[:2], "o", mfc="none", mec="black", ms=9)
    axis.annotate(
        f"worst gouge {worst.value:.3f} mm, row {worst.row}", worst.point[:2], (6, 56),
        arrowprops={"arrowstyle": "-"}, bbox={"fc": "white", "ec": "none"},
    )  # fmt: skip
    axis.set(aspect="equal", xlabel="x, mm", ylabel="y, mm", title="What is left, seen from above")
    figure.colorbar(faces, label="mm over the part: blue rest material, red gouged", extend="both")
    figure.tight_layout()
    OUT.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(OUT)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fast", action="store_true", help="coarse, without the picture")
    fast = parser.parse_args().fast
    part = relief(30 if fast else 240)
    tool = riffler.Tool.ball(2 * BALL, 30).with_holder([(30, 16, 60, 16)])
    stock = riffler.Volume.block([0, 0, -10], [SIZE, SIZE, 0], 0.5 if fast else 0.1)
    report = riffler.verify(finishing(part, tool, 2.0 if fast else 0.5), stock, part)
    gouges = [f for f in report.findings if f.kind == "gouge"]
    print(f"{len(gouges)} gouges, {max(f.value for f in gouges):.3f} mm deep; {report.time / 60:.1f} min of machining")
    if not fast:
        draw(report)


if __name__ == "__main__":
    main()
