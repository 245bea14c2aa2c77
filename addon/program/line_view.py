"""The active plan's paths as thick lines, coloured by the tool's movement, with a legend; and the moves between cuts,
once the plan has a program."""

import bpy
import numpy as np

from ..blender import bars, batches, scene_units, views
from ..common import glyphs, units
from ..plan import collision_marks, path_rows, plan_states, plan_store, replan, timeline
from ..plan.pure import path_lines
from ..sculpt import force_view
from ..translations import local
from . import programs
from .pure import program_timeline

CLASSES = ()
# Label, colour and width in pixels of each kind; the order is that of plan/pure/path_lines.py.
LOOK = {
    "collides": ("Collides", (1.0, 0.25, 0.2, 1.0), 4.0),
    "blocked": ("Blocked", (1.0, 0.25, 0.2, 1.0), 4.0),
    "lifted": ("Lifted", (1.0, 0.75, 0.1, 1.0), 4.0),
    "cut": ("Cut", (0.25, 0.9, 0.4, 1.0), 4.0),
    "lead": ("Lead-In", (0.3, 0.85, 1.0, 1.0), 2.5),
    "retract": ("Retract", (0.75, 0.5, 1.0, 1.0), 2.5),
    "rapid": ("Rapid", (1.0, 0.45, 0.85, 1.0), 2.5),
    "keyed": ("To Resolve", (0.35, 0.6, 1.0, 1.0), 4.0),
    "unplanned": ("No Keys", (0.85, 0.85, 0.85, 1.0), 3.0),
    "off": ("Off", (0.5, 0.5, 0.5, 0.5), 1.5),
}
HIDDEN = 0.25  # share of the opacity of lines behind something
ROW = 17.0  # pixels of the legend, at a scale of 1
CORNER = (20.0, 60.0)  # of its foot, from the toolbar and from the bottom: the last operator's panel is below

kept = batches.Batches()
_drawn = [None, ()]  # the signature of the content of `kept`, and its kinds
_in_views = views.InViews()
# Cached lines of single paths: (id of the path, of its rows, state, colliding points) → path, rows, {kind: segments}.
_paths = {}


def lines(context, ob):
    """{kind: segments (n, 2, 3) in mm} of a plan and of its last program. ValueError if the plan cannot be read."""
    plan, found = plan_store.plan(ob), {}
    cl = list(plan.cl) or [None] * len(plan.paths)
    states = [row.state for row in ob.riffler.plan.rows] or ["unplanned"] * len(plan.paths)
    for k, (path, rows, state) in enumerate(zip(plan.paths, cl, states, strict=True)):
        for kind, some in _of_path(path, rows, state, _hits(ob, plan, k)).items():
            found.setdefault(kind, []).append(some)
    out = {kind: np.concatenate(some) for kind, some in found.items()}
    return out | _links(context, ob, plan)


def _hits(ob, plan, number):
    """Bytes: for each point of a path, and of a loop for the first once more, whether the marks of collisions have
    it."""
    if timeline.pair(ob) is None or not collision_marks.asked(ob) or not replan.fits(ob, plan):
        return b""
    track = replan.layout_of(ob, plan).tracks[number]
    return path_lines.hits(track.frames, plan_states.state(ob).colliding).tobytes()


def _of_path(path, rows, state, hits):
    key = id(path), id(rows), state, hits
    if key not in _paths:
        # holds the objects, so that their ids stay unique
        _paths[key] = path, rows, path_lines.of_path(path, rows, state, np.frombuffer(hits, bool))
    return _paths[key][2]


def _links(context, ob, plan):
    program = programs.made_of(context, ob)
    if program is None:
        return {}
    chosen = [np.asarray(plan.cl[k]) for k in plan_store.wanted(plan)]
    begins = program_timeline.begins(program.poses, chosen)
    radius = plan.paths[plan_store.wanted(plan)[0]].radius
    return path_lines.of_links(program.poses, begins, [len(rows) for rows in chosen], radius)


