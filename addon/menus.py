"""Entries in Blender's own menus, with the panels' settings."""

import bpy

from .blender.panel_parts import give
from .plan import properties as plan_properties
from .plan.operators import find, from_strokes, least_tilt, setup
from .sculpt import first_stroke, persistence
from .stock import clay, cut, export, import_cad, new_stock, protection, recover, result, solid
from .stock import properties as stock_properties


class RIFFLER_MT_object(bpy.types.Menu):
    """Riffler's operators on the active object"""

    bl_idname = "RIFFLER_MT_object"
    bl_label = "Riffler"

    def draw(self, context):
        layout, settings = self.layout, context.scene.riffler
        layout.operator(first_stroke.RIFFLER_OT_make_sculpt.bl_idname, text="Make Sculpt", icon="SCULPTMODE_HLT")
        op = layout.operator(new_stock.RIFFLER_OT_new_stock.bl_idname, text="Stock from Object", icon="MESH_DATA")
        give(op, settings.stock, stock_properties.StockSettings)
        op.source = "OBJECT"
        op = layout.operator(cut.RIFFLER_OT_cut_curve.bl_idname, icon="CURVE_DATA")
        give(op, settings.cut, stock_properties.CutSettings)
        op.curve = settings.cut.curve.name if settings.cut.curve else ""
        layout.separator()
        for cls in (clay.RIFFLER_OT_split, clay.RIFFLER_OT_take_edits, new_stock.RIFFLER_OT_rebuild):
            layout.operator(cls.bl_idname)
        layout.separator()
        for cls in (
            protection.RIFFLER_OT_mask_form,
            protection.RIFFLER_OT_mask_invert,
            protection.RIFFLER_OT_mask_clear,
        ):
            layout.operator(cls.bl_idname)
        layout.separator()
        give(layout.operator(result.RIFFLER_OT_to_mesh.bl_idname), settings.result, stock_properties.ResultSettings)
        layout.operator(result.RIFFLER_OT_show_deviation.bl_idname)
        layout.operator(result.RIFFLER_OT_hide_deviation.bl_idname)
        layout.operator(import_cad.RIFFLER_OT_retessellate.bl_idname)
        layout.separator()
        layout.operator(setup.RIFFLER_OT_plan_part.bl_idname)
        layout.operator(setup.RIFFLER_OT_plan_fixtures_add.bl_idname)
        give(layout.operator(find.RIFFLER_OT_plan_find.bl_idname), settings.plan, plan_properties.FindSettings)
        layout.operator(from_strokes.RIFFLER_OT_plan_from_strokes.bl_idname)
        layout.operator_menu_enum(least_tilt.RIFFLER_OT_plan_least_tilt.bl_idname, "paths")
        if persistence.crashed():
            layout.separator()
            layout.operator(recover.RIFFLER_OT_recover.bl_idname)


def _object(self, context):
    self.layout.separator()
    self.layout.menu(RIFFLER_MT_object.bl_idname)


class RIFFLER_MT_add(bpy.types.Menu):
    """Solids to sculpt"""

    bl_idname = "RIFFLER_MT_add"
    bl_label = "Riffler"

    def draw(self, context):
        layout = self.layout
        for shape, label, _, icon, _ in solid.SHAPES:
            layout.operator(solid.RIFFLER_OT_add_solid.bl_idname, text=label, icon=icon).shape = shape
        layout.separator()
        op = layout.operator(new_stock.RIFFLER_OT_new_stock.bl_idname, text="Stock in mm", icon="MESH_CUBE")
        give(op, context.scene.riffler.stock, stock_properties.StockSettings)
        op.source = "BLOCK"


def _add(self, context):
    self.layout.separator()
    self.layout.menu(RIFFLER_MT_add.bl_idname, icon="SCULPTMODE_HLT")


def _export(self, context):
    layout = self.layout
    layout.operator(export.RIFFLER_OT_export_stl.bl_idname, text="Riffler STL (.stl)")
    layout.operator(export.RIFFLER_OT_export_3mf.bl_idname, text="Riffler 3MF (.3mf)")
    op = layout.operator(export.RIFFLER_OT_export_nc.bl_idname, text="Riffler NC Code (.ngc)")
    give(op, context.scene.riffler.nc, stock_properties.NcSettings)


def _import(self, context):
    self.layout.operator(import_cad.RIFFLER_OT_import_cad.bl_idname, text="Riffler CAD (.step/.iges/.brep)")


PLACES = (
    ("VIEW3D_MT_mesh_add", _add),
    ("VIEW3D_MT_object", _object),
    ("VIEW3D_MT_object_context_menu", _object),
    ("TOPBAR_MT_file_import", _import),
    ("TOPBAR_MT_file_export", _export),
)
CLASSES = (RIFFLER_MT_object, RIFFLER_MT_add)
_drawn = []  # those of PLACES that this Blender has


def attach():
    for name, draw in PLACES:
        getattr(bpy.types, name).append(draw)
        _drawn.append((name, draw))


def detach():
    while _drawn:
        name, draw = _drawn.pop()
        getattr(bpy.types, name).remove(draw)
