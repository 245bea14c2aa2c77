"""A mouse at 125 events a second, from outside, on 1.3 million triangles: the time from a place of the hand until its
material is gone, from the first second to the last, and until the stroke is over. The software renderer takes half a
second for a picture of that; with the chunks drawn as boxes only the time of Riffler and Blender is left. On a slow or
busy computer the hand sends fewer events, except for measurements."""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

REAL_EVENTS = True
strokes = harness.load(Path(__file__).with_name("window_stroke.py"))

# Another process, so that nothing here slows the hand; perf_counter is one clock for all.
HAND = """
import json, subprocess, sys, time
places, path, rate = json.loads(sys.argv[1]), sys.argv[2], float(sys.argv[3])
xdotool = subprocess.Popen(["xdotool", "-"], stdin=subprocess.PIPE)
def send(line):
    xdotool.stdin.write(line.encode() + b"\\n"); xdotool.stdin.flush()
    return time.perf_counter()
send("mousemove %d %d" % tuple(places[0])); time.sleep(0.5)
send("mousedown 1"); time.sleep(0.3)
begin, sent = time.perf_counter(), []
for k, (x, y) in enumerate(places):
    time.sleep(max(0, begin + k / rate - time.perf_counter()))
    sent.append([x, y, send("mousemove %d %d" % (x, y))])
end = send("mouseup 1")
xdotool.stdin.close(); xdotool.wait()
json.dump({"sent": sent, "end": end}, open(path, "w"))
"""


def circles(screen, seconds):
    """Pixels of the display, y down: a spiral, so that each pixel has its own time."""
    middle = strokes.pixel(screen, (0.5 * SIDE, 0.5 * SIDE, 10))
    n = int(RATE * seconds)
    turn = np.cumsum(np.full(n, 2 * np.pi / 250))  # a turn in two seconds
    radius = np.linspace(60, 160, n)
    x, y = middle[0] + radius * np.cos(turn), middle[1] + radius * np.sin(turn)
    return np.c_[x, screen.window.height - 1 - y].round().astype(int)


SIDE, RATE = 130.0, 125  # mm, 1/s


class Watch:
    """The times when each sample was carved and when the result was shown, independent of the stroke's loop."""

    def __init__(self):
        self.brush = common.part("sculpt.pure.brush_stroke").BrushStroke
        self.added, self.shown = [], []  # (x, y); (time, how many samples were added)
        self.kept = self.brush.add, self.brush.look
        watch = self

        def add(brush, sample):
            watch.added.append((sample.x, sample.y))
            return watch.kept[0](brush, sample)

        def look(brush):
            result = watch.kept[1](brush)
            watch.shown.append((time.perf_counter(), len(watch.added)))
            return result

        self.brush.add, self.brush.look = add, look

    def close(self):
        self.brush.add, self.brush.look = self.kept

    def lags(self, told, corner, height):
        """(seconds of the hand, seconds until shown) of each sample."""
        times = {}
        for x, y, t in told["sent"]:
            times[x - corner[0], height - 1 - y - corner[1]] = t
        begin, out = told["sent"][0][2], []
        looks = np.array(self.shown)
        for k, place in enumerate(self.added):
            sent = times.get((int(place[0]), int(place[1])))
            after = np.searchsorted(looks[:, 1], k + 1) if len(looks) else 0
            if sent is not None and after < len(looks):
                out.append((sent - begin, looks[after, 0] - sent))  # to the end of the update, before it is drawn
        return np.array(out)


def timed_stroke(screen, name, seconds):
    slow = 1.0 if harness.job["measure"] else common.slowness(time.perf_counter)
    common.figure("the hand is slower by", round(slow, 2))
    places = circles(screen, seconds)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hand.json"
        watch, operator = Watch(), common.part("sculpt.stroke_operator")
        operator.last = ""
        hand = subprocess.Popen([sys.executable, "-c", HAND, json.dumps(places.tolist()), str(path), str(RATE / slow)])
        yield lambda: operator.last  # a short one is over before its beginning can be polled
        ended = time.perf_counter()
        watch.shown.append((ended, len(watch.added)))
        yield lambda: hand.poll() is not None
        watch.close()
        told = json.loads(path.read_text())
    region = screen.region()
    lags = watch.lags(told, (region.x, region.y), screen.window.height)
    table = []
    for low in range(0, int(seconds * slow), 2):
        part = lags[(lags[:, 0] >= low) & (lags[:, 0] < low + 2), 1]
        table.append([low, *np.round(np.percentile(part, (50, 95)) if len(part) else (0, 0), 3).tolist(), len(part)])
    over = ended - told["end"]
    common.figure(f"{name}: from s of hand: lag of a sample p50, p95 (s), samples", table)
    stages = strokes.run().stages
    if seconds > 1:  # a short one on a busy computer is over before its first update was drawn
        assert any(line.startswith("Lag: ") for line in common.part("sculpt.panel").looks(stages))
    figures = [{k: round(v, 1) for k, v in stages.milliseconds().items()}, *np.round(stages.lag())]
    common.figure(f"{name}: ms of a look by stage; behind the hand by the counters, median and longest", figures)
    common.figure(f"{name}: looks; stroke over after the hand, s", [len(watch.shown), round(over, 2)])
    return lags, over, slow


def keeps_up(lags, over, seconds):
    """A picture on a busy computer may take a second; a growing queue takes more and more of them."""
    assert over < 20, f"the stroke went on for {over:.1f} s after the hand"
    halves = [lags[(lags[:, 0] > a * seconds) & (lags[:, 0] <= b * seconds), 1] for a, b in ((0.1, 0.55), (0.55, 1.1))]
    first, last = (np.median(part) for part in halves)
    assert last < 2 * first + 3, f"samples wait {first:.2f} s at first and {last:.2f} s in the end"


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with screen.override():
        bpy.ops.riffler.millimetres()
        bpy.ops.riffler.new_stock(
            "INVOKE_DEFAULT", True, source="BLOCK", origin="CORNER", size=(SIDE, SIDE, 10), pitch=0.25, directions="xyz"
        )
    yield 2.0
    strokes.tool(screen, "riffler.carve")
    strokes.settings().depth = 0.5
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    yield 1.0
    yield from timed_stroke(screen, "the first stroke, which makes the chunks", 1)
    chunks = [o for o in bpy.data.objects if o.name.startswith("Riffler Chunk")]
    common.figure("triangles", sum(len(o.data.polygons) for o in chunks))
    yield 1.0
    seconds = 10 if harness.job["measure"] else 5
    # Each display type and each number of copies once; measurements have all four.
    cases = [("TEXTURED", ""), ("BOUNDS", "X"), ("TEXTURED", "X"), ("BOUNDS", "")]
    for drawn, mirror in cases if harness.job["measure"] else cases[:2]:
        for ob in (o for o in bpy.data.objects if o.name.startswith("Riffler Chunk")):
            ob.display_type = drawn
        strokes.settings().mirror = set(mirror)
        yield 1.0
        name = "Mirror X" if mirror else "plain"
        lags, over, slow = yield from timed_stroke(screen, f"{name}, {drawn}", seconds)
        keeps_up(lags, over, seconds * slow)
        yield 2.0
