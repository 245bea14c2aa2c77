"""The display of a live sculpt: about a hundred mesh objects (chunks), each with the triangles of some bricks.

Filling one mesh of half a million triangles takes a tenth of a second; filling a chunk takes time for its own triangles
only. Chunks are Blender objects, so that the artist's materials, matcaps and overlays apply. They are few, because
Blender's undo costs time per object (docs/decisions.md). The sculpt itself is hidden meanwhile.

Everything is in one collection, which names its sculpt, so that leftovers in an undo step or in the file of a Blender
that crashed are recognised and removed. The user's copies of objects in it stay: Blender has given them other names.
"""

import itertools
import uuid
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..blender import meshes, versions
from ..blender.views import views
from ..common.blocks import Blocks
from . import mask_display, sculpts

MARK = "riffler_live"  # on the collection: the sculpt's mark (sculpts.new_mark); also on meshes and the material
MADE = "riffler_made"  # on the collection and its objects: their original names
NUMBER = "riffler_chunk"  # on a chunk's object
FILLING = "riffler_filling"  # on its mesh: serial number of the filling it shows
TOOL = "Riffler Tool"
SHOWN = "riffler_shown"  # on its object: serial number of its display

_fillings = itertools.count(1)


class Chunks:
    """The chunks of the sculpt `ob`, whose mesh has bricks in a lattice of `shape`. Stores names instead of references,
    which the next undo invalidates."""

    def __init__(self, context, ob, shape, mm_per_unit):
        self._take(ob, shape, mm_per_unit)
        collection = _new_collection(context, ob)
        self._before = _before(collection)
        try:
            first = None  # parent of the others: one row in the outliner, and one object to move
            for block in range(len(self._blocks)):
                chunk = self._add(collection, ob, "Riffler Chunk")
                chunk[NUMBER] = block
                self._names[block] = chunk.name
                if first is None:
                    first = chunk
                else:
                    chunk.parent, chunk.matrix_basis = first, Matrix()
        except Exception:
            sweep(ob.riffler.mark)
            raise
        hide(ob)

    @classmethod
    def found(cls, ob, shape, mm_per_unit):
        """The chunks that an undo has restored."""
        self = cls.__new__(cls)
        self._take(ob, shape, mm_per_unit)
        self._before = _before(collection_of(self._mark))
        self.outline(False)
        return self

    def _take(self, ob, shape, mm_per_unit):
        self._mm, self._mark, self._blocks = mm_per_unit, ob.riffler.mark, Blocks(shape)
        self._names: dict[int, str] = {}  # names of objects, by block
        self._shown = ""
        self.fillings: dict[int, int] = {}  # serial number of the filling that each block shows
        self._materials = [m.name for m in ob.data.materials if m and m.name != mask_display.NAME]
        self._tool, self._tool_at = "", None  # name of the tool's object; its matrix, unless an undo may have moved it

    # ------------------------------------------------------------------ what is shown
    def update(self, mesher, bricks, mask=None, stages=None):
        """Refills the blocks of these bricks; the faces within `mask`, a volume, are shown as protected."""
        solid = set(mesher.patches()) if len(bricks) else ()
        for block in sorted({self._blocks.of(int(b)) for b in bricks}):
            self._fill(block, mesher, [b for b in self._blocks.bricks(block) if b in solid], mask, stages)

    def _fill(self, block, mesher, bricks, mask, stages):
        ob = bpy.data.objects.get(self._names.get(block, ""))
        if ob is None:  # the user removed it, so it stays removed
            return
        vertices, triangles, edges, shading = _patch(mesher, bricks)
        meshes.fill(ob.data, vertices / self._mm, triangles, edges, **shading)
        mask_display.show(ob.data, mask, vertices, triangles)
        self.fillings[block] = next(_fillings)
        ob.data[FILLING] = self.fillings[block]
        if stages:
            size = sum(a.nbytes for a in (vertices, triangles, *edges, *shading.values()))
            stages.count(bricks=len(bricks), chunks=1, triangles=len(triangles), bytes=size)

    def place(self, matrix):
        """Moves all chunks to `matrix`, the sculpt's."""
        collection = collection_of(self._mark)
        for ob in collection.objects if collection is not None else ():  # a search by name takes 4 µs for each
            if ob.parent is None and NUMBER in ob and is_own(ob) and ob.matrix_world != matrix:
                ob.matrix_world = matrix

    def adopt(self, fillings):
        """After an undo: takes over the restored objects, and returns the bricks of those that do not show what
        `fillings` says."""
        self._tool_at = None
        if fillings is None:  # unknown: all of them
            fillings = dict.fromkeys(range(len(self._blocks)), -1)
        found = {ob[NUMBER]: ob for ob in collection_of(self._mark).objects if NUMBER in ob and is_own(ob)}
        self._names = {block: ob.name for block, ob in found.items()}
        self.fillings = {block: ob.data.get(FILLING, 0) for block, ob in found.items()}
        stale = [block for block, filling in fillings.items() if self.fillings.get(block) != filling]
        return [brick for block in stale for brick in self._blocks.bricks(block)]

    def outline(self, on):
        """Switches off the views' outlines, which no undo restores or removes, while chunks are shown."""
        if on:
            _outline(self._before.outlined)
        else:
            _draw_outlines(self._before.outlined, False)

    def give_back(self, name):
        """Restores what `sweep` would have restored, after the user has removed the collection."""
        self.outline(True)
        _reveal(sculpts.marked(self._mark, name), self._before)

    @property
    def there(self):
        """Whether the collection exists; an undo may have removed it."""
        return collection_of(self._mark) is not None

    # ------------------------------------------------------------------ the tool
    def show_tool(self, solid):
        """Shows the tool. `solid`: vertices (mm, tip at the origin, axis z) and triangles."""
        self._shown, self._tool_at = uuid.uuid4().hex, None
        ob = next(iter(self._tools()), None)
        if ob is not None:
            self._tool, ob[SHOWN], ob.hide_viewport = ob.name, self._shown, False
            meshes.fill(ob.data, solid[0] / self._mm, solid[1])
            return
        ob = self._add(collection_of(self._mark), sculpts.marked(self._mark), TOOL)
        ob[SHOWN] = self._shown
        meshes.fill(ob.data, solid[0] / self._mm, solid[1])
        material = bpy.data.materials.new(TOOL)
        material[MARK] = self._mark
        material.diffuse_color = (0.9, 0.45, 0.1, 1.0)
        ob.data.materials.clear()
        ob.data.materials.append(material)
        self._tool = ob.name

    def place_tool(self, pose):
        """Moves the tool to `pose`: (6,) tip and axis, mm in the sculpt's frame."""
        ob, sculpt = bpy.data.objects.get(self._tool), sculpts.marked(self._mark)
        if ob is not None and sculpt is not None:
            turn = Vector((0, 0, 1)).rotation_difference(Vector(pose[3:])).to_matrix().to_4x4()
            matrix = sculpt.matrix_world @ Matrix.Translation(Vector(pose[:3]) / self._mm) @ turn
            if matrix != self._tool_at:  # no redraw while the hand rests
                self._tool_at = ob.matrix_world = matrix

    @property
    def tool_there(self):
        """Whether the tool's object exists; an undo may have removed it."""
        return any(ob.get(SHOWN) == self._shown for ob in self._tools())

    def hide_tool(self):
        """Hides the tool, also one that an undo has restored. It stays in the file until the next tool or the end:
        Blender's undo keeps what is equal in successive steps, so a tool removed between two steps would come back
        without its collection."""
        for ob in self._tools():
            ob.hide_viewport = True

    def _tools(self):
        collection = collection_of(self._mark)
        return [ob for ob in collection.objects if SHOWN in ob and is_own(ob)] if collection is not None else []

    def _add(self, collection, sculpt, name):
        mesh = bpy.data.meshes.new(name)
        mesh[MARK] = self._mark
        for material in self._materials:
            mesh.materials.append(bpy.data.materials.get(material))
        ob = bpy.data.objects.new(name, mesh)
        ob[MADE] = ob.name
        ob.matrix_world = sculpt.matrix_world
        ob.hide_render = True  # the sculpt is rendered instead
        collection.objects.link(ob)
        for space in _local_views():
            ob.local_view_set(space, True)
        return ob


