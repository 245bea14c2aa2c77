"""Pictures of a window, compared loosely: a grid of mean luminance and one of edge strength, by kind of area.

Fonts, anti-aliasing and the mouse's place must not fail a test; a missing panel, an empty view or an error over
everything must. References are kept per version of Blender, as text: references/4.3.json. A run writes its grids to
<out>/pictures-4.3.json; after looking at the pictures next to it,

python blender_tests/windowed/pictures.py out/blender/pictures-3.4.json [name …]

makes them (or the named ones) the references.
"""

from __future__ import annotations

import fcntl
import json
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np

COLUMNS, ROWS = 32, 20
REFERENCES = Path(__file__).resolve().parent / "references"
# A cell differs if its luminance (of 0 to 1) does by more than LUMINANCE, or its edge strength by more than EDGES and
# PART of the stronger one. Runs on one machine differ in no cell; a spiral cut into a block differs from the block in
# 11 % of the view's cells, from one cut further in 3 to 5 %.
LUMINANCE, EDGES, PART = 0.03, 0.006, 0.4
# Share of an area's cells that may differ, by its kind. The bars of menus and status, with versions and times, are no
# areas of a screen and not compared.
SHARE = {"VIEW_3D": 0.03, "SIDEBAR": 0.4}
OTHERS = 0.15


LUMA = np.array((0.212656, 0.715158, 0.072186), np.float32)  # of red, green and blue; ITU-R BT.709


def grab():
    """What the display shows, (height, width, 3) uint8. Unlike a PNG's, its bytes cost nothing to pack and unpack."""
    command = ["import", "-window", "root", "-depth", "8", "ppm:-"]
    data = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout
    magic, width, height, deepest = data.split(maxsplit=4)[:4]
    assert magic == b"P6" and deepest == b"255", data[:20]
    width, height = int(width), int(height)
    return np.frombuffer(data[-3 * width * height :], np.uint8).reshape(height, width, 3)


def write(path, image):
    """A PNG of (height, width, 3) uint8, packed loosely: in a tenth of ImageMagick's time."""
    height, width = image.shape[:2]
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with the number of its filter: 0, none
    rows[:, 1:] = image.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # 8 bits each of red, green and blue
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(rows, 1)), (b"IEND", b""))
    chunks = (
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in parts
    )
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))


def gray(image):
    """The luminance of (height, width, 3) uint8: (height, width) of 0 to 1, in steps of 1/255."""
    return np.rint(image @ LUMA) / 255


def cells(image):
    """Mean of each cell, (ROWS, COLUMNS)."""
    rows, columns = (
        np.linspace(0, n, m, endpoint=False).astype(int) for n, m in zip(image.shape, (ROWS, COLUMNS), strict=True)
    )
    sums = np.add.reduceat(np.add.reduceat(image, rows, axis=0), columns, axis=1)
    counts = np.outer(np.diff(rows, append=image.shape[0]), np.diff(columns, append=image.shape[1]))
    return sums / counts


def grids(image):
    """Luminance and edge strength (mean size of the steps to the next pixels), each (ROWS, COLUMNS) of 0 to 1."""
    steps = np.abs(np.diff(image, axis=0, append=image[-1:])) + np.abs(np.diff(image, axis=1, append=image[:, -1:]))
    return {"luminance": cells(image), "edges": cells(steps) / 2}


def to_text(grid):
    """Two hexadecimal digits a cell, a row a string."""
    return [bytes(row).hex() for row in np.rint(grid * 255).astype(np.uint8)]


def from_text(rows):
    return np.array([list(bytes.fromhex(row)) for row in rows]) / 255


def differing(found, kept):
    """Which cells do not look alike, (ROWS, COLUMNS) of bool."""
    edges = np.abs(found["edges"] - kept["edges"])
    stronger = np.maximum(found["edges"], kept["edges"])
    return (np.abs(found["luminance"] - kept["luminance"]) > LUMINANCE) | (edges > EDGES) & (edges > stronger * PART)


def covered(box):
    """Cells that differ, (ROWS, COLUMNS) of bool."""
    left, top, right, bottom = box
    x, y = (np.arange(COLUMNS) + 0.5) / COLUMNS, (np.arange(ROWS) + 0.5) / ROWS
    return np.outer((y >= top) & (y < bottom), (x >= left) & (x < right))


def judge(found, kept, areas, vary=()):
    """Areas that differ too much, a text for each; empty if the pictures match.

    areas: (kind, box) of the window's areas, those on top of others after them; box as in `covered`. vary: kinds, and
    boxes, that may differ.
    """
    off = differing(found, kept)
    for box in vary:
        if not isinstance(box, str):
            off &= ~covered(box)
    owner = np.full((ROWS, COLUMNS), -1)
    for i, (_, box) in enumerate(areas):
        owner[covered(box)] = i
    complaints = []
    for i, (kind, _) in enumerate(areas):
        inside = owner == i
        allowed = 1.0 if kind in vary else SHARE.get(kind, OTHERS)
        if inside.any() and (share := off[inside].mean()) > allowed:
            complaints.append(f"{kind}: {share:.0%} of its cells differ, {allowed:.0%} may")
    return complaints


def load(path):
    return json.loads(path.read_text()) if path.exists() else {}


def store(path, pictures):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.part")
    part.write_text(json.dumps(dict(sorted(pictures.items())), indent=0) + "\n")
    part.replace(path)


def note(out, version, pictures):
    """Adds them to <out>/pictures-<version>.json, which other windows write to, too."""
    with open(out / "pictures.lock", "w") as handle:
        fcntl.flock(handle, fcntl.LOCK_EX)
        notes = out / f"pictures-{version}.json"
        store(notes, load(notes) | pictures)


def check(image, out, name, version, areas, vary=()):
    """Records the grids of a picture, (height, width, 3) uint8, in the folder `out` and compares them with the
    reference of its name: a text on the differences, "" if there are none, None if this version has no references."""
    out = Path(out)
    text = {kind: to_text(grid) for kind, grid in grids(gray(image)).items()}
    note(out, version, {name: text})
    known = load(REFERENCES / f"{version}.json")
    if not known:
        return None
    if (kept := known.get(name)) is None:
        return "there is none"
    found, kept = ({kind: from_text(rows) for kind, rows in t.items()} for t in (text, kept))
    return "; ".join(judge(found, kept, areas, vary))


def main():
    source, *names = sys.argv[1:]
    version = Path(source).stem.removeprefix("pictures-")
    found = load(Path(source))
    taken = {name: found[name] for name in names or found}
    target = REFERENCES / f"{version}.json"
    store(target, load(target) | taken)
    print(f"{target}: {', '.join(taken)}")


if __name__ == "__main__":
    main()
