"""The first stroke on an object that is not a sculpt yet: the drag is recorded, and after it Riffler asks whether to
make the object a sculpt. Without this Blender would move the object."""

import json
import textwrap
import time

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..blender import meshes, object_surfaces, operator_parts, refusals
from ..common import fitting, units
from ..translations import local
from . import chunks, fit, mesh_edits, sculpt_work, sculpts
from .stroke_operator import MODES, MOVES, sample

WIDE = 70  # characters per line of a popup
NOTHING = "Nothing to sculpt here: drag on a mesh, or add a block, sphere or cylinder by Add > Mesh > Riffler"


class RIFFLER_OT_stroke_elsewhere(bpy.types.Operator):
    """Sculpt what is under the pointer: another sculpt, or an object that becomes one"""

    bl_idname = "riffler.stroke_elsewhere"
    bl_label = "Sculpt Another Object"
    bl_options = {"INTERNAL"}

    mode: EnumProperty(
        name="Mode", items=MODES, default="REMOVE", options={"SKIP_SAVE"}, description="What the tool does"
    )

    @classmethod
    def poll(cls, context):
        """Available where the stroke itself is refused: Blender does not try a tool's keys in the order in which they
        are defined."""
        if not operator_parts.object_mode(cls, context):
            return False
        if context.region_data is None:
            return operator_parts.deny(cls, "Use it in a 3D view")
        ob = sculpts.active(context)
        if refusal(context) or ob is None or mesh_edits.made(ob):
            return True
        return operator_parts.deny(cls, "The active sculpt is under the pointer: use Sculpt Stroke")

    def invoke(self, context, event):
        """Always captures the drag, so that it neither moves nor selects anything."""
        self._refused, self._rows, self._begin = refusal(context), [], time.perf_counter()
        target = None if self._refused else under(context, event) or object_surfaces.source_object(context)
        if not self._refused:
            self._refused = unfit(context, target)
        if not self._refused and sculpts.is_sculpt(target) and not mesh_edits.made(target):
            sculpts.select_only(context, target)
            return bpy.ops.riffler.stroke("INVOKE_DEFAULT", True, mode=self.mode)
        self._target = "" if self._refused else target.name
        region = context.region
        self._corner = region.x, region.y
        self._view = {
            "matrix": meshes.matrix(context.region_data.perspective_matrix).ravel().tolist(),
            "size": [region.width, region.height],
        }
        self._keep(event)
        if self._target and context.workspace is not None:
            context.workspace.status_text_set(local("Riffler: release to make this object a sculpt    Esc: cancel"))
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            return self._end(context)
        if event.type in MOVES:
            self._keep(event)
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._end(context)
            if self._refused:
                say(context, self._refused)
            else:
                self._ask(context, bpy.data.objects.get(self._target))
            return {"CANCELLED"}
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        self._end(context)

    def _ask(self, context, target):
        given = {"mode": self.mode, "stroke": json.dumps({"view": self._view, "rows": self._rows})}
        if sculpts.is_sculpt(target):
            sculpts.select_only(context, target)
            bpy.ops.riffler.edits_first("INVOKE_DEFAULT", **given)
        else:
            bpy.ops.riffler.make_sculpt("INVOKE_DEFAULT", object=self._target, **given)

    def _keep(self, event):
        self._rows.append(list(sample(event, self._corner)._replace(time=time.perf_counter() - self._begin)))

    def _end(self, context):
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        return {"CANCELLED"}


def say(context, text):
    """Shows a message at the pointer, where the user looks; one in the status bar is overlooked."""

    def draw(menu, context):
        for line in textwrap.wrap(local(text), WIDE):
            menu.layout.label(text=line, translate=False)

    context.window_manager.popup_menu(draw, title="Riffler", icon="INFO")


def refusal(context):
    """Why nothing can be sculpted now, under the pointer or elsewhere; otherwise ""."""
    heard = Heard()
    if operator_parts.busy(heard, context):
        return heard.text
    ob = sculpts.active(context)
    if ob is not None and not sculpt_work.sculpt_poll(heard, context):
        return heard.text
    return ""


class Heard:
    """Stands in for an operator's class, and records why its button would be disabled."""

    text = ""

    def poll_message_set(self, text):
        self.text = text


