"""The map of free orientations in the corner of the 3D view while the plan tool is active, and the tool's clearance."""

import bpy
import numpy as np

from ..blender import batches, views
from ..common import glyphs
from . import current_pose, orientation_probe
from .pure import orientation_map, tool_rotation

CLASSES = ()
CELL = 8.0  # pixels at a scale of 1
LINE = 22.0  # pixels from one line of text to the next
MARGIN = (24.0, 34.0)  # from the lower right corner, next to the sidebar
DARK, EDGE = (0.05, 0.05, 0.05, 0.65), (0.75, 0.75, 0.75, 0.9)
TEXT, ALARM = (0.92, 0.92, 0.92, 1.0), (1.0, 0.5, 0.4, 1.0)
NOW, BEST = (1.0, 1.0, 1.0, 1.0), (0.55, 0.95, 0.65, 0.9)

kept = batches.Batches()
_in_views = views.InViews()


def grid_of(found, zoom):
    """plan.pure.orientation_map.Grid of a riffler FreeOrientations."""
    return orientation_map.Grid(tuple(found.inclinations), tuple(found.tilts), CELL * zoom)


def corner(context, grid):
    """Pixels of the map's lower left corner in the region."""
    zoom = context.preferences.system.ui_scale
    sidebar = next((r.width for r in context.area.regions if r.type == "UI"), 0)
    return context.region.width - sidebar - zoom * MARGIN[0] - grid.size[0], zoom * MARGIN[1]


def angles_at(context, at):
    """(inclination, tilt) of the cell at pixels of the region, or None outside the map."""
    spot = current_pose.seen(context) if current_pose.tool_active(context) else None
    if spot is None or context.area is None:
        return None
    known = orientation_probe.ask(context, spot)
    if known.map is None:
        return None
    grid = grid_of(known.map, context.preferences.system.ui_scale)
    x, y = corner(context, grid)
    return grid.angles_at(at[0] - x, at[1] - y)


def _draw():
    context = bpy.context
    if context.region is None or not current_pose.tool_active(context):
        return
    spot = current_pose.seen(context)
    if spot is None:
        return
    known = orientation_probe.ask(context, spot)
    zoom = context.preferences.system.ui_scale
    if known.map is None:
        if known.text:
            x = context.region.width / 2
            _write([(known.text, x, zoom * MARGIN[1], ALARM, True)], zoom)
        return
    grid = grid_of(known.map, zoom)
    place = corner(context, grid)
    angles = spot.line.lean(spot.index, current_pose.held if current_pose.held is not None else spot.axis)
    state, free = known.text, known.free
    if current_pose.held is not None:  # while a handle turns the tool, the header shows its clearance
        state, free = current_pose.said or ("", True)
    _back(grid, place, zoom, 2 if state else 1)
    _map(known, grid, place, spot, angles, zoom)
    _labels((state, free), grid, place, angles, zoom)


def _back(grid, place, zoom, lines):
    """A background that makes the map and the lines of text above it readable."""
    import gpu

    width, height = grid.size
    box = glyphs.box(-10 * zoom, -26 * zoom, width + 20 * zoom, height + (30 + LINE * lines) * zoom)
    with batches.state(), gpu.matrix.push_pop():
        gpu.matrix.translate(place)
        batches.draw(kept.get("back", (grid, lines), lambda: batches.flat(box)), DARK)


def _map(known, grid, place, spot, angles, zoom):
    import gpu

    width, height = grid.size
    found = known.map
    with batches.state(), gpu.matrix.push_pop():
        gpu.matrix.translate(place)
        batches.draw(kept.get("map", (id(found), known.old, grid), lambda: coloured(found, grid, known.old)))
        middle = grid.place(0.0, 0.0)
        lines = np.concatenate(
            [
                glyphs.ribbon([(middle[0], 0), (middle[0], height)], 0.6 * zoom),
                glyphs.ribbon([(0, middle[1]), (width, middle[1])], 0.6 * zoom),
            ]
        )
        batches.draw(kept.get("middle", grid, lambda: batches.flat(lines)), (0, 0, 0, 0.35))
        if found.suggestion is not None and not known.old:
            best = grid.place(*spot.line.lean(found.index, found.suggestion))
            _ring("best", best, 0.45 * grid.cell, 1.2 * zoom, BEST)
        _ring("shadow", grid.place(*angles), 0.75 * grid.cell, 3.6 * zoom, (0, 0, 0, 0.6))
        _ring("now", grid.place(*angles), 0.75 * grid.cell, 1.8 * zoom, NOW)


def coloured(found, grid, old):
    """Two triangles per cell, in the cell's colour."""
    colours = orientation_map.colours(found.state, found.clearance, old).reshape(-1, 4)
    return (
        "SMOOTH_COLOR",
        "TRIS",
        {"pos": grid.triangles().reshape(-1, 2), "color": np.repeat(colours, 6, axis=0)},
    )


def _ring(name, centre, radius, width, colour):
    angle = 2 * np.pi * np.arange(24) / 24
    points = np.asarray(centre) + radius * np.c_[np.cos(angle), np.sin(angle)]
    make = lambda: batches.flat(glyphs.ribbon(points, width, True))  # noqa: E731
    batches.draw(kept.get(name, (points.tobytes(), width), make), colour)


def _labels(found, grid, place, angles, zoom):
    (state, free), (x, y), (width, height) = found, place, grid.size
    middle = x + width / 2
    said = [
        (tool_rotation.said(*angles), middle, y + height + 8 * zoom, TEXT, True),
        ("tilt →    inclination ↑", middle, y - 15 * zoom, EDGE, True),
    ]
    if state:
        said.append((state, middle, y + height + (8 + LINE) * zoom, TEXT if free else ALARM, True))
    _write(said, zoom)


def _write(said, zoom):
    """[(text, x, y, colour, whether x is its middle)]"""
    import blf

    blf.size(0, 11 * zoom)
    for text, x, y, colour, centred in said:
        blf.color(0, *colour)
        blf.position(0, x - (blf.dimensions(0, text)[0] / 2 if centred else 0), y, 0)
        blf.draw(0, text)


def attach():
    _in_views.add(_draw)


def detach():
    _in_views.clear()
    kept.clear()