def signature(context, ob):
    """A value that changes with the lines."""
    program = programs.made_of(context, ob)
    states = "".join(row.state[0] for row in ob.riffler.plan.rows)
    colliding = tuple(plan_states.state(ob).colliding) if collision_marks.asked(ob) else ()
    return plan_store.identity(ob), states, id(program), colliding, scene_units.mm_per_unit(context.scene)


def shown(context):
    """The plan whose lines are drawn in the view, or None."""
    if not (context.scene.riffler.plan.draw_paths and context.space_data.overlay.show_overlays):
        return None
    return plan_store.active(context)


def _made(context, ob):
    """{kind: the batch} of the lines to draw."""
    now = signature(context, ob)
    if _drawn[0] != now:
        kept.clear()
        _forget(plan_store.plan(ob))
        found = lines(context, ob)
        _drawn[:] = now, [k for k in path_lines.KINDS if k in found and len(found[k])]
        mm = scene_units.mm_per_unit(context.scene)
        for kind in _drawn[1]:
            pos = found[kind].reshape(-1, 3) / mm
            kept.get(kind, now, lambda p=pos: ("POLYLINE_UNIFORM_COLOR", "LINES", {"pos": p}))
    return {kind: kept.get(kind, now, None) for kind in _drawn[1]}


def _forget(plan):
    ids = {id(path) for path in plan.paths}
    for key in [key for key in _paths if key[0] not in ids]:
        del _paths[key]


def _draw():
    context = bpy.context
    ob = shown(context)
    if ob is None:
        return
    try:
        made = _made(context, ob)
    except ValueError:  # the panel shows the error
        return
    zoom = context.preferences.system.ui_scale
    size = context.region.width, context.region.height
    for depth, share in (("GREATER", HIDDEN), ("LESS_EQUAL", 1.0)):
        with batches.state(depth=depth, write=False), batches.nearer():
            for kind in reversed(list(made)):
                _, colour, width = LOOK[kind]
                batches.draw_lines(made[kind], (*colour[:3], share * colour[3]), width * zoom, size)


def entries(ob, present):
    """The legend's rows: (colour, text)."""
    number = path_rows.counts(ob.riffler.plan)
    number["cut"] = number.pop("free", 0)
    return [
        (
            LOOK[kind][1],
            " ".join([local(LOOK[kind][0]), *([units.format_count(number[kind])] if number.get(kind) else [])]),
        )
        for kind in present
    ]


def _draw_legend():
    context = bpy.context
    ob = shown(context)
    if ob is None or not _drawn[1]:
        return
    zoom = context.preferences.system.ui_scale
    tools = next((r.width for r in context.area.regions if r.type == "TOOLS" and r.width > 1), 0)
    x, y = tools + CORNER[0] * zoom, max(CORNER[1], force_view.foot()) * zoom
    listed = entries(ob, _drawn[1])
    import blf

    blf.size(bars.FONT, bars.SIZE * zoom)
    widest = max(blf.dimensions(bars.FONT, text)[0] for _, text in listed)
    box = glyphs.box(x - 8 * zoom, y - 8 * zoom, widest + 44 * zoom, (ROW * len(listed) + 10) * zoom)
    with batches.state():
        make = lambda s=box: batches.flat(s)  # noqa: E731
        batches.draw(kept.get("legend", box.tobytes(), make), bars.DARK)
        for k, (colour, _) in enumerate(reversed(listed)):
            swatch = glyphs.box(x, y + (ROW * k + 4) * zoom, 20 * zoom, 4 * zoom)
            make = lambda s=swatch: batches.flat(s)  # noqa: E731
            batches.draw(kept.get(f"swatch {k}", swatch.tobytes(), make), colour)
    blf.color(bars.FONT, *bars.TEXT)
    for k, (_, text) in enumerate(reversed(listed)):
        blf.position(bars.FONT, x + 28 * zoom, y + (ROW * k + 2) * zoom, 0)
        blf.draw(bars.FONT, text)


def attach():
    _in_views.add(_draw, "POST_VIEW")
    _in_views.add(_draw_legend)


def detach():
    _in_views.clear()
    kept.clear()
    _drawn[:] = None, ()
    _paths.clear()
