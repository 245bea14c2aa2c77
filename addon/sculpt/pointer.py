"""The sculpt tool's cursor: the cutter's outline where a click would place it, its axis, and its point on the surface.

Blender draws cursors over the finished view, so following the pointer does not redraw the sculpt.
"""

import numpy as np
import riffler

from ..blender import batches, meshes, object_surfaces, scene_units
from ..common import fitting, glyphs, poses
from . import live_registry, sculpts
from .pure import brush_stroke, symmetry
from .pure.view_rays import ViewRays

# colours of planes perpendicular to x, y and z, as for Blender's axes
AXES = ((1.0, 0.25, 0.3), (0.45, 0.8, 0.1), (0.25, 0.55, 1.0))
SHADOW = (0.0, 0.0, 0.0, 0.55)
PROFILE, HEIGHT = 25, 0.5  # points on each side of a falloff's profile; its height in radii
SHOWN = 1.5  # length of the tool drawn above its tip, in diameters: more would cover the view

kept = batches.Batches()
pixels_per_mm = 10.0  # at the pointer's last place: for Blender's radial control, which has no place
sizing = None  # sculpt/pure/sizing.Drag, while the pointer's distance sets a size
held = None  # the BrushStroke in progress, and its tool


def sight(region, space, run):
    """A region's view of a live sculpt, in the sculpt's millimetres."""
    return ViewRays(meshes.matrix(space.perspective_matrix) @ run.to_world, (region.width, region.height))


def draw(context, brush, xy):
    """Draws the cursor. `xy`: the pointer's pixel in the window."""
    region, space = context.region, context.region_data
    ob = sculpts.active(context)
    if region is None or space is None or context.window_manager.riffler.sculpting:
        return  # while a device sculpts, its tool is the cursor
    at = xy[0] - region.x, xy[1] - region.y
    zoom, corner = context.preferences.system.ui_scale, (region.x, region.y)
    if sizing is not None:
        rings = [(sizing.middle, sizing.first * sizing.scale, False), (sizing.middle, sizing.radius, True)]
        _draw([(_ring(*ring), True, strong) for *ring, strong in rings], corner, brush.colour, zoom)
        return
    if ob is None:
        _draw(_before(context, region, space, at), corner, brush.colour, zoom)
        return
    if held is None:
        _planes(context, ob, region, space, corner, zoom)
    own = context.scene.riffler
    tool = (own.hand_tool if brush.hand else own.tool).dictionary()
    run = live_registry.of(ob)
    lines = None
    if run is not None and run.object is not None:
        lines = _on_surface(context, brush, run, tool, at)
    if lines is None:
        lines = _beside(context, brush, ob, region, space, at)
    _draw(lines, corner, brush.colour, zoom)


def _on_surface(context, brush, run, tool, at):
    """The cursor on the surface. None if no surface is under the pointer or if a stroke there would be refused."""
    global pixels_per_mm
    settings = context.scene.riffler.sculpt
    try:
        view = sight(context.region, context.region_data, run)
        if held is not None and held.pose is not None:
            cutter, pose, place, normal = held.tool, held.pose, None, None
        else:
            probe = brush_stroke.BrushStroke(run, tool, view, settings.choice(brush.id), surface=run.mesher)
            found = probe.hover(*at)
            if found is None:
                return None
            cutter, (pose, place, normal) = probe.tool, found
    except ValueError:
        return None
    pixels_per_mm = view.pixels_per_unit(pose[:3])
    if brush.falloff:
        return falloff_lines(0.5 * cutter.diameter, settings.falloff.lower(), pose, view)
    if brush.hand:
        return hand_tool_lines(cutter, pose, place, normal, view)
    return tool_lines(cutter, pose, place, normal, view)


def tool_lines(cutter, pose, place, normal, view):
    """[(points (n, 2) in pixels, closed, whether it is the outline)] of a tool at its pose."""
    outline = cutter.outline(tolerance=0.002 * cutter.diameter)
    axis, back = pose[3:], view.basis().back
    across = np.cross(axis, back)
    size = float(np.linalg.norm(across))
    shown = glyphs.meridian(outline, SHOWN * cutter.diameter)
    out = []
    if size > 0.05:  # a tool seen along its axis shows only its ring
        out.append((pose[:3] + shown[:, :1] * (across / size) + shown[:, 1:] * axis, True, True))
    line = np.vstack([points for part, points in outline if part == "cutter"])
    radius, height = line[np.argmax(line[:, 0])]
    out.append((glyphs.ring(pose[:3] + height * axis, axis, radius), True, True))
    out.append((np.array([pose[:3], pose[:3] + SHOWN * cutter.diameter * axis]), False, False))
    if place is not None:
        out.append((glyphs.ring(place, normal, 0.12 * cutter.diameter, 24), True, False))
    return [(view.project(points), closed, strong) for points, closed, strong in out]


