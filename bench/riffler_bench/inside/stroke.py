"""Strokes of the add-on's sculpt tool on a live sculpt, event by event: the stages of each, how much material went,
what undo takes. Straight grooves along x in the top of a block, seen from above."""

import itertools
import time

import bpy
import host
import numpy as np

DEPTH, RADIUS, HEIGHT, PITCH = 0.8, 3.0, 10.0, 0.25  # mm
WAY, RATE = 1.2, 60  # mm between two events, events a second: 72 mm/s
BETWEEN = 6.0  # mm from groove to groove, which do not meet
BALL = {"kind": "ball", "diameter": 2 * RADIUS, "length": 30.0}
STAGES = ("cut", "follow", "mesh", "transfer", "depsgraph", "draw", "event", "other")


def removed(length):
    """Closed form: half a ball's segment at either end of a groove, and the groove's section between them."""
    half = np.arccos((RADIUS - DEPTH) / RADIUS)
    cap = np.pi * DEPTH**2 * (3 * RADIUS - DEPTH) / 3
    return length * RADIUS**2 * (half - np.sin(half) * np.cos(half)) + cap


def lines(side, strokes, events):
    """(strokes, events, 2) places of a hand, mm from the middle."""
    x = WAY * (np.arange(events) - (events - 1) / 2)
    assert x[-1] + RADIUS < side / 2
    return np.array([[(a, BETWEEN * (k - (strokes - 1) / 2)) for a in x] for k in range(strokes)])


def sculpt(side, detail="NEEDED"):
    """A square block, being worked at; its middle in the scene's. Seconds until it is shown. `detail`: its triangles,
    those that the shape needs or ALL."""
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)
    size = (side, side, HEIGHT)
    bpy.ops.riffler.new_stock(source="BLOCK", origin="CENTRE", size=size, pitch=PITCH, directions="xyz")
    ob = bpy.context.object
    ob.data.riffler.detail = detail
    settings = bpy.context.scene.riffler
    settings.tool.kind, settings.tool.diameter, settings.tool.length = "ball", 2 * RADIUS, BALL["length"]
    settings.sculpt.depth, settings.sculpt.pressure, settings.sculpt.axis = DEPTH, "NONE", "NORMAL"
    bpy.ops.ed.undo_push(message="Stock")
    begin = time.perf_counter()
    live = host.part("sculpt.live_registry").begin(bpy.context, ob)
    bpy.context.view_layer.update()
    return ob, live, time.perf_counter() - begin


class Looks:
    """Seconds of each event by stage, by the add-on's clocks (sculpt/pure/stages.py) and from around its brush."""

    def __init__(self, live):
        self.live, self.rows, self._added = live, [], 0.0
        self.wall, self.cpu, self.looked, self.handled = [], [], None, None
        self.pictures = []
        live.stages.take_counts()

    def watch(self, brush):
        """Times the calls of a Brush that the add-on has made."""
        add, look = brush.add, brush.look

        def timed(sample):
            begin = time.perf_counter()
            self.handled = self.handled or begin
            try:
                return add(sample)
            finally:
                self._added += time.perf_counter() - begin

        def told():
            look()
            self.looked = time.perf_counter()

        brush.add, brush.look = timed, told

    def note(self, begun, wall, cpu, depsgraph, draw=0.0, pictures=0):
        """`begun`: when the event was made; `draw`: s of the picture that it ended with, `pictures`: how many."""
        newest = self.live.stages.newest
        row = {name: newest[name] for name in ("cut", "mesh", "transfer")}
        row |= {"follow": max(self._added - row["cut"], 0.0), "depsgraph": depsgraph, "draw": draw}
        row["event"] = max(self.handled - begun, 0.0)
        row["other"] = max(wall - sum(row.values()), 0.0)
        self._added, self.looked, self.handled = 0.0, None, None
        self.pictures.append(pictures)
        self.rows.append(row)
        self.wall.append(wall)
        self.cpu.append(cpu)

    def figures(self):
        counts = self.live.stages.take_counts()
        out = {f"{name}_s": float(np.median([row[name] for row in self.rows])) for name in STAGES}
        counts["moved"] = counts.pop("triangles")
        out |= {name: value / len(self.rows) for name, value in counts.items()}
        p50, p95 = np.percentile(self.wall, (50, 95))
        return out | {
            "p50_s": p50,
            "p95_s": p95,
            "cpu_s": float(np.median(self.cpu)),
            "events": len(self.rows),
            "pictures": float(np.mean(self.pictures)),
        }


def shown(live):
    chunks = host.part("sculpt.chunks").collection_of(live.mark).objects
    return sum(len(ob.data.polygons) for ob in chunks)


LATER = 2  # strokes from which on undo takes what it always takes


def kinds(strokes):
    """What the undo of each stroke is called, last stroke first. That of the first brings the sculpt's own mesh back,
    and takes all chunks away; that of the second reads all chunks again in 3.4, as they were new in the step before."""
    return ["undo"] * (strokes - LATER) + ["undo_second", "undo_first"][-strokes:]