def _patch(mesher, bricks):
    """Vertices, triangles, edges and shading of a chunk, in the form of meshes.fill."""
    if versions.OWN_NORMALS:
        patch = mesher.patch(bricks, edges=True, normals=meshes.SHARP_ANGLE)
        return *_arrays(patch), {"normals": patch.normals}
    if not versions.SMOOTH_BY_POLYGON:
        return *_arrays(mesher.patch(bricks, edges=True)), {}
    # Triangles at a sharp edge are shaded flat: the mean normals of their corners deviate from the triangle's normal by
    # half of the edge's angle.
    patch = mesher.patch(bricks, edges=True, normals=np.pi)
    corners = patch.vertices[patch.triangles]
    (a, b, c), (d, e, f) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    own = np.stack([b * f - c * e, c * d - a * f, a * e - b * d], axis=1)  # np.cross takes three times as long
    least = np.cos(0.5 * meshes.SHARP_ANGLE) * np.sqrt(np.einsum("fc,fc->f", own, own))
    leaning = np.einsum("fkc,fc->fk", patch.normals.reshape(-1, 3, 3), own).min(axis=1)
    return *_arrays(patch), {"smooth": leaning >= least}


def _arrays(patch):
    return patch.vertices, patch.triangles, [patch.edges, patch.corner_edges]


