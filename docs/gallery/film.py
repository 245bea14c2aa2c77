"""Suzanne being engraved by the demonstration's recorded strokes, as an animated picture: docs/images/carving.webp.

python docs/gallery/film.py

Every frame is the mesh of the volume at that moment, with the cutter where the recording has it. The cutter's shank is
drawn only, not carved with.
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import riffler
from common import options
from picture import CLAY, ROOT, Picture
from PIL import Image

FRAMES = 44  # about: every stroke has one at least
SIZE = (560, 420)  # px
FRAME, LAST = 130, 2600  # ms that a frame and the last one are shown
VIEW = {"eye": (-45, -330, 215), "target": (0, -2, 2), "floor": -48, "width": 146, "size": SIZE, "samples": 8}


def suzanne(folder: Path, blender: Path) -> riffler.Mesh:
    path = folder / "suzanne.stl"
    subprocess.run([str(blender), str(ROOT / "demo/suzanne.py"), str(path)], check=True, capture_output=True)
    return riffler.Mesh.read(path)


def carved(volume: riffler.Volume, journal: riffler.Journal, rows: int) -> Iterator[tuple[riffler.Tool, np.ndarray]]:
    """Carves `rows` rows of the recording at a time; yields the tool and its pose after each piece."""
    for stroke in journal.strokes:
        tool = riffler.Tool.from_dict(journal.tools[stroke.tool])
        for start in range(0, len(stroke.poses) - 1, rows):
            piece = stroke.poses[start : start + rows + 1]
            volume.carve(tool, piece, tolerance=stroke.tolerance)
            yield tool, piece[-1]


def frame(out: Path, volume: riffler.Volume, blender: Path, tool: riffler.Tool | None, pose) -> None:
    picture = Picture()
    picture.mesh(volume.to_mesh(), CLAY, smooth=32)
    if tool is not None:
        end, radius = tool.length, 0.5 * tool.diameter
        picture.tool(tool.with_shank([(end, radius, end + 30, radius), (end + 30, 6, end + 70, 6)]), pose)
    picture.photograph(out, blender, **VIEW)


def film(pictures: list[Path], out: Path) -> None:
    images = [Image.open(path).convert("RGB") for path in pictures]
    shown = [FRAME] * (len(images) - 1) + [LAST]
    images[0].save(out, save_all=True, append_images=images[1:], duration=shown, loop=0, quality=68, method=6)


def main() -> None:
    given = options(__doc__)
    journal = riffler.Journal.load(ROOT / "demo/strokes.rjournal")
    rows = sum(len(stroke.poses) for stroke in journal.strokes)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        volume = riffler.Volume.from_mesh(suzanne(folder, given.blender), 0.6 if given.fast else 0.4, "xyz")
        pictures = []
        for tool, pose in carved(volume, journal, rows // FRAMES):
            if given.fast:
                continue
            pictures.append(folder / f"{len(pictures):03}.jpg")
            frame(pictures[-1], volume, given.blender, tool, pose)
        print(f"{volume.volume:.0f} mm³, {len(pictures)} frames")
        if not given.fast:
            pictures.append(folder / "last.jpg")
            frame(pictures[-1], volume, given.blender, None, None)
            film(pictures, given.out.parent / "carving.webp")


if __name__ == "__main__":
    main()