def under(context, event):
    """The object with a surface under the pointer; for a live sculpt's chunk, the sculpt. None if there is none."""
    from bpy_extras import view3d_utils

    region, space = context.region, context.region_data
    at = event.mouse_x - region.x, event.mouse_y - region.y
    origin = view3d_utils.region_2d_to_origin_3d(region, space, at)
    direction = view3d_utils.region_2d_to_vector_3d(region, space, at)
    hit, *_, ob, _ = context.scene.ray_cast(context.evaluated_depsgraph_get(), origin, direction)
    if not hit or ob is None:
        return None
    ob = ob.original
    mark = ob.data.get(chunks.MARK) if ob.data is not None else None
    return sculpts.marked(mark) if mark else ob


def unfit(context, ob):
    """Why that object cannot become a sculpt, with the remedy; otherwise ""."""
    if ob is None:
        return refusals.instance(context.object) or NOTHING
    if why := refusals.instance(ob):
        return why
    if ob.type not in object_surfaces.WITH_SURFACE:
        return NOTHING
    # the pointer can hit such an object all the same
    if ob.name not in context.view_layer.objects or not ob.visible_get():
        stands = (o for o in context.view_layer.objects if o.instance_collection is not None)
        of = next((o for o in stands if ob.name in o.instance_collection.all_objects), None)
        return refusals.instance(of) if of is not None else refusals.disabled(ob, context.view_layer) or NOTHING
    return refusals.linked(ob, ob.data) if sculpts.is_sculpt(ob) else refusals.flat(ob)


def _fit(chosen, context):
    """Sets pitch and cutter to suit the size in `chosen`, the properties of the operator below."""
    if chosen.side > 0:
        chosen.pitch = fitting.pitch(chosen.side)
        chosen.diameter = fit.cutter(context, chosen.side)


class TakesDrag:
    """Mixin of operators that ask first, and then continue with the recorded drag."""

    mode: EnumProperty(name="Mode", items=MODES, default="REMOVE", options={"HIDDEN", "SKIP_SAVE"})
    stroke: StringProperty(
        name="Stroke",
        options={"HIDDEN", "SKIP_SAVE"},
        description="Stroke as in riffler.stroke, with a view from world to clip space; empty: no stroke",
    )

    def go_on(self, context):
        """Turns the drag into a stroke on the active sculpt."""
        if not self.stroke:
            return {"FINISHED"}
        data = json.loads(self.stroke)
        to_world = np.linalg.inv(sculpts.from_world(sculpts.active(context)))
        matrix = np.array(data["view"]["matrix"], float).reshape(4, 4) @ to_world
        data["view"]["matrix"] = matrix.ravel().tolist()
        return bpy.ops.riffler.stroke("EXEC_DEFAULT", True, mode=self.mode, stroke=json.dumps(data))


