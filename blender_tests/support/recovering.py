"""Runs in a Blender of its own that will be killed: a sculpt carved in strokes, reported line by line.

The job's `what`: "stroke", one that never ends; "rest", strokes and then nothing; "end", the add-on is disabled after
them; "modes", a sculpt for each of three other modes; "shapes", strokes of hand tools and brushes with falloff by the
operator. In the middle of the last strokes of these two, the journal is copied to `copies`, as a crash would leave it.
`path`: a file to save before the first stroke, or "". Each line is printed when the carve that it reports has returned.
"""

import hashlib
import json
import math
import os
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import bpy
import numpy as np

from support import common, harness, report

if __name__ == "__main__":
    common.JOB, common.MODULE = harness.job, harness.install()
import riffler

BALL = riffler.Tool.ball(6, 30)
SIZE, PITCH = (60, 60, 20), 0.8
ROWS = 5  # rows per carve
TOP = 14.0  # mm; of the stock of "shapes"
TOOL = json.dumps(BALL.to_dict())
PIECES = 6  # carves of each of the last strokes of "shapes"
ROWS_OF_MODES = 100
PIXEL, PIXELS = 0.1, (600, 600)  # mm; of the view from above, in which the operator's strokes are made
BRUSHES = ("CLAY", "TWIST", "GRAB", "CREASE", "SNAKE_HOOK", "SCRAPE")  # of the strokes of "shapes", after hand tools
MODES = ("remove", "add", "mask", "remove")  # of the strokes before the last