def history(times, strokes):
    """Undo and redo of the strokes; the volume must come and go with them. Then undo of a step that has nothing to do
    with the sculpt, in the same file: less Blender cannot take."""
    live = host.part("sculpt.live_registry")
    name = bpy.context.object.name

    def volume():
        return live.content(bpy.data.objects[name]).volume.volume

    whole = [volume()]
    for kind in kinds(strokes):
        times.of(kind, bpy.ops.ed.undo)
        whole.append(volume())
    assert all(b > a for a, b in itertools.pairwise(whole)), whole
    for kind in reversed(kinds(strokes)):
        times.of(kind.replace("undo", "redo"), bpy.ops.ed.redo)
    assert volume() == whole[0]
    bpy.context.collection.objects.link(bpy.data.objects.new("Empty", None))
    bpy.ops.ed.undo_push(message="Empty")
    for _ in range(3):
        bpy.data.objects["Empty"].location.x = 1
        bpy.ops.ed.undo_push(message="Move")
        times.of("undo_other", bpy.ops.ed.undo)
        assert bpy.data.objects["Empty"].location.x == 0


def undone(times):
    """Medians of all that is undone or done again."""
    names = [name for name in times.wall if name.startswith(("undo", "redo"))]
    out = {f"{name}_s": times.medians(name)["wall_s"] for name in names}
    return out | {f"{name}_cpu_s": times.medians(name)["cpu_s"] for name in names}


def summed(looks, times, live, whole, expected, began, side):
    gone = whole - live.volume.volume
    out = looks.figures() | {"begin_s": began, "side": side, "triangles": live.mesher.all_triangles}
    out["shown"] = shown(live)
    out |= {"removed_mm3": gone, "expected_mm3": expected, "removed_over": gone / expected - 1}
    for name in times.wall:
        out |= {f"{name}_s": times.medians(name)["wall_s"], f"{name}_cpu_s": times.medians(name)["cpu_s"]}
    return out


def headless(side, strokes, events, detail="NEEDED"):
    """Without drawing: samples to the brush, a look, and Blender's dependency graph."""
    _, live, began = sculpt(side, detail)
    core, sight = (
        host.part("sculpt.pure.brush_stroke"),
        host.part("sculpt.pure.view_rays").ViewRays(np.diag([0.02, 0.02, -0.001, 1.0]), (4000, 4000)),
    )
    choice = core.Choice(depth=DEPTH)
    looks, times, whole, hand = Looks(live), host.Times(), live.volume.volume, lines(side, strokes, events)
    sample = host.part("sculpt.pure.stroke_path").Sample
    for line in hand:
        made = core.BrushStroke(live, BALL, sight, choice)
        looks.watch(made)
        for k, (x, y) in enumerate(line):
            begin, cpu = time.perf_counter(), time.process_time()
            made.add(sample(2000 + 40 * x, 2000 + 40 * y, time=k / RATE))
            made.look()
            graph = time.perf_counter()
            bpy.context.view_layer.update()
            now = time.perf_counter()
            looks.note(begin, now - begin, time.process_time() - cpu, now - graph)
        made.end()
        times.of("end", lambda: live.finish_stroke(bpy.context, "Stroke"))
    expected = strokes * removed(WAY * (events - 1))
    out = summed(looks, times, live, whole, expected, began, side)
    history(times, strokes)
    return out | undone(times)


def windowed(side, strokes, events, detail="NEEDED"):
    """Strokes by simulated mouse events: measures from each event to the picture that shows its cut."""
    from view import View

    ob, live, began = sculpt(side, detail)
    view = View(side)
    view.area.spaces.active.overlay.show_outline_selected = False
    with view.override():
        bpy.ops.wm.tool_set_by_id(name="riffler.carve")
    yield 3.0
    pointer = host.part("sculpt.pointer")
    looks, times, whole, expected = Looks(live), host.Times(), live.volume.volume, 0.0
    for line in lines(side, strokes, events):
        way = [view.pixel((x, y, HEIGHT / 2)) for x, y in line]
        view.send("MOUSEMOVE", "NOTHING", way[0])
        yield 0.5
        view.send("LEFTMOUSE", "PRESS", way[0])
        yield lambda: pointer.held is not None
        yield 0.5
        looks.watch(pointer.held)
        # The tool follows a curve through the samples, one behind the pointer.
        view.send("MOUSEMOVE", "NOTHING", way[1])
        yield 0.5
        for pixel in way[2:]:
            view.send("MOUSEMOVE", "NOTHING", pixel)
            # Drawn after the look: a picture before it has the tool's old place.
            yield lambda: looks.looked and view.drawn and view.drawn[0] > looks.looked
            looks.note(view.sent[0], *view.latency(), sum(view.graph), view.drawing[-1], len(view.drawing))
        view.send("LEFTMOUSE", "RELEASE", way[-1])
        yield lambda: pointer.held is None
        yield 1.0
        a, b = (np.array(view.place(p)) for p in (way[0], way[-1]))
        expected += removed(np.linalg.norm(b - a))
    live = host.part("sculpt.live_registry").of(bpy.data.objects[ob.name])
    out = summed(looks, times, live, whole, expected, began, side)
    yield from view.history(times, kinds(strokes))
    return out | undone(times) | {"renderer": view.renderer(), "pixels": [view.region.width, view.region.height]}
