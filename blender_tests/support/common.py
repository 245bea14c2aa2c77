"""Helpers of all tests in a Blender. The harness sets JOB, MODULE and Skip."""

import ctypes
import importlib
import os
import sys
import time
from pathlib import Path

import bpy
import numpy as np

from support import report

JOB = {}
MODULE = ""
Skip = RuntimeError
QUICK = 0.06  # s, of slowness() on a computer that compiles the core in six minutes
BALL = '{"kind": "ball", "diameter": 6.0, "length": 30.0}'
FLAT = '{"kind": "flat", "diameter": 6.0, "length": 30.0}'


def part(name):
    """A module of the installed add-on: part("sculpt.sculpt_store")."""
    return importlib.import_module(f"{MODULE}.{name}")


def out(name):
    path = Path(JOB["out"])
    path.mkdir(parents=True, exist_ok=True)
    return str(path / name)


def core_bound(test):
    """Marks a test whose time is spent in the core and that uses nothing that differs between Blender's versions: it
    runs in the oldest and in the newest of them only. Undo, opening files, frames and mesh attributes need all."""
    test.core_bound = True
    return test


def anywhere(test):
    """Marks a test that does the same wherever the add-on is installed, in a file of which others do not: the Blender
    that repeats files for the place (run.py) leaves it out."""
    test.anywhere = True
    return test


def fewer(cases):
    """Cases of a test whose Blender must be of every version, but not in each combination: all of them in the oldest
    and in the newest Blender, and every fifth where core-bound tests are left out."""
    cases = list(cases)
    return cases[::5] if "core_bound" in JOB.get("leave_out", ()) else cases


def scale(mm_per_unit):
    """Sets the mm of one Blender unit."""
    bpy.context.scene.unit_settings.scale_length = mm_per_unit / 1000


def stock(size=(40, 30, 20), pitch=1.0, directions="z", **more):
    bpy.ops.riffler.new_stock(source="BLOCK", size=size, pitch=pitch, directions=directions, **more)
    return bpy.context.object


def curve(name, points, matrix=None, mm_per_unit=1000.0, kind="POLY", tilt=None, cyclic=False):
    """A poly or NURBS curve object through `points` (mm in the scene) and linked to it."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    spline.points.add(len(points) - 1)
    co = np.ones((len(points), 4), np.float32)
    co[:, :3] = np.asarray(points) / mm_per_unit
    spline.points.foreach_set("co", co.ravel())
    if tilt is not None:
        spline.points.foreach_set("tilt", np.asarray(tilt, np.float32))
    spline.use_cyclic_u = cyclic
    ob = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def content(ob):
    """The sculpt's volume and cuts in the add-on."""
    return part("sculpt.sculpt_store").content(ob.data)


def shape(volume):
    """A volume's material as comparable arrays."""
    return [volume.intervals(d) for d in volume.directions]


def same(a, b):
    return all(np.array_equal(x, y) for p, q in zip(a, b, strict=True) for x, y in zip(p, q, strict=True))


def coordinates(mesh):
    co = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", co.ravel())
    return co


def corner_normals(mesh):
    """(corners, 3) float32, as Blender shows them."""
    normals = np.empty((len(mesh.loops), 3), np.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", normals.ravel())
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals.ravel())
    return normals


def triangles(mesh):
    tri = np.empty(3 * len(mesh.polygons), np.int32)
    mesh.loops.foreach_get("vertex_index", tri)
    return tri.reshape(-1, 3)


def select(ob):
    """Makes the object active, and the only one selected."""
    bpy.ops.object.select_all(action="DESELECT")
    ob.select_set(True)
    bpy.context.view_layer.objects.active = ob


def is_hidden(ob):
    """True if it is not drawn: hidden by its eye, or represented by chunks."""
    return part("sculpt.chunks").is_hidden(ob) or ob.hide_get()


def mesh_volume(co, tri):
    """Divergence theorem, computed here: the reference for the product's value."""
    a, b, c = (co[tri[:, k]].astype(float) for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def read_stl(path):
    """Triangles (n, 3, 3) of a binary STL, parsed here."""
    data = Path(path).read_bytes()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0])
    rows = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), count, 84)
    assert len(data) == 84 + 50 * count
    return rows["v"].astype(float)


def stl_volume(path):
    v = read_stl(path)
    return float(np.einsum("ij,ij->i", v[:, 0], np.cross(v[:, 1], v[:, 2])).sum() / 6)


def refused(call, *words):
    """The call must fail with an error that contains all the words, with or without a capital; returns its text."""
    try:
        call()
    except RuntimeError as error:  # a report of type ERROR in a script
        text = str(error)
        assert all(w in text or w[:1].upper() + w[1:] in text for w in words), text
        said = text.strip().removeprefix("Error: ")
        begins = said.partition(" ")[0].rstrip(":")
        names = [x.name for kind in (bpy.data.objects, bpy.data.collections, bpy.data.images) for x in kind]
        assert not (begins.isalpha() and begins.islower() and "Error: " in text) or said.startswith(tuple(names)), text
        return text
    raise AssertionError("no error was reported")


def printed(call):
    """Blender's output while it runs: without a window, the operators' reports."""
    path, kept = Path(out("printed.txt")), os.dup(1)
    _flush()
    with path.open("w") as file:
        os.dup2(file.fileno(), 1)
        try:
            call()
        finally:
            _flush()
            os.dup2(kept, 1)
            os.close(kept)
    return path.read_text()


def _flush():
    """Blender prints some of it itself, and some through Python."""
    sys.stdout.flush()
    ctypes.CDLL(None).fflush(None)


def slowness(clock=time.process_time):
    """How many times longer than on a quick computer a fixed computation takes now, at least 1: by that much a test's
    hand is slower, so that it finds what grows with the model and not what kind of computer runs it, or what else does.
    The computation gathers from memory and interprets Python, and uses nothing of Riffler."""
    random = np.random.default_rng(1)
    values, order = random.random(2_000_000), random.permutation(2_000_000)
    took = []
    for _ in range(3):
        begin = clock()
        total = values[order].cumsum()[-1]
        for k in range(300_000):
            total += k * k
        took.append(clock() - begin)
    return max(1.0, max(took) / QUICK)


def figure(name, value):
    """Records a measurement, for out/blender/figures.json."""
    report.say(figure=name, value=value)


def push(message="step"):
    bpy.ops.ed.undo_push(message=message)
