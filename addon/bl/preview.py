"""What is seen of a sculpt while a pen is at it: one object for each brick of its mesh, and the tool.

Filling one mesh of half a million triangles takes a tenth of a second; a brick takes what its own triangles take. The
sculpt itself is hidden meanwhile, and not touched. Everything is in one collection that says which sculpt it stands
for, so that what is left of one, in an undo step or in a file of a Blender that crashed, is known and swept away.
"""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import meshes

MARK = "riffler_preview"  # on the collection: the sculpt's name
TOOL = "Riffler Tool"


class Preview:
    """Of the sculpt `ob`, whose volume `mesher` meshes. Keeps names: references die with an undo."""

    def __init__(self, context, ob, mesher, mm_per_unit, tool):
        """`tool`: vertices and triangles, mm, its tip in the origin and its axis z."""
        self._mesher, self._mm, self._mesh = mesher, mm_per_unit, ob.data.name
        self._bricks = {}  # number → the object's name
        collection = bpy.data.collections.new("Riffler Pen")
        collection[MARK] = ob.name
        collection["hidden"], collection["selected"] = ob.hide_get(), ob.select_get()
        collection.hide_select = True
        context.scene.collection.children.link(collection)
        self._collection = collection.name
        self._matrix = ob.matrix_world.copy()
        try:
            self._tool = self._add(TOOL, *tool)
            material = bpy.data.materials.new(TOOL)
            material.diffuse_color = (0.9, 0.45, 0.1, 1.0)
            bpy.data.objects[self._tool].data.materials.append(material)
            self.update(mesher.patches(), ob.matrix_world)
        except Exception:
            sweep()
            raise
        ob.hide_set(True)  # deselects it, too
        self._outlined = []  # views that drew a line around every object: around every brick, that is
        for screen, k, space in views():
            if space.shading.show_object_outline:
                self._outlined.append((screen, k))
                space.shading.show_object_outline = False

    def remove(self):
        for screen, k, space in views():
            if (screen, k) in self._outlined:
                space.shading.show_object_outline = True
        sweep()

    def update(self, bricks, matrix):
        """Shows these bricks anew, and all of them at `matrix`, the sculpt's."""
        for brick in bricks:
            vertices, triangles = self._mesher.patch(brick)
            ob = bpy.data.objects.get(self._bricks.get(brick, ""))
            if ob is not None:
                meshes.fill(ob.data, vertices / self._mm, triangles)
            elif len(triangles):
                self._bricks[brick] = self._add(f"Riffler Brick {brick}", vertices, triangles, of_sculpt=True)
        if matrix != self._matrix:
            self._matrix = matrix.copy()
            for name in self._bricks.values():
                if ob := bpy.data.objects.get(name):
                    ob.matrix_world = matrix

    def place_tool(self, pose):
        """`pose`: (6,) tip and axis, mm in the sculpt's frame."""
        ob = bpy.data.objects.get(self._tool)
        if ob is not None:
            turn = Vector((0, 0, 1)).rotation_difference(Vector(pose[3:]))
            ob.matrix_world = self._matrix @ Matrix.Translation(Vector(pose[:3]) / self._mm) @ turn.to_matrix().to_4x4()

    def _add(self, name, vertices, triangles, of_sculpt=False):
        mesh = bpy.data.meshes.new(name)
        if of_sculpt:
            for material in bpy.data.meshes[self._mesh].materials:
                mesh.materials.append(material)
        meshes.fill(mesh, np.asarray(vertices) / self._mm, triangles)
        ob = bpy.data.objects.new(name, mesh)
        ob.matrix_world = self._matrix
        bpy.data.collections[self._collection].objects.link(ob)
        for _, _, space in views():
            if space.local_view:
                ob.local_view_set(space, True)
        return ob.name


def views():
    """Every 3D view: name of its screen, number of its area, space."""
    for screen in bpy.data.screens:
        for k, area in enumerate(screen.areas):
            if area.type == "VIEW_3D":
                yield screen.name, k, area.spaces.active


def sweep():
    """Takes away every preview that there is, and shows its sculpt again."""
    for collection in [c for c in bpy.data.collections if MARK in c]:
        name, hidden, selected = collection[MARK], collection["hidden"], collection["selected"]
        things = [ob.data for ob in collection.objects if ob.type == "MESH"]
        bpy.data.batch_remove([*collection.objects, *things])
        bpy.data.collections.remove(collection)
        for material in [m for m in bpy.data.materials if m.name.startswith(TOOL) and m.users == 0]:
            bpy.data.materials.remove(material)
        for scene in bpy.data.scenes:
            for layer in scene.view_layers:
                if not hidden and name in layer.objects:
                    layer.objects[name].hide_set(False, view_layer=layer)
                    if selected:
                        layer.objects[name].select_set(True, view_layer=layer)
