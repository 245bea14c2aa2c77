"""Sculpts: mesh objects whose mesh points to a volume."""

import uuid
import zlib
from contextlib import contextmanager
from typing import NamedTuple

import bpy
import numpy as np

from ..blender import attributes, meshes, refusals, scene_units
from . import mask_display, sculpt_store, surfaces


def is_sculpt(ob):
    return ob is not None and ob.type == "MESH" and ob.data.riffler.store is not None


def in_scene(ob, scene):
    """The object if it is a sculpt of the scene, otherwise None: a pointer property may still name a deleted object."""
    return ob if is_sculpt(ob) and scene.objects.get(ob.name) == ob else None


def active(context):
    """The active object if it is a sculpt, otherwise None."""
    ob = context.object
    return ob if is_sculpt(ob) else None


def new_mark(ob):
    """A new identifier of a live sculpt, independent of its name; undo restores it with the object."""
    ob.riffler.mark = uuid.uuid4().hex
    return ob.riffler.mark


def marked(mark, name=""):
    """The sculpt of that mark, or None. Its name, if known, distinguishes it from copies, which have the same mark."""
    ob = bpy.data.objects.get(name)
    if ob is not None and ob.riffler.mark == mark:
        return ob if is_sculpt(ob) else None
    return next((ob for ob in bpy.data.objects if ob.riffler.mark == mark and is_sculpt(ob)), None)


def key_of(ob):
    """The key of bpy.data.objects, name and file: a linked object may have the name of a local one."""
    return ob.name, ob.library.filepath if ob.library else None


def new_object(context, name, content, matrix, mm_per_unit=None, collections=(), unseen=""):
    """A new sculpt at `matrix` (world), active and the only one selected, in these collections, or in the active one.
    `mm_per_unit`: None for the scene's; `unseen`: that of `commit`."""
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
    """The active collection; the scene's own if nothing can be added to that one, or it is not visible."""
    active = context.collection
    if active.library or active.override_library or context.layer_collection.exclude:
        return context.scene.collection
    return active


def select_only(context, ob):
    """Makes the object active, and the only one selected."""
    for other in context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    context.view_layer.objects.active = ob


def take_looks(ob, other):
    """Copies the materials of another sculpt."""
    for material in other.data.materials:
        ob.data.materials.append(material)


def commit(mesh, content, mm_per_unit, token="", unseen="", surface=None):
    """Makes `content` the mesh's and shows its volume. It must not be changed afterwards. Returns triangles. `unseen`:
    the error if there would be none; without it the mesh may be empty. `surface`: what is shown, if it is known."""
    _must_be_fillable(mesh)
    surface = surface or surface_of(mesh, content)  # anything that can fail comes before the first change
    if unseen and not len(surface.triangles):
        raise ValueError(unseen)
    sculpt_store.write(mesh, content, token)
    _show_whole(mesh, content, surface, mm_per_unit)
    return len(surface.triangles)


def surface_of(mesh, content):
    """The surfaces.Surface that the mesh of a sculpt shows of a content."""
    return surfaces.of_volume(content.volume, surfaces.within(mesh.riffler.detail, content.volume.pitch, content.mask))


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
    """(3,) mm: the centre of symmetry of strokes on the mesh's volume. It stays when the box grows on one side."""
    return 0.5 * (volume.lower + volume.upper) - np.array(mesh.riffler.off_middle)


def keep_middle(mesh, volume, before):
    """The mesh has this volume, with another box: keeps its `middle` at the one `before`."""
    mesh.riffler.off_middle = np.array(mesh.riffler.off_middle) + middle(mesh, volume) - before


class Facts(NamedTuple):
    """A panel's facts of a sculpt; mesh.riffler has the same."""

    material: float  # mm³
    nbytes: float
    cuts: int
    moves: int


def facts(content):
    volume, cuts = content.volume, content.cuts
    return Facts(volume.volume, float(volume.nbytes), len(cuts), sum(c.moves for c in cuts))


def show(mesh, surface, mm_per_unit, mask=None):
    """Fills the mesh from a surfaces.Surface; faces within `mask`, a volume, are shown as protected. Deviation colours
    are removed, since they belong to the previous surface."""
    if attributes.hide_colours(mesh):
        attributes.settle()
    vertices, triangles = np.asarray(surface.vertices), np.asarray(surface.triangles)
    meshes.fill(mesh, vertices / mm_per_unit, triangles, **surface.shading)
    mask_display.show(mesh, mask, vertices, triangles)
    p = mesh.riffler
    p.mm_per_unit, p.shown_within, p.all_triangles = mm_per_unit, surface.within or 0.0, surface.all_triangles
    p.shown, p.shown_at = _fingerprint(mesh)
    p.shown_crc = _checksum(mesh)


