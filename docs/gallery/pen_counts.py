"""How many counts each of the pen's encoders may be off before it shows: the table of docs/pen-geometry.md.

python docs/gallery/pen_counts.py
"""

from __future__ import annotations

import argparse

import numpy as np
from riffler.pen import PenGeometry

STROKE = 20  # postures


def postures(pen: PenGeometry, n: int) -> np.ndarray:
    """Counts of those of `n` random poses, tilted up to 60° from upright in the workspace, that the arms reach."""
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(n, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    axes = axes[axes[:, 2] > 0.5]
    places = rng.uniform(pen.limits.lower, pen.limits.upper, (len(axes), 3))
    joints, reach = pen.inverse(np.column_stack([places, axes]))
    return pen.counts(joints[[pair == ("reached", "reached") for pair in reach]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fast", action="store_true", help="fewer postures")
    pen = PenGeometry.load("riffler")
    counts = postures(pen, 4_000 if parser.parse_args().fast else 200_000)
    noticed = pen.noticed_counts(counts)
    strokes = noticed[: len(counts) // STROKE * STROKE].reshape(-1, STROKE, 6).min(axis=1)
    print(f"{len(counts)} postures; rounding alone leaves {abs(pen.stretch(counts)).max():.3f} mm; noticed from")
    print(f"{'':34}" + "".join(f"{c.name:>6}" for c in pen.channels))
    rows = {
        "at home": pen.noticed_counts([pen.home])[0],
        "half of all postures": np.median(noticed, axis=0),
        "95 of 100 postures": np.quantile(noticed, 0.95, axis=0),
        f"within {STROKE} postures, 95 of 100": np.quantile(strokes, 0.95, axis=0),
        f"within {STROKE} postures, all": strokes.max(axis=0),
    }
    for name, row in rows.items():
        print(f"{name:34}" + "".join(f"{value:6.0f}" for value in row))


if __name__ == "__main__":
    main()
