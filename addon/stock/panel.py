"""The sidebar's tab: the active sculpt, new stock, cuts and exports. Drawing reads properties only: no volume is
touched."""

import bpy

from ..blender import object_surfaces, refusals, scene_units
from ..blender.panel_parts import Sidebar, at_work, give, lines, wrapped
from ..common import fitting, units
from ..sculpt import first_stroke, live_registry, mesh_edits, sculpts
from ..translations import CONTEXT, local
from . import clay, cut, detail, export, millimetres, new_stock, properties
from .pure import estimate

FLAT = "The object is scaled to nothing: use Object > Clear > Scale."
SCALED = "The object is scaled or mirrored: its millimetres are not the scene's."


class RIFFLER_PT_sculpt(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_sculpt"
    bl_label = "Sculpt"
    bl_order = 1

    def draw(self, context):
        layout = self.layout
        ob = sculpts.active(context)
        if ob is None:
            lines(layout, *wrapped(context, "No sculpt is active. Make one below."), icon="INFO")
            if object_surfaces.source_object(context) is not None:
                layout.operator(
                    first_stroke.RIFFLER_OT_make_sculpt.bl_idname, text="Make Sculpt", icon="SCULPTMODE_HLT"
                )
            return
        self._facts(layout, ob)
        self._warnings(layout, context, ob)

    def _facts(self, layout, ob):
        p = ob.data.riffler
        size = [u - low for low, u in zip(p.lower, p.upper, strict=True)]
        row = layout.row()
        row.label(text=ob.name, icon="MOD_SOLIDIFY", translate=False)
        detail.choose(row, ob)
        run = live_registry.of(ob)
        facts = p if run is None else run.facts
        rays = "tri-dexel" if p.directions == "xyz" else f"rays along {p.directions}"
        lines(
            layout,
            f"Size: {units.format_size(size)}",
            f"Pitch: {units.trim(p.pitch, 4)} mm, {rays}",
            f"Material: {units.format_volume(facts.material)}",
            f"Cuts: {facts.cuts} ({units.counted(facts.moves, 'move')})",
            f"Memory: {units.format_bytes(facts.nbytes)}",
        )
        if why := detail.all_for(ob):
            layout.label(text=f"{local('Triangles')}: {local(why)}", icon="INFO", translate=False)

    def _warnings(self, layout, context, ob):
        mesh = ob.data
        if live_registry.of(ob) is not None:
            return  # its mesh is hidden, and the session continues from the volume
        stale = sculpts.shown_mm_per_unit(mesh) != scene_units.mm_per_unit(context.scene)
        edited = mesh_edits.noticed(ob)
        told = ""
        if stale:
            told = "The scene's units have changed; the mesh shows another size."
        elif edited:
            told = "The mesh was edited in Blender's own modes. Apply or discard the edits:"
        if told:
            lines(layout, *wrapped(context, told), icon="ERROR")
        if edited and not stale:
            layout.operator(clay.RIFFLER_OT_take_edits.bl_idname, icon="CHECKMARK")
        if told:
            layout.operator(new_stock.RIFFLER_OT_rebuild.bl_idname, icon="FILE_REFRESH")
        if refusals.flat(ob):
            lines(layout, *wrapped(context, FLAT), icon="ERROR")
        elif refusals.scaled(ob):
            lines(layout, *wrapped(context, SCALED), icon="ERROR")


class RIFFLER_PT_stock(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_stock"
    bl_label = "New Stock (mm)"
    bl_order = 5

    def draw(self, context):
        layout = self.layout
        settings = context.scene.riffler.stock
        layout.row().prop(settings, "source", expand=True)
        size = self._size(layout, context, settings)
        layout.use_property_split = True
        layout.use_property_decorate = False
        if settings.source == "RECORDING":
            self._button(layout, context, settings)
            return
        row = layout.row(align=True)
        row.prop(settings, "pitch", text="Pitch", text_ctxt=CONTEXT)
        row.operator(new_stock.RIFFLER_OT_fit_pitch.bl_idname, text="", icon="SHADERFX")
        layout.prop(settings, "directions")
        if settings.source == "BLOCK":
            layout.prop(settings, "origin")
        if settings.source == "OBJECT":
            layout.prop(settings, "rounded")
        if size and min(size) > 0:
            rays = estimate.ray_count(size, units.clean(settings.pitch), settings.directions)
            about = units.format_bytes(rays * estimate.BYTES_PER_RAY)
            many = rays > estimate.MANY_RAYS
            layout.label(text=f"{units.counted(rays, 'ray')}, about {about}", icon="ERROR" if many else "NONE")
            self._suits(layout, context, settings, size)
        self._button(layout, context, settings)
        unit = scene_units.mm_per_unit(context.scene)
        if unit != 1:
            layout.separator()
            lines(layout, f"1 unit = {units.trim(unit, 4)} mm", icon="INFO")
            layout.operator(millimetres.RIFFLER_OT_millimetres.bl_idname)

    def _suits(self, layout, context, settings, size):
        """Warns of a block with only a few rays, and of a cutter as large as the stock; one button fixes both."""
        longest = max(size)
        across = round(longest / units.clean(settings.pitch))
        told = [f"Longest side {units.trim(longest, 3)} mm:"]
        if across < fitting.FEW_RAYS:
            told.append(f"only {across} rays, so no details.")
        diameter = context.scene.riffler.tool.diameter
        if diameter > fitting.SUITS[1] * longest:
            told.append(f"the cutter is large, {units.trim(diameter, 3)} mm.")
        if len(told) == 1:
            return
        lines(layout, *told, icon="ERROR")
        if settings.source == "OBJECT":
            layout.operator(
                first_stroke.RIFFLER_OT_make_sculpt.bl_idname, text="Fit Size, Pitch, Cutter…", icon="SHADERFX"
            )

    def _size(self, layout, context, settings):
        if settings.source == "BLOCK":
            column = layout.column(align=True)
            column.label(text="Size")
            column.prop(settings, "size", text="")  # one below the other: sizes of 100 000 mm fit a narrow sidebar
            return [units.clean(s) for s in settings.size]
        if settings.source == "RECORDING":
            layout.prop(settings, "recording", text="")
            return None
        source = object_surfaces.source_object(context)
        if source is None:
            lines(layout, "Select an object.", icon="INFO")
            return None
        size = new_stock.source_size(source, context.scene)
        lines(layout, source.name, units.format_size(size), icon="OBJECT_DATA")
        return size

    def _button(self, layout, context, settings):
        if at_work(layout, context, new_stock.RIFFLER_OT_new_stock):
            return
        op = layout.operator(new_stock.RIFFLER_OT_new_stock.bl_idname, icon="CUBE")
        give(op, settings, properties.StockSettings)


class RIFFLER_PT_cut(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_cut"
    bl_label = "Cut (mm)"
    bl_order = 9

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.riffler.cut
        layout.prop(settings, "curve")
        layout.prop(settings, "axis")
        column = layout.column(align=True)
        column.prop(settings, "depth")
        column.prop(settings, "tolerance")
        layout.prop(settings, "follow")
        if at_work(layout, context, cut.RIFFLER_OT_cut_curve, cut.RIFFLER_OT_cut_recording):
            return
        op = layout.operator(cut.RIFFLER_OT_cut_curve.bl_idname, icon="CURVE_DATA")
        op.curve = settings.curve.name if settings.curve else ""
        give(op, settings, properties.CutSettings)
        layout.operator(cut.RIFFLER_OT_cut_recording.bl_idname, text="Cut Recording…", icon="REC")


class RIFFLER_PT_export(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_export"
    bl_label = "Export"
    bl_order = 10

    def draw(self, context):
        layout = self.layout
        if at_work(layout, context, export.RIFFLER_OT_export_stl):
            return
        row = layout.row(align=True)
        row.operator(export.RIFFLER_OT_export_stl.bl_idname, text="STL…", icon="EXPORT")
        row.operator(export.RIFFLER_OT_export_3mf.bl_idname, text="3MF…")
        layout.separator()
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.riffler.nc
        column = layout.column(align=True)
        column.prop(settings, "post")
        column.prop(settings, "feed")
        column.prop(settings, "spindle")
        op = layout.operator(export.RIFFLER_OT_export_nc.bl_idname, text="Write NC…", icon="TEXT")
        give(op, settings, properties.NcSettings)
        layout.separator()
        layout.operator(export.RIFFLER_OT_export_recording.bl_idname, text="Save Recording…", icon="REC")


CLASSES = (RIFFLER_PT_sculpt, RIFFLER_PT_stock, RIFFLER_PT_cut, RIFFLER_PT_export)
