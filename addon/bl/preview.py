"""What is seen of a sculpt while a pen is at it: one object for each brick of its mesh, and the tool.

Filling one mesh of half a million triangles takes a tenth of a second; a brick takes what its own triangles take. The
sculpt itself is hidden meanwhile, and not touched. Everything is in one collection that says which sculpt it stands
for, so that what is left of one, in an undo step or in a file of a Blender that crashed, is known and swept away.
"""

import bpy
from mathutils import Matrix, Vector

from . import meshes

MARK = "riffler_preview"  # on the collection: the sculpt's name; on meshes and the material, too
TOOL = "Riffler Tool"
SPARE = 32  # bricks made at once: with each new object Blender sorts out anew what depends on what, 0.4 s for 1300


class Preview:
    """Of the sculpt `ob`, whose volume `mesher` meshes. It has to go before an undo, with which references die."""

    def __init__(self, context, ob, mesher, mm_per_unit, tool):
        """`tool`: vertices and triangles, mm, its tip in the origin and its axis z."""
        self._mesher, self._mm = mesher, mm_per_unit
        self._materials = list(ob.data.materials)
        self.bricks, self._spare = {}, []  # number → object; objects that show nothing yet
        collection = bpy.data.collections.new("Riffler Pen")
        collection[MARK] = ob.name
        collection["hidden"], collection["selected"] = ob.hide_get(), ob.select_get()
        collection.hide_select = True
        context.scene.collection.children.link(collection)
        self._collection = collection
        self._matrix = ob.matrix_world.copy()
        try:
            self._tool = self._add(TOOL)
            meshes.fill(self._tool.data, tool[0] / mm_per_unit, tool[1])
            material = bpy.data.materials.new(TOOL)
            material[MARK] = ob.name
            material.diffuse_color = (0.9, 0.45, 0.1, 1.0)
            self._tool.data.materials.append(material)
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
            if brick in self.bricks or len(triangles):
                ob = self.bricks.get(brick)
                if not alive(ob):
                    ob = self.bricks[brick] = self._new_brick()
                meshes.fill(ob.data, vertices / self._mm, triangles)
        if matrix != self._matrix:
            self._matrix = matrix.copy()
            for ob in (*self.bricks.values(), *self._spare):
                if alive(ob):
                    ob.matrix_world = matrix

    def place_tool(self, pose):
        """`pose`: (6,) tip and axis, mm in the sculpt's frame."""
        if alive(self._tool):
            turn = Vector((0, 0, 1)).rotation_difference(Vector(pose[3:])).to_matrix().to_4x4()
            self._tool.matrix_world = self._matrix @ Matrix.Translation(Vector(pose[:3]) / self._mm) @ turn

    def _new_brick(self):
        self._spare = [ob for ob in self._spare if alive(ob)]
        if not self._spare:
            self._spare = [self._add("Riffler Brick", self._materials) for _ in range(SPARE)]
        return self._spare.pop()

    def _add(self, name, materials=()):
        mesh = bpy.data.meshes.new(name)
        mesh[MARK] = self._collection[MARK]
        for material in materials:
            mesh.materials.append(material)
        ob = bpy.data.objects.new(name, mesh)
        ob.matrix_world = self._matrix
        self._collection.objects.link(ob)
        for _, _, space in views():
            if space.local_view:
                ob.local_view_set(space, True)
        return ob


def alive(ob):
    """False for None and for what somebody has removed."""
    try:
        return ob is not None and bool(ob.name)
    except ReferenceError:
        return False


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
        bpy.data.batch_remove(collection.objects)
        bpy.data.collections.remove(collection)
        for scene in bpy.data.scenes:
            for layer in scene.view_layers:
                if not hidden and name in layer.objects:
                    layer.objects[name].hide_set(False, view_layer=layer)
                    if selected:
                        layer.objects[name].select_set(True, view_layer=layer)
    for place in (bpy.data.meshes, bpy.data.materials):
        bpy.data.batch_remove([thing for thing in place if MARK in thing])
