"""Live sculpts for tests: strokes, and whether the display matches their result."""

import hashlib

import bpy
import numpy as np
import riffler

from support import common

BALL = riffler.Tool.ball(6, 30)
SIZE = (60, 60, 20)
# Nine chunks, one of them with none but neighbours. Before Blender 4.5 a sculpt shows all of its triangles, so these
# take 0.4 of the time that 32 chunks at 0.5 mm take.
PITCH = 0.8
FACTORS = np.random.default_rng(1).integers(1 << 63, size=12, dtype=np.uint64) * np.uint64(2) + np.uint64(1)
KEPT = 64  # states
_expected = {}


def live():
    return common.part("sculpt.live_registry")


def sculpt(name="", size=SIZE, directions="xyz", pitch=PITCH):
    common.scale(1)
    ob = common.stock(size=size, pitch=pitch, directions=directions)
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
    """Triangles of all chunks, as `keys`."""
    corners = []
    for ob in common.part("sculpt.chunks").collection_of(bpy.data.objects[name].riffler.mark).objects:
        if "riffler_chunk" in ob and len(ob.data.polygons):  # and not a device's tool
            co = common.coordinates(ob.data)
            tri = np.empty(3 * len(ob.data.polygons), np.int32)
            ob.data.loops.foreach_get("vertex_index", tri)
            corners.append(co[tri].reshape(-1, 9))
    return keys(np.vstack(corners))


def keys(triangles):
    """A sorted number for each of (n, 9) float32. Sorting these takes a tenth of the time of sorting the
    coordinates."""
    return np.sort(numbers(triangles))


def numbers(rows):
    """A number for each of (n, up to 12) float32: equal for equal ones, different for others except one time in
    2^64."""
    words = (rows + np.float32(0)).view(np.uint32)  # + 0: no negative zeros
    return words.astype(np.uint64) @ FACTORS[: words.shape[1]]


def corner_numbers(vertices, triangles):
    """For all corners of the triangles, in order: a number for the places of its vertex and of its triangle."""
    corners = np.ascontiguousarray(vertices, np.float32)[triangles]
    return numbers(np.hstack([corners.reshape(-1, 3), np.repeat(corners.reshape(-1, 9), 3, axis=0)]))


def surface(volume, mask=None, detail="NEEDED"):
    """What a sculpt shows of its volume."""
    return volume.to_mesh(tolerance=common.part("sculpt.surfaces").within(detail, volume.pitch, mask))


def expected(volume, mask, detail):
    """The triangles of a volume's surface, as `keys`. A walk through the history returns to the same states, so the
    last ones are kept."""
    state = hashlib.sha256(volume.to_bytes() + (b"" if mask is None else mask.to_bytes())).digest(), detail
    found = _expected.pop(state, None)
    if found is None:
        mesh = surface(volume, mask, detail)
        found = keys(np.asarray(mesh.vertices, np.float32)[np.asarray(mesh.triangles)].reshape(-1, 9))
    _expected[state] = found
    if len(_expected) > KEPT:
        del _expected[next(iter(_expected))]
    return found


def is_shown(name):
    ob = bpy.data.objects[name]
    run = live().of(ob)
    assert np.array_equal(shown(name), expected(run.volume, run.mask, ob.data.riffler.detail))


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
