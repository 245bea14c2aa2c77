"""Sculpts: mesh objects whose mesh points to a volume."""

import uuid
import zlib
from contextlib import contextmanager
from typing import NamedTuple

import bpy
import numpy as np

from ..blender import attributes, meshes, refusals, scene_units
from . import mask_display, sculpt_store


def is_sculpt(ob):
    return ob is not None and ob.type == "MESH" and ob.data.riffler.store is not None


def active(context):
    """The active object where it is a sculpt, otherwise None."""
    ob = context.object
    return ob if is_sculpt(ob) else None


def new_mark(ob):
    """What a sculpt that is worked at is known by, whatever it is called; undo brings it back with the object."""
    ob.riffler.mark = uuid.uuid4().hex
    return ob.riffler.mark


def marked(mark, name=""):
    """The sculpt of that mark, or None. Its name, if that is known, tells it from its copies, which have the mark."""
    ob = bpy.data.objects.get(name)
    if ob is not None and ob.riffler.mark == mark:
        return ob if is_sculpt(ob) else None
    return next((ob for ob in bpy.data.objects if ob.riffler.mark == mark and is_sculpt(ob)), None)


def key_of(ob):
    """What bpy.data.objects takes an object by, name and file: a linked one may be called as one of this file."""
    return ob.name, ob.library.filepath if ob.library else None


def new_object(context, name, content, matrix, mm_per_unit=None, collections=(), unseen=""):
    """A new sculpt at `matrix` (world), active and the only one selected, in these collections, or in the active one.
    `mm_per_unit`: None for the scene's; `unseen`: as `commit`'s."""
    mesh = bpy.data.meshes.new(name)
    try:
        commit(mesh, content, mm_per_unit or scene_units.mm_per_unit(context.scene), unseen=unseen)
    except BaseException:
        bpy.data.meshes.remove(mesh)
        raise
    ob = bpy.data.objects.new(name, mesh)
    for collection in collections or [_home(context)]:
        collection.objects.link(ob)
    ob.matrix_world = matrix
    select_only(context, ob)
    return ob


def _home(context):
    """The active collection; the scene's own where nothing can be put into that one, or would not be seen in it."""
    active = context.collection
    if active.library or active.override_library or context.layer_collection.exclude:
        return context.scene.collection
    return active


def select_only(context, ob):
    """Active, and the only one selected."""
    for other in context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    context.view_layer.objects.active = ob


def take_looks(ob, other):
    """The materials of another sculpt."""
    for material in other.data.materials:
        ob.data.materials.append(material)


def commit(mesh, content, mm_per_unit, token="", unseen=""):
    """Makes `content` the mesh's and shows its volume. It must not be changed afterwards. Returns triangles. `unseen`:
    what to say where there would be none; without it the mesh may be empty."""
    _must_be_fillable(mesh)
    surface = content.volume.to_mesh(report={})  # whatever can fail comes before the first change
    if unseen and not len(surface.triangles):
        raise ValueError(unseen)
    sculpt_store.write(mesh, content, token)
    _show_whole(mesh, content, surface, mm_per_unit)
    return len(surface.triangles)


def _must_be_fillable(mesh):
    if mesh.is_editmode:
        raise ValueError(f"{mesh.name} is in Edit Mode: leave it first")


def _show_whole(mesh, content, surface, mm_per_unit):
    show(mesh, surface, mm_per_unit, content.mask)
    p, volume = mesh.riffler, content.volume
    p.shown_of = sculpt_store.identity(mesh)
    p.lower, p.upper, p.pitch, p.directions = volume.lower, volume.upper, volume.pitch, volume.directions
    for key, value in facts(content)._asdict().items():
        setattr(p, key, value)


def middle(mesh, volume):
    """(3,) mm: where strokes on the mesh's volume are mirrored. It stays when the box becomes longer on one side."""
    return 0.5 * (volume.lower + volume.upper) - np.array(mesh.riffler.off_middle)


def keep_middle(mesh, volume, before):
    """The mesh has got this volume, with another box: its `middle` is the one that was there `before`."""
    mesh.riffler.off_middle = np.array(mesh.riffler.off_middle) + middle(mesh, volume) - before


