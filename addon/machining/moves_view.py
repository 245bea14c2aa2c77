"""Draws the moves of the job's operations in the 3D view, coloured by kind, and wider for the selected operation."""

import bpy

from ..blender import batches, scene_units, views
from ..sculpt import sculpts
from . import inputs, job_store
from .pure import operation_lines

CLASSES = ()
COLOURS = {
    "rapid": (0.9, 0.25, 0.2, 1.0),
    "lead": (0.95, 0.75, 0.2, 1.0),
    "cut": (0.2, 0.85, 0.45, 1.0),
    "link": (0.3, 0.6, 0.95, 1.0),
}
FAINT = 0.35  # opacity of the operations that are not selected
WIDTH, WIDE = 1.0, 2.0  # pixels

kept = batches.Batches()
_in_views = views.InViews()


def _draw():
    context = bpy.context
    scene = context.scene
    settings = scene.riffler.machining
    if not settings.draw_moves or not settings.rows:
        return
    try:
        draw(context, scene, settings)
    except ValueError:  # the panel reports the error
        return


def draw(context, scene, settings):
    ob = inputs.stock_of(scene)
    if ob is None or not job_store.identity(scene):
        return
    known = job_store.operations(scene)
    to_view = sculpts.to_world_mm(ob, scene)
    to_view[:3] /= scene_units.mm_per_unit(scene)
    size = (context.region.width, context.region.height)
    zoom = context.preferences.system.ui_scale
    with batches.state(depth="LESS_EQUAL", write=False):
        for k, row in enumerate(settings.rows):
            if not row.on or row.key not in known:
                continue
            chosen = k == settings.row
            for name, batch in _batches(row.key, known[row.key], to_view).items():
                colour = COLOURS[name] if chosen else (*COLOURS[name][:3], FAINT)
                batches.draw_lines(batch, colour, zoom * (WIDE if chosen else WIDTH), size)


def _batches(key, op, to_view):
    """{kind: batch} of an operation's moves."""
    signature = key, to_view.tobytes()
    made = {}

    def lines(name):
        if not made:
            made.update(operation_lines.pieces(op, to_view))
        return "POLYLINE_UNIFORM_COLOR", "LINES", {"pos": made[name]}

    return {name: kept.get(f"{key} {name}", signature, lambda n=name: lines(n)) for name in COLOURS}


def attach():
    _in_views.add(_draw, "POST_VIEW")


def detach():
    _in_views.clear()
    kept.clear()
