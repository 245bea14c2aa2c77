"""Entries in Blender's own menus, with the settings that the panels show."""

import bpy

from .. import properties
from ..operators import (
    begin,
    clay,
    cut,
    export,
    mask,
    plan_find,
    plan_least_tilt,
    plan_setup,
    recover,
    result,
    solid,
    stock,
)
from .panel_parts import give


class RIFFLER_MT_object(bpy.types.Menu):
    """What can be done with the active object"""

    bl_idname = "RIFFLER_MT_object"
    bl_label = "Riffler"

    def draw(self, context):
        layout, settings = self.layout, context.scene.riffler
        layout.operator(begin.RIFFLER_OT_make_sculpt.bl_idname, text="Make Sculpt", icon="SCULPTMODE_HLT")
        op = layout.operator(stock.RIFFLER_OT_new_stock.bl_idname, text="Stock from Object", icon="MESH_DATA")
        give(op, settings.stock, properties.StockSettings)
        op.source = "OBJECT"
        op = layout.operator(cut.RIFFLER_OT_cut_curve.bl_idname, icon="CURVE_DATA")
        give(op, settings.cut, properties.CutSettings)
        op.curve = settings.cut.curve.name if settings.cut.curve else ""
        layout.separator()
        for cls in (clay.RIFFLER_OT_split, clay.RIFFLER_OT_take_edits, stock.RIFFLER_OT_rebuild):
            layout.operator(cls.bl_idname)
        layout.separator()
        for cls in (mask.RIFFLER_OT_mask_form, mask.RIFFLER_OT_mask_invert, mask.RIFFLER_OT_mask_clear):
            layout.operator(cls.bl_idname)
        layout.separator()
        give(layout.operator(result.RIFFLER_OT_to_mesh.bl_idname), settings.result, properties.ResultSettings)
        layout.operator(result.RIFFLER_OT_show_deviation.bl_idname)
        layout.operator(result.RIFFLER_OT_hide_deviation.bl_idname)
        layout.separator()
        layout.operator(plan_setup.RIFFLER_OT_plan_part.bl_idname)
        layout.operator(plan_setup.RIFFLER_OT_plan_fixtures_add.bl_idname)
        give(layout.operator(plan_find.RIFFLER_OT_plan_find.bl_idname), settings.plan, properties.FindSettings)
        layout.operator_menu_enum(plan_least_tilt.RIFFLER_OT_plan_least_tilt.bl_idname, "paths")
        if recover.keeping.crashed():
            layout.separator()
            layout.operator(recover.RIFFLER_OT_recover.bl_idname)


def _object(self, context):
    self.layout.separator()
    self.layout.menu(RIFFLER_MT_object.bl_idname)


class RIFFLER_MT_add(bpy.types.Menu):
    """Solids to be sculpted"""

    bl_idname = "RIFFLER_MT_add"
    bl_label = "Riffler"

    def draw(self, context):
        layout = self.layout
        for shape, label, _, icon, _ in solid.SHAPES:
            layout.operator(solid.RIFFLER_OT_add_solid.bl_idname, text=label, icon=icon).shape = shape
        layout.separator()
        op = layout.operator(stock.RIFFLER_OT_new_stock.bl_idname, text="Stock in mm", icon="MESH_CUBE")
        give(op, context.scene.riffler.stock, properties.StockSettings)
        op.source = "BLOCK"


def _add(self, context):
    self.layout.separator()
    self.layout.menu(RIFFLER_MT_add.bl_idname, icon="SCULPTMODE_HLT")


def _export(self, context):
    layout = self.layout
    layout.operator(export.RIFFLER_OT_export_stl.bl_idname, text="Riffler STL (.stl)")
    layout.operator(export.RIFFLER_OT_export_3mf.bl_idname, text="Riffler 3MF (.3mf)")
    op = layout.operator(export.RIFFLER_OT_export_nc.bl_idname, text="Riffler NC Code (.ngc)")
    give(op, context.scene.riffler.nc, properties.NcSettings)


PLACES = (
    ("VIEW3D_MT_mesh_add", _add),
    ("VIEW3D_MT_object", _object),
    ("VIEW3D_MT_object_context_menu", _object),
    ("TOPBAR_MT_file_export", _export),
)
CLASSES = (RIFFLER_MT_object, RIFFLER_MT_add)
_drawn = []  # those of PLACES that Blender has


def attach():
    for name, draw in PLACES:
        getattr(bpy.types, name).append(draw)
        _drawn.append((name, draw))


def detach():
    while _drawn:
        name, draw = _drawn.pop()
        getattr(bpy.types, name).remove(draw)