def hand_tool_lines(tool, pose, place, normal, view):
    """The same for a hand tool: the outlines of its bodies and of their ground ends, which lie at the edge."""
    frame = np.array([pose[6:], np.cross(pose[3:6], pose[6:]), pose[3:6]])
    shown = SHOWN * tool.diameter
    out = []
    for hull in tool.hulls:
        whole = np.c_[hull[:, :2], np.minimum(hull[:, 2], np.maximum(shown, hull[:, 2].min()))]
        end = hull[hull[:, 2] < hull[:, 2].max() * (1 - 1e-9)]
        for points, strong in ((whole, True), (end, False)):
            pixels = view.project(pose[:3] + points @ frame)
            if np.isfinite(pixels).all():
                out.append((glyphs.outline(pixels), True, strong))
    if place is not None:
        out.append((view.project(glyphs.ring(place, normal, 0.12 * tool.diameter, 24)), True, False))
    return out


def falloff_lines(radius, falloff, pose, view):
    """The same for a brush with falloff: a ring of its radius on the surface, a ring where it has half its effect, and
    the falloff's profile above them, half a radius high."""
    centre, normal = pose[:3], pose[3:]
    out = [(glyphs.ring(centre, normal, radius), True, True)]
    t = np.linspace(0, 1, PROFILE)
    f = np.array([riffler.falloff(falloff, x) for x in t])
    half = float(t[np.argmin(np.abs(f - 0.5))])
    if 0.05 < half < 0.95:
        out.append((glyphs.ring(centre, normal, half * radius), True, False))
    across = np.cross(normal, view.basis().back)
    size = float(np.linalg.norm(across))
    if size > 0.05:  # seen along the normal, the profile is a line
        place, height = np.concatenate([-t[::-1], t[1:]]), np.concatenate([f[::-1], f[1:]])
        line = centre + radius * (place[:, None] * (across / size) + HEIGHT * height[:, None] * normal)
        out.append((line, False, False))
    return [(view.project(points), closed, strong) for points, closed, strong in out]


def _planes(context, ob, region, space, corner, zoom):
    """Draws the outlines of the symmetry planes within the stock's box, and the axis of radial copies."""
    settings, p = context.scene.riffler.sculpt, ob.data.riffler
    if not settings.mirror and settings.radial < 2:
        return
    world = meshes.matrix(ob.matrix_world)
    world[:3, :3] /= sculpts.shown_mm_per_unit(ob.data)
    seen = ViewRays(meshes.matrix(space.perspective_matrix), (region.width, region.height))
    middle = 0.5 * np.add(p.lower, p.upper) - np.array(p.off_middle)
    for line, axis, closed in symmetry.outlines(settings.mirror, settings.radial, settings.radial_axis, p, middle):
        pixels = seen.project(poses.transform_points(world, line))
        if np.isfinite(pixels).all():
            _draw([(pixels, closed, False)], corner, AXES["XYZ".index(axis)], zoom, f"plane {axis} {closed}")


def _before(context, region, space, at):
    """Draws the cursor without an active sculpt: a ring as wide as the cutter that would suit the active object
    (common/fitting.py), or of fixed size without an object."""
    ob, pixels = context.object, 0.0
    if ob is not None and ob.type in object_surfaces.WITH_SURFACE and min(ob.dimensions) > 0:
        middle = meshes.matrix(ob.matrix_world) @ np.append(np.mean(ob.bound_box, axis=0), 1.0)
        seen = ViewRays(meshes.matrix(space.perspective_matrix), (region.width, region.height))
        pixels = 0.5 * max(ob.dimensions) / fitting.CUTTERS * seen.pixels_per_unit(middle[:3])
    return [(_ring(at, min(max(pixels, 6.0), 200.0)), True, True)]


def _ring(at, radius):
    """(64, 2) pixels."""
    angle = 2 * np.pi * np.arange(64) / 64
    return np.asarray(at) + radius * np.c_[np.cos(angle), np.sin(angle)]


def _beside(context, brush, ob, region, space, at):
    """Draws the cursor off the surface and before the first stroke: a ring as wide as the tool at the sculpt's
    centre."""
    global pixels_per_mm
    p = ob.data.riffler
    mm = sculpts.shown_mm_per_unit(ob.data)
    middle = poses.transform_points(meshes.matrix(ob.matrix_world), 0.5 * np.add(p.lower, p.upper)[None] / mm)[0]
    seen = ViewRays(meshes.matrix(space.perspective_matrix), (region.width, region.height))
    scale = float(np.cbrt(abs(np.linalg.det(meshes.matrix(ob.matrix_world)[:3, :3]))))
    pixels_per_mm = seen.pixels_per_unit(middle) * scale / mm
    own = context.scene.riffler
    width = own.hand_tool.width if brush.hand else own.tool.diameter
    radius = 0.5 * scene_units.clean(width) * pixels_per_mm
    return [(_ring(at, radius), True, True)]


def _draw(lines, corner, colour, zoom, named=""):
    import gpu

    with batches.state(), gpu.matrix.push_pop():
        gpu.matrix.translate(corner)
        for k, (points, closed, strong) in enumerate(lines):
            width = zoom * (1.6 if strong else 1.0)
            signature = (points.tobytes(), width)
            for name, extra, paint in (
                ("shadow", 1.6 * zoom, SHADOW),
                ("line", 0.0, (*colour, 0.95 if strong else 0.7)),
            ):
                batches.draw(
                    kept.get(
                        f"{named} {name} {k}",
                        signature,
                        lambda p=points, w=width + extra, c=closed: batches.flat(glyphs.ribbon(p, w, c)),
                    ),
                    paint,
                )
