"""The inputs of a job: part, stock, fixtures and axis in the stock's frame, and the operations."""

import hashlib
import json
from dataclasses import dataclass

import numpy as np
import riffler

from ..blender import meshes, object_surfaces, scene_units
from ..plan import given_curves, obstacles
from ..sculpt import live_registry, sculpt_store, sculpts
from .pure.job_run import Wanted, keys_of

MISSING = {
    "points": "there are no holes: choose a collection with an object at each of them",
    "curves": "there are no curves: choose a collection with curve objects on the part",
    "target": "there is no target: choose an object that the tool leans to or from",
}
CURVE_ERROR = 0.001  # mm between a curve and its polyline
NO_STOCK = "There is no stock: use Make Stock, or choose a sculpt that the part lies in"


@dataclass(frozen=True)
class Inputs:
    """The inputs of a job. `to_world`: (4, 4) from the stock's frame to the scene, both in mm; `keys`: one for each
    operation."""

    part: riffler.Mesh
    stock: riffler.Volume
    fixtures: list
    axis: np.ndarray
    clearance: float
    to_world: np.ndarray
    wanted: list[Wanted]
    keys: list[str]
    names: tuple[str, ...]  # of the objects that the inputs come from

    def setup(self):
        """A riffler.plan.Setup with the whole stock. ValueError for inputs that do not fit together."""
        # The machine's axes are checked when the program is written, because the machine has another frame.
        return riffler.plan.Setup(
            self.part, self.stock, self.fixtures, axis=self.axis, clearance=self.clearance, machine="tcp"
        )


def stock_of(scene):
    """The job's stock if it is in the scene, else None."""
    return sculpts.in_scene(scene.riffler.machining.stock, scene)


def world_axis(scene):
    """(3,) unit vector from tip to spindle, in the scene's frame."""
    ob = scene.riffler.machining.upright
    if ob is None:
        return np.array([0.0, 0.0, 1.0])
    axis = meshes.matrix(ob.matrix_world)[:3, 2]
    size = np.linalg.norm(axis)
    if not size > 0:
        raise ValueError(f"{ob.name} has no z axis, since its scale is 0: choose another object for the axis")
    return axis / size


def unfit(scene):
    """Why the job cannot be calculated, or "". Quick enough for a panel."""
    if why := object_surfaces.unfit(scene.riffler.plan.part, scene):
        return why
    ob = stock_of(scene)
    if ob is None:
        return NO_STOCK
    if ob == scene.riffler.plan.part:
        return f"{ob.name} is both part and stock: choose another stock"
    if not scene.riffler.machining.rows:
        return "The job has no operations: add one"
    return ""


def take(context):
    """The Inputs of the scene's job. ValueError, with the remedy, if they are incomplete."""
    scene = context.scene
    if why := unfit(scene):
        raise ValueError(why)
    live_registry.end_all()  # the mesh of a live sculpt is not up to date
    settings, ob, part = scene.riffler.machining, stock_of(scene), scene.riffler.plan.part
    rows = settings.switched_on()
    if not rows:
        raise ValueError("Every operation is off: switch one on")
    held = obstacles.fixture_objects(scene.riffler.plan, part)
    to_world = sculpts.rigid_to_world(context, ob)
    to_stock = np.linalg.inv(to_world)
    part, *fixtures = [_placed(object_surfaces.in_world(context, one), to_stock) for one in (part, *held)]
    axis = to_stock[:3, :3] @ world_axis(scene)
    axis = np.where(np.abs(axis) < 1e-12, 0.0, axis) / np.linalg.norm(axis)
    volume = live_registry.content(ob).volume.copy()
    clearance = scene_units.clean(settings.clearance)
    base = _base([part, *fixtures], sculpt_store.identity(ob.data), axis, clearance)
    wanted = [row.wanted(lambda field, value: _place(field, value, scene, to_stock)) for row in rows]
    for one in wanted:
        for field, missing in MISSING.items():
            if one.options.get(field) == []:
                raise ValueError(f"{one.name}: {missing}")
    names = (scene.riffler.plan.part.name, ob.name)
    return Inputs(part, volume, fixtures, axis, clearance, to_world, wanted, keys_of(base, wanted), names)


