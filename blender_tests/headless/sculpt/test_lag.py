"""The delay for a hand of 125 events a second on 1.3 million triangles, in this process's own processor time: other
work of the computer does not count, nor does drawing, which a graphics card does. On a slow computer the hand is slower
in proportion."""

import time

import bpy
import numpy as np

from support import common

SIDE, RATE = 130.0, 125  # mm, 1/s
TRIES = 3  # other work displaces the caches, and so slows this process, for a part of a stroke


def spiral(seconds):
    """Pixels of 0.25 mm: a turn in two seconds, 400 pixels a second, on a quick computer."""
    n = RATE * seconds
    turn = np.linspace(0, np.pi * seconds, n)
    radius = np.linspace(120, 140, n)  # nearly constant speed: a faster hand reaches more chunks
    return np.c_[500 + radius * np.cos(turn), 500 + radius * np.sin(turn)].round()


def waits(live, mirror, seconds):
    """Seconds from each place of the hand to the end of the update that shows it; the clock advances with this work
    only, and runs slower on a slow computer."""
    brush, symmetry = common.part("sculpt.pure.brush_stroke"), common.part("sculpt.pure.symmetry")
    sample, look = common.part("sculpt.pure.stroke_path").Sample, common.part("sculpt.stroke_operator").LOOK
    sight = common.part("sculpt.pure.view_rays").ViewRays(
        np.diag([2 / (1000 * 0.25)] * 2 + [-0.001, 1.0]), (1000, 1000)
    )
    live.maps = symmetry.maps(mirror)
    made = brush.BrushStroke(live, {"kind": "ball", "diameter": 6.0, "length": 30.0}, sight, brush.Choice(depth=0.5))
    places, now, done, out, slow = spiral(seconds), 0.0, 0, [], common.slowness()
    while done < len(places):
        now = max(now, done / RATE)  # a hand that waits for the loop
        waiting = places[done : int(now * RATE) + 1]
        begin = time.process_time()
        for k, (x, y) in enumerate(waiting, done):
            made.add(sample(x, y, time=k / RATE))
        made.look()
        bpy.context.view_layer.update()
        cost = (time.process_time() - begin) / slow
        out += [now + cost - k / RATE for k in range(done, done + len(waiting))]
        done += len(waiting)
        now += max(cost, look)
    made.end()
    live.finish_stroke(bpy.context, "Stroke")
    return np.array(out)


def grows(out):
    early, late = np.split(out, 2)
    return np.median(late) >= 1.5 * np.median(early) + 0.02


@common.core_bound
def test_a_million_triangles_keep_up_with_the_hand():
    bpy.ops.riffler.new_stock(source="BLOCK", origin="CENTRE", size=(SIDE, SIDE, 10), pitch=0.25, directions="xyz")
    live = common.part("sculpt.live_registry").begin(bpy.context, bpy.context.object)
    assert live.mesher.all_triangles > 1.2e6
    for mirror, seconds in (("", 2), ("X", 4)):  # the longer one makes both copies of each place
        out = next((o for o in (waits(live, mirror, seconds) for _ in range(TRIES)) if not grows(o)), None)
        assert out is not None, "it grows"
        figures = [*(round(1000 * x) for x in np.percentile(out, (50, 95, 100))), live.stages.milliseconds()]
        common.figure(
            f"hand on {live.mesher.all_triangles} triangles, mirror {mirror!r}: ms p50, p95, longest", figures
        )
        assert np.median(out) < 0.3, figures  # on a busy machine processor time doubles
