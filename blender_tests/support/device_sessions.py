"""Sessions of devices for the tests: sculpts, a simulated hand, and one that a test moves."""

import time
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, sculpting
from support.sculpting import live

FAST = {"device": "simulated", "gap": 0.0, "scale": 1.0, "removal_constant": 0.001}
NAME = "Stock"


def sculpt(directions="z"):
    return bpy.data.objects[sculpting.sculpt(directions=directions)]


def sculpt_for(seconds, **more):
    return bpy.ops.riffler.pen_sculpt("EXEC_DEFAULT", True, seconds=seconds, tool=common.BALL, **{**FAST, **more})


def until_cut(**more):
    """A simulated hand needs some seconds, and a busy computer cuts the force now and then and gives it few steps: each
    try has twice the time of the one before."""
    for seconds in (4.0, 8.0, 16.0, 32.0):
        if sculpt_for(seconds, **more) == {"FINISHED"}:
            return
    raise AssertionError("the simulated hand has cut nothing four times")


def sessions():
    return common.part("pen.session")


def no_session():
    assert sessions().running is None and not bpy.context.window_manager.riffler.sculpting
    left = [ob.name for ob in bpy.data.objects if ob.name.startswith("Riffler Tool") and ob.visible_get()]
    assert not left, left


def work():
    return live().of(bpy.data.objects[NAME])


def now():
    return live().content(bpy.data.objects[NAME]).volume.to_bytes()


def folder(name):
    path = Path(common.out(name))
    path.mkdir(exist_ok=True)
    for file in path.iterdir():
        file.unlink()
    return path


def journals():
    keeping = common.part("sculpt.persistence")
    return [j for j in keeping._open if work() is not None and j is work().persistence.journal]


def lowered(directions="z"):
    """A sculpt with air above z = 16."""
    ob = sculpt(directions)
    run = live().begin(bpy.context, ob)
    run.begin_stroke()
    run.carve(riffler.Tool.flat(150, 40), np.array([[-80, 30, 16, 0, 0, 1], [140, 30, 16, 0, 0, 1.0]]))
    run.finish_stroke(bpy.context, "lowered")
    return ob


class Hand:
    """A session whose device is a mouse that a test moves: a stroke is a groove along x, 1 mm deep, or in mode "add" a
    ridge on what is `lowered`. It waits if the computer is busy: a session steps with the newest event only."""

    def __init__(self, ob, record=None, mode="remove", **options):
        tool = common.part("sculpt.brushes").of(mode).cutter(riffler.Tool.ball(6, 30), 0.5)
        self.pen, self._time = riffler.pen.Pointer("mouse"), 0.0
        self.pen.set_frame(origin=(0, 0, 17 if mode == "add" else 20), depth=1.0)
        self._give(-10, 0, 0)
        options |= {"material": riffler.Material(removal_constant=1e-5), "stiffness": 5.0, "mode": mode}
        self.session, self._felt = sessions().PenSession(bpy.context, ob, self.pen, tool, options, record), None
        run = self.session.run
        take = run._take

        def taking(frame):
            if len(frame):
                self._felt = frame.grips[-1]
            take(frame)

        run._take = taking
        common.push("Sculpt with Pen")

    def _give(self, x, y, pressed):
        self._time += 0.008
        self.pen.give(x, y, pressure=float(pressed), buttons=int(pressed), time=self._time)

    def _go(self, x, y, pressed):
        """Moves there, and waits until a step was made with it that cuts when pressed: after a late step the session
        cuts the force for half a second. Or until the session has ended."""
        self._give(x, y, pressed)
        there, run = self.pen.state().pose, self.session.run
        return self.look(
            lambda: self._felt is not None
            and np.array_equal(self._felt, there)
            and (not pressed or run.state in ("ramp", "active"))
        )

    def down(self, y, first=5, last=45):
        """The hand comes and cuts; it does not release."""
        self._go(first, y, 0)
        for x in np.arange(first, last, 2.0):
            self._go(x, y, 1)

    def up(self, x=60, y=0):
        self._go(x, y, 0)

    def look(self, done, seconds=20.0):
        end = time.monotonic() + seconds
        while not done():
            assert time.monotonic() < end, "nothing came of it"
            if not self.session.look():
                return False
            time.sleep(0.005)
        return True

    def stroke(self, y):
        """Returns the bytes of the volume after it."""
        self.session.look()
        before = self.session.count
        self.down(y)
        self.up(y=y)
        assert self.look(lambda: self.session.count > before and not self.session.run.in_stroke)
        return now()


def now_of(ob):
    return live().content(ob).volume.to_bytes()


def nothing_is_left_but_redo():
    assert not common.part("sculpt.chunks").shown() and bpy.data.objects[NAME].visible_get()
