"""Thousands of strokes in every mode and walks through Blender's history: each state is right to the byte, and nothing
grows.

Blocks are carved one after the other, a tenth of the strokes each, so that the data of one stays bounded. The reference
is a replay of the poses by plain Volume.carve and Volume.soften, with masks and mirrors of its own.
"""

import hashlib
import json
from dataclasses import dataclass, field

import bpy
import numpy as np
import riffler
from soak import footprint

from support import common, report

BLOCKS = 10  # the first is to warm up
SIZE = (24.0, 20.0, 10.0)
PITCH = 0.5
PIXELS, PIXEL = (400, 300), 0.1  # mm
MODES = ("REMOVE",) * 4 + ("ADD",) * 3 + ("SOFTEN", "MASK", "UNMASK")
TOOLS = (
    '{"kind": "ball", "diameter": 4.0, "length": 20.0}',
    '{"kind": "flat", "diameter": 3.0, "length": 20.0}',
    '{"kind": "ball", "diameter": 1.5, "length": 20.0}',
)
DEPTH = 20  # steps of a walk back
GROWTH, ROOM = 1.05, 8.0  # allowed growth of memory from the first blocks to the last; MB for the allocators
REST = 50  # strokes between two rests of the hand, at which a walk begins, too
KEPT = 25  # states between two that the replay keeps


@dataclass
class State:
    digest: str
    carves: list  # the carves that made it from the previous one
    reference: tuple | None = None  # (volume, mask) of the replay


@dataclass
class Recorder:
    """Sits between brushes and live sculpts, and records what is carved."""

    carves: list = field(default_factory=list)

    def __enter__(self):
        self._live = common.part("sculpt.live_sculpt").LiveSculpt
        self._carve = self._live.carve

        def carve(run, tool, poses, dt=None, mode="remove", new=True):
            mirror = sorted(bpy.context.scene.riffler.sculpt.mirror)
            self.carves.append((tool, np.array(poses, float), mode, new, mirror, run.strength))
            return self._carve(run, tool, poses, dt, mode, new)

        self._live.carve = carve
        return self

    def __exit__(self, *_):
        self._live.carve = self._carve

    def take(self):
        taken, self.carves = self.carves, []
        return taken


def replayed(volume, mask, carves):
    """The reference: `volume` and `mask` after the carves. The blocks' middle is the origin."""
    volume, mask = volume.copy(), mask.copy() if mask is not None else None
    for tool, poses, mode, new, mirror, strength in carves:
        sides = [np.ones(6)]
        for letter in mirror:
            flip = np.ones(6)
            flip["XYZ".index(letter) :: 3] = -1
            sides += [s * flip for s in sides]
        for side in sides:
            rows = poses * side + 0.0  # no negative zeros
            if mode == "soften":
                dabs = rows[0 if new else 1 :, :3]
                if len(dabs):
                    volume.smooth(dabs, 0.5 * tool.diameter, strength=strength, protect=mask)
            elif mode in ("mask", "unmask"):
                if mask is None:
                    mask = riffler.Volume.empty(volume.lower, volume.upper, volume.pitch, volume.directions)
                mask.carve(tool, rows, mode="add" if mode == "mask" else "remove")
            else:
                volume.carve(tool, rows, mode=mode, protect=mask)
    return volume, mask


def same(content, reference):
    volume, mask = reference
    if content.volume.to_bytes() != volume.to_bytes():
        return False
    if content.mask is None or mask is None:
        return content.mask is mask
    return content.mask.to_bytes() == mask.to_bytes()


