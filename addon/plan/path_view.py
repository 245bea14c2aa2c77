"""The active plan in the 3D view while the plan tool is active: the contacts of its paths on the part, the normals
there and the tool's axes; and the contact under the pointer, or at the tool of a device that sculpts."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..blender import batches, scene_units, views
from ..common import glyphs
from ..pen import session as pen_session
from . import current_pose, occlusion, plan_store

CLASSES = ()
NEAR = 24.0  # pixels from the pointer to a contact under it
ASKED, APART = 48, 4.0  # contacts tested for being hidden, and pixels between tested ones of one path
OFF = 0.02  # share of the ball's radius: distance of lines from the surface, to be visible
NORMAL, AXIS = 0.5, 4.0  # shares of the ball's radius: lengths of normals and axes
COLOURS = {
    "CONTACTS": (0.15, 0.75, 0.95, 1.0),
    "NORMALS": (0.55, 0.85, 0.4, 0.8),
    "AXES": (0.95, 0.75, 0.3, 0.35),
    "KEYS": (1.0, 0.6, 0.15, 1.0),
}
MARK, SHADOW = (1.0, 0.9, 0.3, 1.0), (0.0, 0.0, 0.0, 0.55)
TEXT = (0.95, 0.95, 0.95, 1.0)

kept = batches.Batches()
_in_views = views.InViews()


# ------------------------------------------------------------------ lines, as ends of pieces (n, 3) in mm
def contacts(path):
    out = []
    for side in (0, 1):
        line = path.contacts[:, side] + OFF * path.radius * path.normals[:, side]
        if path.closed:
            line = np.vstack([line, line[:1]])
        out.append(np.stack([line[:-1], line[1:]], axis=1).reshape(-1, 3))
    return np.concatenate(out)


def normals(path):
    begin = path.contacts.reshape(-1, 3)
    return np.stack([begin, begin + NORMAL * path.radius * path.normals.reshape(-1, 3)], axis=1).reshape(-1, 3)


def axes(path, rows=None):
    """At the points `rows`, by default all; empty if the path has no orientations."""
    if not len(path.axes):
        return np.empty((0, 3))
    rows = np.arange(len(path)) if rows is None else np.asarray(rows, int)
    begin = path.centres[rows]
    return np.stack([begin, begin + AXIS * path.radius * path.axes[rows]], axis=1).reshape(-1, 3)


LINES = {"CONTACTS": contacts, "NORMALS": normals, "AXES": axes, "KEYS": lambda path: axes(path, list(path.keys))}


def drawn(what, plan, mm_per_unit):
    lines = [LINES[what](path) for path in plan.paths]
    pos = np.concatenate(lines) / mm_per_unit if lines else np.empty((0, 3))
    return "UNIFORM_COLOR", "LINES", {"pos": pos}


def _draw():
    context = bpy.context
    if not current_pose.tool_active(context):
        return
    ob = current_pose.plan_object(context)
    wanted = context.scene.riffler.plan.show
    if ob is None or not wanted:
        return
    try:
        plan = plan_store.plan(ob)
    except ValueError:  # the panel shows the error
        return
    mm = scene_units.mm_per_unit(context.scene)
    signature = plan_store.identity(ob), mm
    with batches.state(depth="LESS_EQUAL"):
        for what in LINES:
            if what in wanted or (what == "KEYS" and "AXES" in wanted):
                make = lambda w=what: drawn(w, plan, mm)  # noqa: E731
                batches.draw(kept.get(what, signature, make), COLOURS[what])


# ------------------------------------------------------------------ the pointer
@dataclass(frozen=True)
class Found:
    """A contact: numbers of path and point, which of the two sides, its place, and the part's normal there."""

    path: int
    index: int
    point: np.ndarray
    normal: np.ndarray


def nearest(plan, view, at, reach=NEAR, hidden=None):
    """The visible contact nearest to a pixel, or None if none is within `reach` of it. `hidden`: a function of a place
    (3,), True if something hides it. It is called for few contacts only."""
    origin, away = view.ray(*at)
    firsts = []
    for k, path in enumerate(plan.paths):
        found = path.nearest(origin, direction=away)
        gap = float(np.hypot(*(view.project([found.point])[0] - at)))
        if gap <= reach:  # false for NaN, behind the viewer
            firsts.append((gap, k, found.index, found.side))
    firsts.sort()
    best, closest, left = None, reach, ASKED
    for gap, k, index, side in firsts:
        if gap > closest or not left:
            break
        left -= 1
        path = plan.paths[k]
        if hidden is None or not hidden(_over(path, index, side)):
            return _found(k, path, index, side)
        for other, index, side in _spread(path, view, at, closest)[:left]:
            left -= 1
            if not hidden(_over(path, index, side)):
                best, closest = _found(k, path, index, side), other
                break
    return best