def _placed(mesh, matrix):
    return riffler.Mesh(*object_surfaces.placed(np.asarray(mesh.vertices), np.asarray(mesh.triangles), matrix))


def _place(field, value, scene, matrix):
    """What a field of MISSING stands for, mm, mapped by `matrix` (4, 4) from the scene's mm: origins, polylines, or the
    points of a target. Empty if it is not set."""
    if field == "points":
        return _origins(value, scene, matrix)
    if field == "curves":
        return _polylines([ob for ob in value.all_objects if ob.type == "CURVE"] if value else [], scene, matrix)
    if value is None:
        return []
    if value.type == "CURVE":
        lines = _polylines([value], scene, matrix)
        return [point for line in lines[:1] for point in line]
    place = np.array(value.matrix_world.translation) * scene_units.mm_per_unit(scene)
    return [_rounded(matrix, place)]


def _polylines(objects, scene, matrix):
    """The splines of curve objects, sorted by name, as lists of points."""
    found = given_curves.lines(sorted(objects, key=lambda ob: ob.name), scene, CURVE_ERROR)
    return [[_rounded(matrix, point) for point in line] for line in found]


def _rounded(matrix, place):
    return [round(float(x), 6) for x in matrix[:3, :3] @ place + matrix[:3, 3]]


def _origins(collection, scene, matrix):
    """Origins of a collection's objects, sorted by name, mm, mapped by `matrix` (4, 4) from the scene's mm."""
    found = sorted(collection.all_objects, key=lambda ob: ob.name) if collection else []
    places = [np.array(ob.matrix_world.translation) * scene_units.mm_per_unit(scene) for ob in found]
    return [_rounded(matrix, place) for place in places]


def _base(surfaces, stock, axis, clearance):
    """A text of everything on which all operations depend. Coordinates are rounded to a nanometre, so that a stock and
    a part that are moved together keep their moves."""
    prints = []
    for mesh in surfaces:
        corners = np.round(np.asarray(mesh.vertices) * 1e6).astype(np.int64)
        prints.append(hashlib.blake2b(corners.tobytes() + np.asarray(mesh.triangles).tobytes()).hexdigest())
    return json.dumps([prints, stock, [round(float(x), 9) for x in axis], clearance])


def _glance(field, value, scene):
    """Like `_place`, but quicker for curves: their control points, not their polylines."""
    if value is None or field == "points":
        return _origins(value, scene, np.eye(4))
    objects = value.all_objects if field == "curves" else [value]
    found = sorted((ob for ob in objects if field == "target" or ob.type == "CURVE"), key=lambda ob: ob.name)
    out = []
    for ob in found:
        out.append(meshes.matrix(ob.matrix_world).round(6).tolist())
        for spline in ob.data.splines if ob.type == "CURVE" else ():
            points = spline.bezier_points if spline.type == "BEZIER" else spline.points
            names = ("co", "handle_left", "handle_right") if spline.type == "BEZIER" else ("co",)
            for name in names:
                values = np.empty(len(points) * (3 if spline.type == "BEZIER" else 4), np.float32)
                points.foreach_get(name, values)
                out.append([spline.use_cyclic_u, hashlib.blake2b(values.tobytes()).hexdigest()])
    return out


def glances(scene):
    """A quick key for each operation, by the number of its row from 0, which a panel can compare: it leaves out the
    shapes of part and fixtures."""
    settings, ob = scene.riffler.machining, stock_of(scene)
    part, held = scene.riffler.plan.part, scene.riffler.plan.fixtures
    names = [part.name if part else "", ob.name if ob else "", held.name if held else ""]
    places = [meshes.matrix(one.matrix_world).round(6).tolist() for one in (part, ob, settings.upright) if one]
    stock = sculpt_store.identity(ob.data) if ob else ""
    mm = scene_units.mm_per_unit(scene)
    base = json.dumps([names, places, stock, scene_units.clean(settings.clearance), mm])
    on = [k for k, row in enumerate(settings.rows) if row.on]
    options = [row.options(lambda field, value: _glance(field, value, scene)) for row in settings.switched_on()]
    wanted = [
        Wanted("", row.kind, {"text": row.tool}, given)
        for row, given in zip(settings.switched_on(), options, strict=True)
    ]
    return dict(zip(on, keys_of(base, wanted), strict=True))
