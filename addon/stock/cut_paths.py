"""Cuts from curves and recordings."""

from pathlib import Path

import numpy as np
import riffler
from mathutils import Vector

from ..blender import curve_objects
from ..common import poses, problems, splines
from ..common.job import Cut
from ..sculpt import sculpts
from ..sculpt.pure.journal import brush_of


def along_curve(context, ob, curve, tool, axis, depth, follow, tolerance):
    """One cut per spline of the curve object. ValueError if there is nothing to cut."""
    depsgraph = context.evaluated_depsgraph_get()
    size = riffler.Tool.from_dict(tool).diameter
    cuts, far = [], False
    for spline in curve_objects.splines(curve, depsgraph, sculpts.from_object(ob, curve)):
        points, tilt = splines.evaluate(spline, tolerance)
        if len(points) < 2:
            continue
        if follow or axis == "NORMAL":
            # The surface bends between the curve's points, so it is sampled every pitch.
            points, tilt = splines.refine(points, tilt, ob.data.riffler.pitch)
            scale = sculpts.shown_mm_per_unit(ob.data)
            places, normals = nearest_on_surface(ob, depsgraph, points, scale)
        if follow:
            distinct = splines.distinct(places)
            points, tilt, normals = places[distinct], tilt[distinct], normals[distinct]
            if len(points) < 2:
                far = True
                continue
        if axis == "UP":
            axes = poses.fixed_axes(len(points))
        elif axis == "TILT":
            axes = poses.tilted_axes(points, tilt)
        else:  # facets and edges would jerk the tool: smooth the axis over about its own width
            axes = poses.smooth_axes(points, normals, size)
        cuts.append(Cut(tool, poses.make_poses(points, axes, depth), tolerance))
    if not cuts and far:
        raise ValueError(
            f"{curve.name} is too far from {ob.name}, one point of which is the nearest to the whole curve: move it "
            "nearer, or turn Follow Surface off"
        )
    if not cuts:
        raise ValueError(f"{curve.name} has no spline with two points: add points, or choose another curve")
    return cuts


def from_recording(path):
    """The strokes of a recording (.rjournal) as cuts, and its stock as a dictionary or None."""
    problems.check_source(path)
    journal = riffler.Journal.load(path)
    tools = journal.tools
    cuts = [
        Cut(tools[s.tool], s.poses, s.tolerance, brush_of(s).cuts)
        for s in journal.strokes
        if len(s) > 1 and brush_of(s).cuts
    ]
    if not cuts:
        raise ValueError("the recording has no stroke with two poses that removes or adds material")
    return cuts, journal.stock


def stock_of_recording(path):
    """The volume that a recording begins with: its snapshot, a file next to it, or the full block."""
    problems.check_source(path)
    stock = riffler.Journal.load(path).stock
    if stock is None:
        raise ValueError(f"{Path(path).name} does not name the stock it was made on")
    if stock.snapshot:
        return riffler.Volume.load(Path(path).with_name(stock.snapshot))
    return riffler.Volume.block(stock.lower, stock.upper, stock.pitch, stock.directions)


def to_recording(cuts, volume):
    """A journal of the cuts in the volume's frame; equal tools share a number."""
    journal = riffler.Journal()
    journal.set_stock(volume.lower, volume.upper, volume.pitch, volume.directions)
    tools = []
    for cut in cuts:
        if cut.tool not in tools:
            tools.append(cut.tool)
            journal.add_tool(len(tools), cut.tool)
        journal.add_stroke(tools.index(cut.tool) + 1, cut.poses, tolerance=cut.tolerance)
    return journal


def nearest_on_surface(ob, depsgraph, points, mm_per_unit):
    """Nearest points (n, 3) of the sculpt as displayed and the surface's normals (n, 3) there, in millimetres in its
    own frame like `points`."""
    if not ob.data.polygons:
        raise ValueError("the sculpt has no surface left to follow")
    evaluated = ob.evaluated_get(depsgraph)
    places, normals = np.empty_like(points), np.empty_like(points)
    for k, p in enumerate(points / mm_per_unit):
        found, place, normal, _ = evaluated.closest_point_on_mesh(Vector(p))
        if not found:
            raise ValueError(f"the sculpt has no surface near {points[k]}")
        places[k], normals[k] = place, normal
    return places * mm_per_unit, normals
