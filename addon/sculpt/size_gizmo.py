"""Handles of the sculpt tool's cutter, next to the sculpt: one for its radius, or half the width of a hand tool, and
one for the depth of strokes."""

import bpy
from mathutils import Matrix, Vector

from . import brushes, pointer, sculpts

COLOUR, STRONG = (1.0, 0.55, 0.2), (1.0, 0.8, 0.5)
# share of the stock's length: distance from it to the centre of the handles, which does not move while they are dragged
ASIDE = 0.3


class RIFFLER_GGT_size(bpy.types.GizmoGroup):
    bl_idname = "RIFFLER_GGT_size"
    bl_label = "Size of the Cutter"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D"}

    @classmethod
    def poll(cls, context):
        return sculpts.active(context) is not None and context.mode == "OBJECT" and pointer.held is None

    def setup(self, context):
        self._ring = self.gizmos.new("GIZMO_GT_dial_3d")
        self._ring.hide_select = True
        self._ring.use_draw_scale = False
        self._radius = self._arrow("radius")
        self._depth = self._arrow("depth")
        for gizmo in (self._ring, self._radius, self._depth):
            gizmo.color, gizmo.alpha = COLOUR, 0.7
            gizmo.color_highlight, gizmo.alpha_highlight = STRONG, 1.0
        self.draw_prepare(context)

    def draw_prepare(self, context):
        ob = sculpts.active(context)
        if ob is None:
            return
        middle, unit = _place(ob)
        for gizmo in (self._ring, self._radius, self._depth):
            gizmo.hide = unit == 0  # scaled to zero
        turn = ob.matrix_world.to_quaternion().to_matrix().to_4x4()
        # Without the view's scale, Blender ignores scale_basis, too.
        self._ring.matrix_basis = Matrix.Translation(middle) @ turn @ Matrix.Scale(_size("radius") * unit, 4)
        # An arrow points along its z: along the stock's x for the radius, down for the depth.
        for gizmo, way in ((self._radius, (1, 0, 0)), (self._depth, (0, 0, -1))):
            lean = Vector((0, 0, 1)).rotation_difference(Vector(way)).to_matrix().to_4x4()
            gizmo.matrix_basis = Matrix.Translation(middle) @ turn @ lean

    def _arrow(self, field):
        """A handle of a field of the scene's settings, in mm; the gizmo counts in Blender units."""
        gizmo = self.gizmos.new("GIZMO_GT_arrow_3d")
        gizmo.use_draw_offset_scale = False
        gizmo.length = 0.35

        def get():
            return _size(field) * _unit()

        def put(offset):
            size, settings = max(offset, 0.0) / (_unit() or 1.0), bpy.context.scene.riffler.sculpt
            if field == "radius" and _has_width():
                settings.width = 2 * size
            else:
                setattr(settings, field, size)

        gizmo.target_set_handler("offset", get=get, set=put)
        return gizmo


def _has_width():
    brush = brushes.active(bpy.context)
    return brush is not None and brush.hand


def _size(field):
    settings = bpy.context.scene.riffler.sculpt
    return 0.5 * settings.width if field == "radius" and _has_width() else getattr(settings, field)


def _unit():
    """Blender units in the world for a millimetre of the active sculpt. Computed each time: the scene's units may
    change while the handles are shown."""
    ob = sculpts.active(bpy.context)
    return _place(ob)[1] if ob is not None else 1.0


def _place(ob):
    """Next to the middle of the stock's top (world), and Blender units in the world for a mm of the sculpt."""
    p, mm = ob.data.riffler, sculpts.shown_mm_per_unit(ob.data)
    aside = p.upper[0] + ASIDE * (p.upper[0] - p.lower[0])
    at = Vector((aside, 0.5 * (p.lower[1] + p.upper[1]), p.upper[2])) / mm
    return ob.matrix_world @ at, abs(ob.matrix_world.to_3x3().determinant()) ** (1 / 3) / mm


CLASSES = (RIFFLER_GGT_size,)