def lane(k):
    y = 8 + 12 * (k // 2)
    return np.array([[8.0, y, 18, 0, 0, 1], [50, y, 18 - 0.5 * k, 0, 0, 1]])


def spiral(rows):
    """The first rows of the last stroke: down through the block. Not by numpy's sine, which on some processors depends
    on the array's address."""
    turns = [0.03 * k for k in range(rows + 1)]
    return np.array([[30 + 20 * math.cos(a), 30 + 20 * math.sin(a), 19 - 0.07 * a, 0, 0, 1] for a in turns])


def expected(rows, mode="remove"):
    """The volume after the strokes, and so many rows of the last one."""
    return both(rows, mode)[0]


def both(rows, mode):
    """And the mask."""
    volume = riffler.Volume.block((0, 0, 0), SIZE, PITCH, "xyz")
    mask = riffler.Volume.empty((0, 0, 0), SIZE, PITCH, "xyz")
    for k, before in enumerate(MODES):
        if before == "mask":
            mask.carve(BALL, lane(k), mode="add")
        else:
            volume.carve(BALL, lane(k), mode=before, protect=mask)
    poses = spiral(rows)
    for k in range(0, rows, ROWS):
        piece = poses[k : k + ROWS + 1]
        if mode == "soften":  # the first of a piece was dabbed with the previous one
            volume.smooth(piece[1 if k else 0 :, :3], 0.5 * BALL.diameter, strength=0.5, protect=mask)
        elif mode in ("mask", "unmask"):
            mask.carve(BALL, piece, mode="add" if mode == "mask" else "remove")
        else:
            volume.carve(BALL, piece, mode=mode, protect=mask)
    return volume, mask


def first_strokes(run):
    for k, mode in enumerate(MODES):
        run.begin_stroke()
        run.carve(BALL, lane(k), mode=mode)
        run.finish_stroke(bpy.context, mode)
    while not run.persistence.journal.settled():
        time.sleep(0.01)


def last_stroke(run, forever):
    run.begin_stroke()
    k = 0
    while forever or k < 200:
        run.carve(BALL, spiral(k + ROWS)[k:], new=k == 0)
        k += ROWS
        report.say(rows=k)
        time.sleep(0.002)
    run.finish_stroke(bpy.context, "last")


def say_copy(run, mode, **more):
    """Copies the journal at once: all that the last carve has written must be in it."""
    copy = Path(common.JOB["copies"]) / mode
    shutil.rmtree(copy, ignore_errors=True)
    report.say(mode=mode, copy=str(shutil.copytree(run.persistence.journal.folder, copy)), **more)


def modes():
    """A new sculpt for each mode, each in a file of its own, so that all have the same name."""
    for mode in ("add", "soften", "mask"):
        run = begun("")
        first_strokes(run)
        run.begin_stroke()
        for k in range(0, ROWS_OF_MODES, ROWS):
            run.carve(BALL, spiral(k + ROWS)[k:], mode=mode, new=k == 0)
        say_copy(run, mode, rows=ROWS_OF_MODES)
        run.finish_stroke(bpy.context, mode)
        bpy.ops.wm.read_homefile(use_empty=False)


def digest(content):
    """Hash of the bytes of a volume and its mask."""
    mask = b"" if content.mask is None else content.mask.to_bytes()
    return hashlib.sha256(content.volume.to_bytes() + mask).hexdigest()


def shape(mode, *places, **more):
    """A stroke by the operator, through places (mm) seen from above."""
    matrix = np.diag([2 / (PIXELS[0] * PIXEL), 2 / (PIXELS[1] * PIXEL), -0.01, 1.0])
    matrix[:3, 3] = -(matrix[:3, :3] @ np.array([30.0, 30, 0]))
    view = {"matrix": matrix.ravel().tolist(), "size": list(PIXELS)}
    text = json.dumps({"view": view, "rows": [[x / PIXEL, y / PIXEL] for x, y in places]})
    made = bpy.ops.riffler.stroke("EXEC_DEFAULT", True, stroke=text, mode=mode, **more)
    assert made == {"FINISHED"}, mode


def piece(mode, k):
    """Piece k of a stroke with the tool of `mode`: its poses."""
    x = [30 + 1.5 * (k + j / ROWS) for j in range(ROWS + 1)]
    if mode == "hand":  # a blade that leans back and rises
        lean = math.sqrt(0.5)
        return np.array([[at, 40, TOP - 0.6 + 0.05 * k, -lean, 0, lean, lean, 0, lean] for at in x])
    if mode == "grab":  # from the first place to the current one
        return np.array([[30.0, 45, TOP, 0, 0, 1], [x[-1], 45, TOP, 0, 0, 1]])
    return np.array([[at, 42, TOP, 0, 0, 1] for at in x])


def shapes(run):
    """Hand tools with a mirrored copy and brushes, half of them near a mask, then strokes in whose middle the journal
    is copied."""
    settings = bpy.context.scene.riffler.sculpt
    settings.depth, settings.strength, settings.falloff, settings.axis, settings.string = 0.6, 0.5, "ROOT", "NORMAL", 0
    settings.mirror, settings.radial = {"Y"}, 1
    run.begin_stroke()
    run.carve(riffler.Tool.flat(100, 30), np.array([[30.0, 30, TOP, 0, 0, 1], [31, 30, TOP, 0, 0, 1]]))
    run.finish_stroke(bpy.context, "room above")
    for preset, y in (("Gouge No. 7, 10 mm", 8), ("Skew Chisel 10 mm, 20°", 20)):
        bpy.ops.riffler.hand_tool_preset(name=preset)
        shape("HAND", (8, y), (24, y + 4), (50, y))
    settings.mirror = set()
    for k, brush in enumerate(BRUSHES):
        if k == len(BRUSHES) // 2:
            run.begin_stroke()
            run.carve(BALL, lane(3) - [0, 0, 18 - TOP, 0, 0, 0], mode="mask")
            run.finish_stroke(bpy.context, "mask")
        shape(brush, (12 + 3 * k, 18), (20 + 3 * k, 22), (30 + 3 * k, 21), tool=TOOL)
    for mode in ("hand", "grab", "twist"):
        tool = riffler.Tool.gouge(6, 4, math.radians(30), 40) if mode == "hand" else BALL
        run.begin_stroke()
        for k in range(PIECES):
            run.carve(tool, piece(mode, k), mode=mode, new=k == 0)
        say_copy(run, mode, digest=digest(run))
        run.finish_stroke(bpy.context, mode)


def begun(path):
    """A live sculpt, in a file of that path."""
    common.scale(1)
    name = common.stock(size=SIZE, pitch=PITCH, directions="xyz").name
    if path:
        bpy.ops.wm.save_as_mainfile(filepath=path)
    run = common.part("sculpt.live_registry").begin(bpy.context, bpy.data.objects[name])
    run.persistence._packing.nbytes = 1e9
    return run


def main():
    job = common.JOB
    common.part("sculpt.persistence").folder = lambda: Path(job["journals"])
    if job["what"] == "modes":
        modes()
    elif job["what"] == "shapes":
        shapes(begun(job["path"]))
    else:
        run = begun(job["path"])
        first_strokes(run)
        last_stroke(run, job["what"] == "stroke")
    if job["what"] == "end":
        bpy.ops.preferences.addon_disable(module=common.MODULE)
    report.say(rested=True)
    time.sleep(0 if job["what"] == "end" else 1000)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