def refill(mesh, mm_per_unit):
    """Shows the stored volume again: after the mesh was edited, or the scene's units were changed."""
    _must_be_fillable(mesh)
    content = sculpt_store.content(mesh)
    _show_whole(mesh, content, surface_of(mesh, content), mm_per_unit)


def show_all(mesh):
    """Shows all triangles, for colours at their vertices, until the surface is shown again."""
    show_whole(mesh, surfaces.of_volume(sculpt_store.content(mesh).volume, None))


def show_whole(mesh, surface):
    """Shows this Surface of its volume."""
    _must_be_fillable(mesh)
    _show_whole(mesh, sculpt_store.content(mesh), surface, shown_mm_per_unit(mesh))


def show_needed(mesh):
    """Undoes `show_all`, unless the user wants all triangles, or Blender's own tools have changed them."""
    if mesh.riffler.detail != "ALL" and not mesh.library and not mesh.is_editmode and not changed(mesh):
        refill(mesh, shown_mm_per_unit(mesh))


def every_triangle(mesh):
    """Vertices (V, 3) in Blender units and triangles (F, 3) that `show_all` would show."""
    surface = surfaces.of_volume(sculpt_store.content(mesh).volume, None)
    return surface.vertices / shown_mm_per_unit(mesh), surface.triangles


def all_triangles(mesh):
    """How many the mesh has, or would have if it showed all."""
    return mesh.riffler.all_triangles or len(mesh.loops) - 2 * len(mesh.polygons)


@contextmanager
def in_object_mode(ob):
    """Context in Object Mode, the only one in which Blender fills a mesh. The previous mode is entered again
    afterwards, with an undo step, since its own steps have other geometry."""
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
    """True if the packed data is newer than the displayed mesh: of a live sculpt."""
    return mesh.riffler.shown_of not in ("", sculpt_store.identity(mesh))


def edited(mesh):
    """True if the mesh differs from the surface last shown: other counts, or other coordinates of a few vertices (as
    after Apply Scale), or shape keys. Cheap enough for every drawing of a panel; it misses a few moved vertices."""
    if mesh.shape_keys is not None:
        return True
    counts, places = _fingerprint(mesh)
    return tuple(mesh.riffler.shown) != counts or tuple(mesh.riffler.shown_at) != places


def changed(mesh):
    """`edited`, by every vertex: before work on the sculpt (5 ms for a million vertices). A file of an older add-on has
    no checksum to compare with."""
    return edited(mesh) or mesh.riffler.shown_crc not in ("", _checksum(mesh))


def _checksum(mesh):
    return f"{zlib.crc32(meshes.coordinates(mesh)):08x}"


def _fingerprint(mesh):
    n = len(mesh.vertices)
    if n == 0:
        return (0, len(mesh.polygons)), (0.0,) * 24
    return (n, len(mesh.polygons)), tuple(x for k in range(8) for x in mesh.vertices[k * (n - 1) // 7].co)


def shown_mm_per_unit(mesh):
    """Millimetres of the volume in one Blender unit of its mesh, as currently displayed."""
    return scene_units.clean(mesh.riffler.mm_per_unit)


def to_world_mm(ob, scene):
    """(4, 4): millimetres in the sculpt's frame → millimetres in the scene."""
    here = scene_units.mm_per_unit(scene)
    m = meshes.matrix(ob.matrix_world)
    m[:3, :3] *= here / shown_mm_per_unit(ob.data)
    m[:3, 3] *= here
    return m


def rigid_to_world(context, ob):
    """`to_world_mm` as a rotation and a translation, for programs and plans, which are in millimetres. ValueError with
    the remedy if it scales."""
    refusals.refuse(context, ob)
    if why := refusals.scaled(ob):
        raise ValueError(why)
    matrix = to_world_mm(ob, context.scene)
    u, size, v = np.linalg.svd(matrix[:3, :3])
    if np.abs(size - 1).max() > 1e-4:
        raise ValueError(f"{ob.name} is shown in other units than the scene's: use Rebuild Mesh first")
    matrix[:3, :3] = u @ v
    return matrix


def from_world(ob):
    """(4, 4): Blender units in the world → millimetres in the sculpt's frame. ValueError if it has none."""
    if why := refusals.flat(ob):
        raise ValueError(why)
    m = np.linalg.inv(meshes.matrix(ob.matrix_world))
    m[:3] *= shown_mm_per_unit(ob.data)
    return m


def from_object(ob, other):
    """(4, 4): Blender units in another object's frame → millimetres in the sculpt's frame."""
    return from_world(ob) @ meshes.matrix(other.matrix_world)