class RIFFLER_OT_make_sculpt(TakesDrag, bpy.types.Operator):
    """Make the object a sculpt, with units, pitch and cutter chosen from its size; the object itself is hidden"""

    bl_idname = "riffler.make_sculpt"
    bl_label = "Make It a Sculpt?"
    bl_options = set()  # making the sculpt is one undo step, and the stroke another

    object: StringProperty(
        name="Object", options={"HIDDEN", "SKIP_SAVE"}, description="Name of the object; empty: the active object"
    )
    side: FloatProperty(
        name="Longest Side (mm)",
        min=0.0,
        max=1e5,
        precision=2,
        options={"SKIP_SAVE"},
        update=lambda self, context: _fit(self, context),
        description=(
            "Length of the object's longest side, set by the scene's unit without scaling; 0: chosen from the object"
        ),
    )
    pitch: FloatProperty(
        name="Pitch (mm)",
        min=0.0,
        max=1e5,
        precision=4,
        options={"SKIP_SAVE"},
        description="Distance between rays, the finest detail of the surface; 0: chosen from the size",
    )
    diameter: FloatProperty(
        name="Cutter (mm)",
        min=0.0,
        max=1e5,
        precision=3,
        options={"SKIP_SAVE"},
        description="Diameter of the cutter; 0: chosen from the size",
    )
    rounded: BoolProperty(
        name="Round Facets",
        default=False,
        options={"SKIP_SAVE"},
        description="Make the facets of an object round; its edges of more than 32° stay sharp",
    )

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def invoke(self, context, event):
        try:
            self._choose(context)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return context.window_manager.invoke_props_dialog(self, width=320)

    def draw(self, context):
        layout = self.layout
        source = self._source(context)
        if source is None:
            return
        column = layout.column(align=True)
        column.label(text=local("{} is not a sculpt yet.").format(source.name), icon="SCULPTMODE_HLT", translate=False)
        column.label(text="OK makes a sculpt of it and hides the object.", icon="BLANK1")
        layout.use_property_split = True
        column = layout.column(align=True)
        column.enabled = not fit.others(context)
        column.prop(self, "side")
        column = layout.column(align=True)
        column.prop(self, "pitch")
        column.prop(self, "diameter")
        layout.prop(self, "rounded")

    def execute(self, context):
        kept = fit.Kept(context)
        active, selected = context.view_layer.objects.active, list(context.selected_objects)
        try:
            self._choose(context)
            source = self._source(context)
            sculpts.select_only(context, source)
            if not fit.others(context):
                fit.take_unit(context, self.side / _units(source))
            fit.take_cutter(context, units.clean(self.diameter))
            pitch = units.clean(self.pitch)
            material = {"source": "OBJECT", "pitch": pitch, "directions": "xyz", "rounded": self.rounded}
            bpy.ops.riffler.new_stock("EXEC_DEFAULT", True, **material)
        except operator_parts.ERRORS as error:
            kept.restore()
            for ob in context.view_layer.objects:
                ob.select_set(ob in selected)
            context.view_layer.objects.active = active
            return operator_parts.fail(self, error)
        return self.go_on(context)

    # ------------------------------------------------------------------ within
    def _source(self, context):
        return bpy.data.objects.get(self.object) if self.object else object_surfaces.source_object(context)

    def _choose(self, context):
        """Fills in settings that were not given, from the object's size."""
        source = self._source(context)
        if why := unfit(context, source):
            raise ValueError(why)
        if sculpts.is_sculpt(source):
            raise ValueError(f"{source.name} is a sculpt already: select it, and stroke it")
        pitch, diameter = self.pitch, self.diameter
        if not self.side:
            self.side = fit.side(context, _units(source))  # sets pitch and cutter
        elif not (pitch and diameter):
            _fit(self, context)
        self.pitch, self.diameter = pitch or self.pitch, diameter or self.diameter


class RIFFLER_OT_edits_first(TakesDrag, bpy.types.Operator):
    """Apply or discard the edits made with Blender's own tools, then make the stroke"""

    bl_idname = "riffler.edits_first"
    bl_label = "Apply Mesh Edits?"
    bl_options = {"INTERNAL"}

    edits: EnumProperty(
        name="Edits",
        items=(
            ("TAKE", "Apply Mesh Edits", "Make the edited mesh the sculpt's material"),
            ("DROP", "Discard Edits", "Rebuild the mesh from the volume, without the edits"),
        ),
        default="TAKE",
        options={"SKIP_SAVE"},
        description="Whether to apply or discard the edits",
    )

    @classmethod
    def poll(cls, context):
        return sculpt_work.sculpt_poll(cls, context)

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self, width=320)

    def draw(self, context):
        name = sculpts.active(context).name
        self.layout.label(
            text=local("{} was edited in Blender's own modes.").format(name), icon="INFO", translate=False
        )
        self.layout.row().prop(self, "edits", expand=True)

    def execute(self, context):
        call = bpy.ops.riffler.take_edits if self.edits == "TAKE" else bpy.ops.riffler.rebuild
        try:
            call("EXEC_DEFAULT", True)
        except RuntimeError as error:
            return operator_parts.fail(self, error)
        return self.go_on(context)


def _units(ob):
    """The displayed longest side, in Blender units."""
    if min(ob.dimensions) <= 0:
        raise ValueError(f"{ob.name} is flat, so it has no volume: give it thickness, by the modifier Solidify")
    return fitting.longest(ob.dimensions)


CLASSES = (RIFFLER_OT_stroke_elsewhere, RIFFLER_OT_make_sculpt, RIFFLER_OT_edits_first)