def _found(k, path, index, side):
    return Found(k, index, path.contacts[index, side], path.normals[index, side])


def _over(path, index, side):
    """The place where a contact is drawn."""
    return path.contacts[index, side] + OFF * path.radius * path.normals[index, side]


def _spread(path, view, at, reach):
    """(gap, index, side) of a path's contacts within so many pixels, nearest first: one for each few pixels along
    either line, since neighbours of a hidden contact are mostly hidden, too."""
    gaps = np.hypot(*(view.project(path.contacts.reshape(-1, 3)) - at).T)
    rows = np.flatnonzero(gaps <= reach)
    rows = rows[np.argsort(gaps[rows], kind="stable")]
    first, found = {}, {}
    for row in rows.tolist():
        index, side = divmod(row, 2)
        behind = index < first.setdefault(side, index)
        found.setdefault((side, behind, gaps[row] // APART), (float(gaps[row]), index, side))
    return list(found.values())


def under(context, at):
    """The contact of the active plan under the pointer, at pixels of the context's region."""
    ob = current_pose.plan_object(context)
    if ob is None or context.region_data is None:
        return None
    view = current_pose.sight(context, context.region, context.region_data)
    reach = NEAR * context.preferences.system.ui_scale
    return nearest(plan_store.plan(ob), view, at, reach, occlusion.hider(context, view))


def beside(plan, place, reach):
    """The contact nearest to a place (3,) in mm, or None if none is within `reach` mm of it."""
    best, closest = None, reach
    for k, path in enumerate(plan.paths):
        gaps = np.linalg.norm(path.contacts - place, axis=2)
        index, side = np.unravel_index(np.argmin(gaps), gaps.shape)
        if gaps[index, side] <= closest:
            best = _found(k, path, int(index), side)
            closest = float(gaps[index, side])
    return best


def at_tool(context):
    """The contact of the active plan at a device's tool, within its diameter; None without a device session."""
    session, ob = pen_session.running, current_pose.plan_object(context)
    if session is None or session.run.pose is None or ob is None:
        return None
    if session.contact is not None:
        k, index = session.contact
        path = plan_store.plan(ob).paths[k]
        gaps = np.linalg.norm(path.contacts[index] - session.run.pose[:3], axis=1)
        return _found(k, path, index, int(np.argmin(gaps)))
    tip = (session.live.to_world @ np.append(session.run.pose[:3], 1.0))[:3] * scene_units.mm_per_unit(context.scene)
    return beside(plan_store.plan(ob), tip, session.diameter)


def _draw_at_tool():
    context = bpy.context
    if pen_session.running is None or context.region_data is None:
        return
    try:
        found = at_tool(context)
    except ValueError:
        return
    if found is not None:
        view = current_pose.sight(context, context.region, context.region_data)
        _mark(found, view, (0, 0), view.project([found.point])[0], context.preferences.system.ui_scale)


def draw_cursor(context, tool, xy):
    """Blender draws cursors over the finished view: following the pointer does not redraw the part."""
    region, space = context.region, context.region_data
    if region is None or space is None or current_pose.held is not None:
        return
    at = np.array([xy[0] - region.x, xy[1] - region.y], float)
    try:
        found = under(context, at)
    except ValueError:
        return
    if found is not None:
        view = current_pose.sight(context, region, space)
        _mark(found, view, (region.x, region.y), at, context.preferences.system.ui_scale)


def _mark(found, view, corner, at, zoom):
    """A ring and a pin at a contact, and its name next to `at`; pixels of the region, whose `corner` is given."""
    import gpu

    radius = 9 * zoom / view.pixels_per_unit(found.point)
    ring = view.project(glyphs.ring(found.point, found.normal, radius, 32))
    pin = view.project([found.point, found.point + 2.5 * radius * found.normal])
    with batches.state(), gpu.matrix.push_pop():
        gpu.matrix.translate(corner)
        for k, (line, closed) in enumerate(((ring, True), (pin, False))):
            for name, width, colour in (("shadow", 3.4 * zoom, SHADOW), ("line", 1.8 * zoom, MARK)):
                make = lambda p=line, w=width, c=closed: batches.flat(glyphs.ribbon(p, w, c))  # noqa: E731
                batches.draw(kept.get(f"{name} {k}", (line.tobytes(), zoom), make), colour)
    place = np.add(corner, at) + np.array([14, 12]) * zoom
    _label(f"Path {found.path + 1}, point {found.index}", place, zoom)


def _label(text, place, zoom):
    import blf

    blf.size(0, 11 * zoom)
    blf.color(0, *TEXT)
    blf.position(0, *place, 0)
    blf.draw(0, text)


def attach():
    _in_views.add(_draw, "POST_VIEW")
    _in_views.add(_draw_at_tool)


def detach():
    _in_views.clear()
    kept.clear()