def _new_collection(context, ob):
    collection = bpy.data.collections.new("Riffler Live")
    collection[MARK], collection[MADE] = ob.riffler.mark, collection.name
    collection["hidden"], collection["selected"] = ob.hide_get(), ob.select_get()
    collection["selectable"] = not ob.hide_select
    collection["scene"], collection["layer"] = context.scene.name, context.view_layer.name
    # Views that outline every object would outline every chunk. The setting is stored here so that it can be restored
    # even after a crash.
    outlined = [f"{screen}/{k}" for screen, k, space in views() if space.shading.show_object_outline]
    collection["outlined"] = "\n".join(outlined)
    collection.hide_select = True
    context.scene.collection.children.link(collection)
    _draw_outlines(outlined, False)
    return collection


def hide(ob):
    """Hides the sculpt's own mesh, and lightens it where undo would read it each time. The object stays visible to
    Blender, but is displayed only by its instances, of which it has none. (A view does not treat a hidden object as the
    active one, so its menu of modes would be empty.) An object with children or instances is hidden by its eye icon."""
    versions.lighten(ob.data)
    ob.select_set(False)
    if ob.hide_get():
        return
    if ob.children or ob.instance_type != "NONE":
        ob.hide_set(True)
        return
    ob.instance_type, ob.show_instancer_for_viewport, ob.hide_select = "VERTS", False, True


def is_hidden(ob):
    """Whether `hide` has hidden it, so that only its instances would be drawn."""
    return ob.instance_type == "VERTS" and not ob.show_instancer_for_viewport


def reveal(ob, select=False, layers=None, selectable=True):
    """Undoes `hide`, in these view layers, or in every one. `selectable`: the previous setting."""
    if is_hidden(ob):
        ob.instance_type, ob.show_instancer_for_viewport, ob.hide_select = "NONE", True, not selectable
    if layers is None:
        layers = [layer for scene in bpy.data.scenes for layer in scene.view_layers]
    for layer in layers:
        if ob.name in layer.objects:
            ob.hide_set(False, view_layer=layer)
            if select:
                ob.select_set(True, view_layer=layer)


@dataclass
class Before:
    """The state before the chunks: whether the sculpt was hidden and selected in that view layer, and which views drew
    outlines."""

    hidden: bool
    selected: bool
    selectable: bool
    layer: tuple  # names of scene and view layer
    outlined: list


