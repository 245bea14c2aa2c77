"""Runs in a Blender of its own that will be killed: a sculpt carved in strokes, reported line by line.

The job's `what`: "stroke", one that never ends; "rest", strokes and then nothing; "end", the add-on is disabled after
them. `path`: a file to save before the first stroke, or ""; `stroke`: mode of the last one. Each line is printed when
the carve that it reports has returned.
"""

import math
import os
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
SIZE = (60, 60, 20)
ROWS = 5  # rows per carve
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
    volume = riffler.Volume.block((0, 0, 0), SIZE, 0.5, "xyz")
    mask = riffler.Volume.empty((0, 0, 0), SIZE, 0.5, "xyz")
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


def last_stroke(run, forever, mode):
    run.begin_stroke()
    k = 0
    while forever or k < 200:
        run.carve(BALL, spiral(k + ROWS)[k:], mode=mode, new=k == 0)
        k += ROWS
        report.say(rows=k)
        time.sleep(0.002)
    run.finish_stroke(bpy.context, "last")


def main():
    job = common.JOB
    common.part("sculpt.persistence").folder = lambda: Path(job["journals"])
    common.scale(1)
    name = common.stock(size=SIZE, pitch=0.5, directions="xyz").name
    if job["path"]:
        bpy.ops.wm.save_as_mainfile(filepath=job["path"])
    run = common.part("sculpt.live_registry").begin(bpy.context, bpy.data.objects[name])
    if not job["small"]:
        run.persistence._packing.nbytes = 1e9
    for k, mode in enumerate(MODES):
        run.begin_stroke()
        run.carve(BALL, lane(k), mode=mode)
        run.finish_stroke(bpy.context, mode)
    while not run.persistence.journal.settled():
        time.sleep(0.01)
    last_stroke(run, job["what"] == "stroke", job["stroke"])
    if job["what"] == "end":
        bpy.ops.preferences.addon_disable(module=common.MODULE)
    report.say(rested=True)
    time.sleep(0 if job["what"] == "end" else 1000)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
