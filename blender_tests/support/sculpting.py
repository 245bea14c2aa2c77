"""Live sculpts for tests: strokes, and whether the display matches their result."""

import bpy
import numpy as np
import riffler

from support import common

BALL = riffler.Tool.ball(6, 30)
SIZE = (60, 60, 20)


def live():
    return common.part("sculpt.live_registry")


def sculpt(name="", size=SIZE, directions="xyz"):
    common.scale(1)
    ob = common.stock(size=size, pitch=0.5, directions=directions)
    if name:
        ob.name = name
    common.push("stock")
    return ob.name


def work(name):
    return live().begin(bpy.context, bpy.data.objects[name])


def stroke(name, k, mode="remove", label="stroke", may_be_none=False):
    """One of many different grooves."""
    run = work(name)
    run.begin_stroke()
    y = 5 + 4 * (k % 13)
    run.carve(BALL, np.array([[8.0, y, 18, 0, 0, 1], [50 - k % 7, y, 18 - 0.3 * (k % 5), 0, 0, 1]]), mode=mode)
    assert run.finish_stroke(bpy.context, label) or may_be_none
    return run.volume.to_bytes()


def shown(name):
    """Triangles of all chunks, as sorted rows of coordinates."""
    corners = []
    for ob in common.part("sculpt.chunks").collection_of(bpy.data.objects[name].riffler.mark).objects:
        if "riffler_chunk" in ob and len(ob.data.polygons):  # and not a device's tool
            co = common.coordinates(ob.data)
            tri = np.empty(3 * len(ob.data.polygons), np.int32)
            ob.data.loops.foreach_get("vertex_index", tri)
            corners.append(co[tri].reshape(-1, 9))
    rows = np.vstack(corners)
    return rows[np.lexsort(rows.T)]


def surface(volume, mask=None, detail="NEEDED"):
    """What a sculpt shows of its volume."""
    return volume.to_mesh(tolerance=common.part("sculpt.surfaces").within(detail, volume.pitch, mask))


def expected(volume, mask=None, detail="NEEDED"):
    mesh = surface(volume, mask, detail)
    rows = np.asarray(mesh.vertices, np.float32)[np.asarray(mesh.triangles)].reshape(-1, 9)
    return rows[np.lexsort(rows.T)]


def same_triangles(a, b):
    """Chunks may rotate a triangle's corners; so compares sets of rows."""
    return a.shape == b.shape and np.array_equal(a, b)


def is_shown(name):
    ob = bpy.data.objects[name]
    run = live().of(ob)
    assert same_triangles(shown(name), expected(run.volume, run.mask, ob.data.riffler.detail))


def nothing_is_left():
    chunks = common.part("sculpt.chunks")
    assert not chunks.shown()
    left = [x.name for x in (*bpy.data.objects, *bpy.data.meshes, *bpy.data.materials) if chunks.MARK in x]
    assert not left, left
    assert not live().lives


def matches_its_volume(name):
    ob = bpy.data.objects[name]
    content = common.content(ob)
    mesh = surface(content.volume, content.mask, ob.data.riffler.detail)
    assert np.array_equal(common.coordinates(ob.data), np.asarray(mesh.vertices, np.float32))
    assert len(ob.data.polygons) == len(mesh.triangles)
    assert not ob.hide_get()