class Facts(NamedTuple):
    """What a panel says of a sculpt; mesh.riffler has the same."""

    material: float  # mm³
    nbytes: float
    cuts: int
    moves: int


def facts(content):
    volume, cuts = content.volume, content.cuts
    return Facts(volume.volume, float(volume.nbytes), len(cuts), sum(c.moves for c in cuts))


def show(mesh, surface, mm_per_unit, mask=None):
    """Fills the mesh from a surface in millimetres; what lies in `mask`, a volume, is seen to be protected. Colours of
    distances were those of the surface before."""
    if attributes.hide_distance(mesh):
        attributes.settle()
    meshes.fill(mesh, np.asarray(surface.vertices) / mm_per_unit, surface.triangles)
    mask_display.show(mesh, mask, np.asarray(surface.vertices), np.asarray(surface.triangles))
    p = mesh.riffler
    p.mm_per_unit = mm_per_unit
    p.shown, p.shown_at = _fingerprint(mesh)
    p.shown_crc = _checksum(mesh)


def refill(mesh, mm_per_unit):
    """Shows the stored volume again: after the mesh was edited, or the scene's units were changed."""
    _must_be_fillable(mesh)
    content = sculpt_store.content(mesh)
    _show_whole(mesh, content, content.volume.to_mesh(report={}), mm_per_unit)


@contextmanager
def in_object_mode(ob):
    """Blender fills a mesh in no other mode. What follows is done in Object Mode, and the mode taken up again, with an
    undo step, since those of the mode before have other geometry."""
    mode = ob.mode
    if mode == "OBJECT":
        yield
        return
    _set_mode(ob, "OBJECT")
    try:
        yield
    finally:
        _set_mode(ob, mode)
        bpy.ops.ed.undo_push(message="Mesh of the Strokes")


def _set_mode(ob, mode):
    window = bpy.context.window or bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, active_object=ob, object=ob, selected_objects=[ob]):
        bpy.ops.object.mode_set(mode=mode)


def behind(mesh):
    """True where what is packed has gone on since the mesh showed it: of a live sculpt."""
    return mesh.riffler.shown_of not in ("", sculpt_store.identity(mesh))


def edited(mesh):
    """True where the mesh is not the surface that was last shown: other counts, or other places of a few vertices (as
    after Apply Scale), or shape keys. Cheap enough for every drawing of a panel; a few pulled vertices escape it.
    """
    if mesh.shape_keys is not None:
        return True
    counts, places = _fingerprint(mesh)
    return tuple(mesh.riffler.shown) != counts or tuple(mesh.riffler.shown_at) != places


def changed(mesh):
    """`edited`, by every vertex: for what takes the sculpt up for work (5 ms for a million). A file of an older add-on
    has no checksum to compare with."""
    return edited(mesh) or mesh.riffler.shown_crc not in ("", _checksum(mesh))


def _checksum(mesh):
    return f"{zlib.crc32(meshes.coordinates(mesh)):08x}"


def _fingerprint(mesh):
    n = len(mesh.vertices)
    if n == 0:
        return (0, len(mesh.polygons)), (0.0,) * 24
    return (n, len(mesh.polygons)), tuple(x for k in range(8) for x in mesh.vertices[k * (n - 1) // 7].co)


def shown_mm_per_unit(mesh):
    """Millimetres of the volume in one Blender unit of its mesh, as it is shown now."""
    return scene_units.clean(mesh.riffler.mm_per_unit)


def to_world_mm(ob, scene):
    """(4, 4): millimetres in the sculpt's frame → millimetres in the scene."""
    here = scene_units.mm_per_unit(scene)
    m = meshes.matrix(ob.matrix_world)
    m[:3, :3] *= here / shown_mm_per_unit(ob.data)
    m[:3, 3] *= here
    return m


def from_world(ob):
    """(4, 4): Blender units in the world → millimetres in the sculpt's frame. ValueError where it has none."""
    if why := refusals.flat(ob):
        raise ValueError(why)
    m = np.linalg.inv(meshes.matrix(ob.matrix_world))
    m[:3] *= shown_mm_per_unit(ob.data)
    return m


def from_object(ob, other):
    """(4, 4): Blender units in another object's frame → millimetres in the sculpt's frame."""
    return from_world(ob) @ meshes.matrix(other.matrix_world)