class Block:
    """One sculpt, the test's own record of its history, and Blender's place in it."""

    def __init__(self, rng, recorder):
        self.rng, self.recorder = rng, recorder
        common.scale(1)
        self.name = common.stock(size=SIZE, pitch=PITCH, directions="xyz", origin="CENTRE").name
        common.push("stock")
        lower = -0.5 * np.array(SIZE)
        whole = riffler.Volume.block(lower, -lower, PITCH, "xyz")
        self.states, self.at = [State(self.digest(), [], (whole, None))], 0

    def content(self):
        return common.part("sculpt.live_registry").content(bpy.data.objects[self.name])

    def digest(self):
        content = self.content()
        mask = content.mask.to_bytes() if content.mask is not None else b""
        return hashlib.sha256(content.volume.to_bytes() + mask).hexdigest()

    # ------------------------------------------------------------------ what a hand does
    def stroke(self):
        rng = self.rng
        settings = bpy.context.scene.riffler.sculpt
        settings.mirror = set() if rng.random() < 0.8 else {"X"} if rng.random() < 0.5 else {"X", "Y"}
        settings.accumulate = bool(rng.random() < 0.2)
        settings.axis = ("NORMAL", "VIEW", "UP", "TILT")[rng.integers(4)]
        settings.depth = float(rng.uniform(0.1, 0.8))
        self.recorder.take()
        done = bpy.ops.riffler.stroke(
            "EXEC_DEFAULT", True, mode=MODES[rng.integers(len(MODES))], stroke=self._way(), tool=TOOLS[rng.integers(3)]
        )
        carves = self.recorder.take()
        digest = self.digest()
        if done == {"FINISHED"}:
            del self.states[self.at + 1 :]
            self.states.append(State(digest, carves))
            self.at += 1
            if self.at % KEPT == 0:
                self.states[self.at].reference = self._replayed()
        assert digest == self.states[self.at].digest, "what was cancelled has changed something"

    def _way(self):
        """A stroke as JSON: seen from one of five sides, across the block or past it."""
        rng = self.rng
        side = rng.integers(5)
        back = np.eye(3)[(2, 0, 1, 0, 1)[side]] * (1, 1, 1, -1, -1)[side]
        up = np.eye(3)[1 if side == 0 else 2]
        matrix = np.diag([0.0, 0, 0, 1])
        for row, (along, size) in enumerate(((np.cross(up, back), PIXELS[0]), (up, PIXELS[1]))):
            matrix[row, :3] = along * 2 / (size * PIXEL)
        matrix[2, :3] = -0.01 * back
        count = int(rng.integers(1, 7))
        places = 0.5 * np.array(PIXELS) + np.cumsum(rng.normal(scale=(40, 25), size=(count, 2)), axis=0)
        rows = [[*place, *rng.uniform(0.2, 1, 1), *rng.normal(scale=0.3, size=2), 0.05 * k] for k, place in
                enumerate(places.tolist())]  # fmt: skip
        looks = [int(rng.integers(count + 1))] if rng.random() < 0.3 else []
        view = {"matrix": matrix.ravel().tolist(), "size": list(PIXELS)}
        return json.dumps({"view": view, "rows": rows, "looks": looks})

    def walk(self, steps):
        """Undo and redo at random; at each step the state is that of the history."""
        lowest = max(0, len(self.states) - 1 - DEPTH)
        for _ in range(steps):
            back = self.at > lowest and (self.at == len(self.states) - 1 or self.rng.random() < 0.6)
            if not back and self.at == len(self.states) - 1:
                return
            (bpy.ops.ed.undo if back else bpy.ops.ed.redo)()
            self.at += -1 if back else 1
            assert self.digest() == self.states[self.at].digest, f"{'undo' if back else 'redo'} to {self.at}"

    def rest(self):
        run = common.part("sculpt.live_registry").of(bpy.data.objects[self.name])
        if run is not None:
            run.rest(run.object)

    # ------------------------------------------------------------------ what it should be
    def _replayed(self):
        first = max(k for k in range(self.at + 1) if self.states[k].reference)
        carves = [c for state in self.states[first + 1 : self.at + 1] for c in state.carves]
        return replayed(*self.states[first].reference, carves)

    def check(self):
        assert same(self.content(), self._replayed()), f"state {self.at} is not what its strokes make"


def carved(rng, recorder, strokes, walks):
    """A block of so many strokes and steps through the history; the memory during it, in MB, and the resources at its
    end."""
    bpy.ops.wm.read_homefile(use_empty=False)
    block, memory, walked = Block(rng, recorder), [], 0
    for k in range(1, strokes + 1):
        block.stroke()
        if k % REST == 0 or k == strokes:
            block.check()
            share = walks * k // strokes - walked
            block.walk(share)
            walked += share
            block.check()
            block.rest()
            memory.append(footprint.resident())
    held = {f"{name}, at work": count for name, count in footprint.held().items()}
    bpy.ops.wm.save_as_mainfile(filepath=common.out("soak.blend"))
    block.check()
    bpy.ops.wm.open_mainfile(filepath=common.out("soak.blend"))
    assert same(common.content(bpy.data.objects[block.name]), block._replayed()), "not what was saved"
    return float(np.median(memory)), {**held, **footprint.held()}


def test_strokes_and_undos_leave_nothing_behind():
    chosen = common.JOB["soak"]
    rng = np.random.default_rng(chosen["seed"])
    with Recorder() as recorder:
        blocks = [carved(rng, recorder, chosen["strokes"] // BLOCKS, chosen["undos"] // BLOCKS) for _ in range(BLOCKS)]
    memory, held = zip(*blocks, strict=True)
    report.say(note=f"memory of the blocks, MB: {', '.join(f'{m:.0f}' for m in memory)}")
    # Where a block is a hundred strokes, allocators settle within the first ones: 327, 341, 348, 352, … MB.
    settled = memory[1] if chosen["long"] else max(memory[1:4])
    assert memory[-1] <= GROWTH * settled + ROOM, memory
    grown = {name: (held[1].get(name, 0), n) for name, n in held[-1].items() if n > held[1].get(name, 0)}
    assert not grown, f"from the second block to the last: {grown}"