def _before(collection):
    """The state stored on a collection of chunks; older add-ons did not store the layer."""
    layer = collection.get("scene", ""), collection.get("layer", "")
    selectable = bool(collection.get("selectable", True))
    return Before(collection["hidden"], collection["selected"], selectable, layer, collection["outlined"].split("\n"))


def _reveal(ob, before):
    if ob is None or before.hidden:
        return
    scene = bpy.data.scenes.get(before.layer[0])
    layer = scene and scene.view_layers.get(before.layer[1])
    reveal(ob, before.selected, None if layer is None else [layer], before.selectable)


def _outline(places):
    """Restores the views' outlines, unless another sculpt is shown in chunks; they are then restored after that one."""
    other = next((c for c in bpy.data.collections if MARK in c), None)
    if other is not None:
        other["outlined"] = "\n".join([other["outlined"], *places])
        return
    _draw_outlines(places, True)


def _draw_outlines(places, on):
    for screen, k, space in views():
        if f"{screen}/{k}" in places:
            space.shading.show_object_outline = on


def weigh(ob):
    """Undoes versions.lighten, unless the mesh was refilled since."""
    if sculpts.is_sculpt(ob) and not ob.data.polygons and ob.data.vertices:
        sculpts.refill(ob.data, sculpts.shown_mm_per_unit(ob.data))


def collection_of(mark):
    """The collection of the sculpt of that mark, or None."""
    return next((c for c in bpy.data.collections if c.get(MARK) == mark), None)


def shown():
    """Marks of the sculpts shown in chunks."""
    return [c[MARK] for c in bpy.data.collections if MARK in c]


def _local_views():
    """The local views in windows. Blender crashes if an object is put into the local view of a screen without a
    window."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D" and area.spaces.active.local_view and window.scene == bpy.context.scene:
                yield area.spaces.active


def sweep(mark=None, name=""):
    """Removes the chunks of the sculpt of that mark (and name, if known) or of all sculpts, and shows the sculpts
    again."""
    for collection in [c for c in bpy.data.collections if MARK in c and mark in (None, c[MARK])]:
        ob, before = sculpts.marked(collection[MARK], name), _before(collection)
        try:
            weigh(ob)
        except ValueError as error:  # the packed data cannot be read: there is no surface to show
            print(f"Riffler: {error}")
        _clear(collection)
        _reveal(ob, before)
        _outline(before.outlined)
    stray = [ob for ob in bpy.data.objects if is_own(ob) and ob.data is not None and _is_marked(ob.data, mark)]
    _remove(stray)  # moved out of the collection by the user, or by an undo
    for place in (bpy.data.meshes, bpy.data.materials):
        marked = [thing for thing in place if _is_marked(thing, mark)]
        for thing in (thing for thing in marked if thing.users):
            del thing[MARK]  # a copy uses it: it belongs to the user now
        bpy.data.batch_remove([thing for thing in marked if not thing.users])


def _is_marked(thing, mark):
    return MARK in thing and mark in (None, thing[MARK])


def is_own(thing):
    """True if the add-on made the object or the collection itself, and it is not the user's copy."""
    return thing.get(MADE) == thing.name


def _clear(collection):
    """Removes the collection and the add-on's objects in it. In a copied collection, as in a copied scene, all marked
    objects are the add-on's."""
    pictures = [ob for ob in collection.objects if ob.data is not None and MARK in ob.data]
    if is_own(collection):
        pictures = [ob for ob in pictures if is_own(ob)]
    _remove(pictures)
    for ob in list(collection.objects):  # added by the user
        collection.objects.unlink(ob)
        if not ob.users_collection:
            bpy.context.scene.collection.objects.link(ob)
    bpy.data.collections.remove(collection)


def _remove(pictures):
    """Removes the objects. Their children, such as a copy of one of them, keep their place."""
    gone = set(pictures)
    left = [(ob, ob.matrix_world.copy()) for ob in bpy.data.objects if ob.parent in gone and ob not in gone]
    bpy.data.batch_remove(gone)
    for ob, matrix in left:
        ob.matrix_world = matrix
