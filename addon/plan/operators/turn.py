"""Turns the tool at the point of the path at the current frame: by dials and handles in the view, by the map of free
orientations, by numbers; and goes to the point under the pointer."""

import math

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...blender import operator_parts, scene_units
from ...common import quaternions
from ...common.job import AfterJob, DoneJob, TaskJob
from ...sculpt import force_view
from .. import (
    current_pose,
    obstacles,
    orientation_map_view,
    orientation_probe,
    path_view,
    plan_states,
    plan_store,
    timeline,
)
from ..current_pose import plan_object
from ..pure import tool_rotation
from . import keys
from .plan_work import PlanWork, tell, timeline_poll

MAP = "MAP"
HANDLES = (
    (tool_rotation.INCLINATION, "Inclination", "Turn forward and backward, about the path's y"),
    (tool_rotation.TILT, "Tilt", "Turn to the left and to the right"),
    (tool_rotation.FREE, "Free", "Drag the tool's end with the pointer"),
    (MAP, "Map", "Turn to the cell under the pointer, in the map of free orientations"),
)
BUDGET = 2000.0  # µs for the force at each move of the pointer
_held = None  # the operator that turns the tool in a window, or None
HELP = "Ctrl: steps of 5°    Shift: slowly    Numbers: degrees    Esc: as it was"


class RIFFLER_OT_plan_turn(bpy.types.Operator):
    """Turn the tool at this point of its path and set a key; in the view, drag a dial or the tool's end"""

    bl_idname = "riffler.plan_turn"
    bl_label = "Turn Tool"
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}

    inclination: FloatProperty(
        name="Inclination",
        subtype="ANGLE",
        min=-math.pi,
        max=math.pi,
        description="How far the tool leans forward along the path",
    )
    tilt: FloatProperty(
        name="Tilt",
        subtype="ANGLE",
        min=-math.pi / 2,
        max=math.pi / 2,
        description="How far the tool leans to the left of the path",
    )
    relative: BoolProperty(name="Relative", description="Add the angles to the tool's current ones")
    path: IntProperty(name="Path", min=0, options={"SKIP_SAVE"}, description="Number of the path; 0: that of the frame")
    point: IntProperty(
        name="Point", min=0, options={"SKIP_SAVE"}, description="Point of the path, from 0; needs a path"
    )
    handle: EnumProperty(name="Handle", items=HANDLES, default=tool_rotation.FREE, options={"HIDDEN", "SKIP_SAVE"})

    _turn = None

    @classmethod
    def poll(cls, context):
        return timeline_poll(cls, context)

    def draw(self, context):
        operator_parts.draw_fields(self, ("inclination", "tilt", "relative"))

    def execute(self, context):
        try:
            ob = plan_object(context)
            spot, frame = keys.spot_at(context, ob, self.path, self.point)
            angles = tool_rotation.cleaned(self.inclination), tool_rotation.cleaned(self.tilt)
            if self.relative:
                angles = tool_rotation.within(*np.add(spot.line.lean(spot.index, spot.axis), angles))
            keys.set_key(context.scene, ob, frame, axis=spot.line.axis(spot.index, *angles))
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return self._say(context, ob, frame, angles)

    def _say(self, context, ob, frame, angles):
        """Reports the result; with the clearance only if the surroundings are known already."""
        near = obstacles.known(ob)
        if near is None or plan_states.state(ob).problems:
            return tell(self, ob)
        spot = current_pose.spot(context.scene, ob, frame)
        state = orientation_probe.state(context.scene, near, spot, spot.axis)
        self.report({"INFO" if state.free else "WARNING"}, f"{tool_rotation.said(*angles)}: {state}")
        return {"FINISHED"}

    # ------------------------------------------------------------------ in a window
    def invoke(self, context, event):
        global _held
        at = event.mouse_region_x, event.mouse_region_y
        if self.handle == MAP:
            angles = orientation_map_view.angles_at(context, at)
            if angles is None:
                return {"PASS_THROUGH"}
            self.inclination, self.tilt, self.relative = *angles, False
            return self.execute(context)
        if bpy.app.background or context.region_data is None:
            return self.execute(context)
        try:
            ob = plan_object(context)
            spot, _ = keys.spot_at(context, ob)
            plan_store.refuse_turning(spot.plan, spot.path)
            view = current_pose.sight(context, context.region, context.region_data)
            radius = current_pose.reach(context, view, spot.centre)
            self._turn = tool_rotation.Turn(
                spot.line, spot.index, self._axis(context, spot), self.handle, view.ray(*at), radius
            )
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        self._ob, self._path, self._index, self._area = ob.name, spot.path, spot.index, context.area
        tool = spot.plan.tool
        mm = scene_units.mm_per_unit(context.scene)
        self._shown = force_view.begin(
            context.scene.riffler.sculpt.limit, tool.diameter / 2, np.diag([1 / mm, 1 / mm, 1 / mm, 1.0])
        )
        try:
            self._follow(context)
        except operator_parts.ERRORS as error:
            self.cancel(context)
            return operator_parts.fail(self, error)
        context.window_manager.modal_handler_add(self)
        _held = self
        return {"RUNNING_MODAL"}

    def _axis(self, context, spot):
        """The tool's visible axis: the user may have turned it with R."""
        tool, ghost = timeline.pair(spot.ob)
        if tool.constraints.get(timeline.TURN) and tool.constraints[timeline.TURN].influence == 0:
            return quaternions.axes_of(timeline.stands(context.scene, tool, ghost))
        return spot.axis

    def modal(self, context, event):
        if event.type in ("ESC", "RIGHTMOUSE") and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type in ("RET", "NUMPAD_ENTER") or (event.type == "LEFTMOUSE" and event.value == "RELEASE"):
            return self._done(context)
        try:
            if event.type == "MOUSEMOVE":
                view = current_pose.sight(context, context.region, context.region_data)
                ray = view.ray(event.mouse_region_x, event.mouse_region_y)
                self._turn.move(ray, slow=event.shift, snap=event.ctrl)
                self._follow(context)
            elif event.value == "PRESS" and self._turn.type(event.type, event.unicode or event.ascii):
                self._follow(context)
        except operator_parts.ERRORS as error:
            self.cancel(context)
            return operator_parts.fail(self, error)
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Restores the tool's orientation. Blender calls it too, when another file is opened."""
        self._end(context)
        ob = bpy.data.objects.get(self._ob)
        if ob is not None and timeline.pair(ob) is not None:
            current_pose.release(context.scene, ob)

    def _done(self, context):
        angles, turned = self._turn.angles, self._turn.turned
        self.cancel(context)
        if not turned:
            return {"CANCELLED"}
        self.inclination, self.tilt = angles
        self.relative = False
        return self.execute(context)

    def _end(self, context):
        global _held
        _held = current_pose.held = None
        force_view.end()
        # The context is another one when the add-on is disabled, and the area may be gone.
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                if area == self._area:
                    area.header_text_set(None)
                    area.tag_redraw()

    def _follow(self, context):
        """Shows the turned tool, the force on it, and its clearance."""
        ob = bpy.data.objects.get(self._ob)
        spot = current_pose.spot(context.scene, ob)
        if spot is None or (spot.path, spot.index) != (self._path, self._index):
            raise ValueError("The plan or the frame has changed: the tool was not turned")
        current_pose.held = axis = self._turn.axis
        said = tool_rotation.said(*self._turn.angles)
        try:
            pose = tool_rotation.stand(spot.line, spot.index, axis, spot.plan.tool)
        except ValueError as error:  # a bull-nose cutter does not reach a valley at any angle
            context.area.header_text_set(f"{said}: {error}    {HELP}")
            return
        current_pose.hand(context.scene, spot, pose)
        state = self._look(context, spot, pose)
        typed = f"  [{self._turn.typed}°]" if self._turn.typed else ""
        context.area.header_text_set(f"{said}{typed}: {state}    {HELP}")
        context.area.tag_redraw()

    def _look(self, context, spot, pose):
        near = obstacles.known(spot.ob)
        if near is None:
            try:
                near = obstacles.ask(context, spot.ob)
            except ValueError as error:
                return str(error)
        if near is None:
            return "looking at the part …"
        contact = near.collider.query(spot.plan.tool, pose, budget_us=BUDGET)
        self._shown.pose, self._shown.force, self._shown.torque = pose, contact.force, contact.torque
        clearance = scene_units.clean(context.scene.riffler.plan.clearance)
        return near.state(spot.plan.tool, pose, spot.plan.tolerance or 0.01, clearance)


class PointsAt:
    """Mixin of operators for a point of a path: a given one, or the one under the pointer."""

    path: IntProperty(name="Path", default=0, min=0, description="Number of the path; 0: that of the frame")
    point: IntProperty(name="Point", default=0, min=0, description="Point of the path, from 0; needs a path")

    @classmethod
    def poll(cls, context):
        return timeline_poll(cls, context)

    def invoke(self, context, event):
        return self.execute(context) if self._pointed(context, event) else {"PASS_THROUGH"}

    def _pointed(self, context, event):
        """Uses what is under the pointer; False if there is nothing."""
        if context.region_data is None:
            return True
        found = path_view.under(context, (event.mouse_region_x, event.mouse_region_y))
        if found is not None:
            self.path, self.point = found.path + 1, found.index
        return found is not None

    def _go(self, context):
        spot, frame = keys.spot_at(context, plan_object(context), self.path, self.point)
        timeline.go_to(context.scene, frame)
        return spot, frame


class RIFFLER_OT_plan_point(PointsAt, bpy.types.Operator):
    """Go to the frame where the tool is at this point of its path"""

    bl_idname = "riffler.plan_point"
    bl_label = "Go to Point of Path"
    bl_options = {"REGISTER"}  # in Blender a change of frame is not an undo step

    def execute(self, context):
        try:
            self._go(context)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


class RIFFLER_OT_plan_point_key(PointsAt, PlanWork, bpy.types.Operator):
    """Set a key at this point of the path, with the collision-free orientation of least tilt; without a part, with the
    current orientation
    """

    bl_idname = "riffler.plan_point_key"
    bl_label = "Set Free Key at Point"
    doing = "Searching for a free orientation"
    cancelled = "Search for a free orientation cancelled: no key was set"

    def invoke(self, context, event):
        return PlanWork.invoke(self, context, event) if self._pointed(context, event) else {"PASS_THROUGH"}

    def begin(self, context):
        ob, _ = self.take(context)
        self._spot, self._frame = keys.spot_at(context, ob, self.path, self.point)
        plan_store.refuse_turning(self._spot.plan, self._spot.path)
        if obstacles.part_of(context.scene, ob) is None:
            return DoneJob(None)
        scene = context.scene.name
        return AfterJob(
            obstacles.take(context, ob),
            lambda near: TaskJob(orientation_probe.start_free_orientations(bpy.data.scenes[scene], near, self._spot)),
        )

    def finish(self, context, job):
        axis, said = self._spot.axis, "There is no part: the orientation is unchanged"
        if job.result is not None:
            axis, said = job.result.suggestion, ""
            if axis is None:
                raise ValueError(f"No orientation is free here: {job.result.reason}: no key was set")
        keys.set_key(context.scene, self.ob, self._frame, axis=axis)
        self._go(context)
        lean = self._spot.line.lean(self._spot.index, axis)
        self.report({"WARNING" if said else "INFO"}, said or tool_rotation.said(*lean))
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_plan_turn, RIFFLER_OT_plan_point, RIFFLER_OT_plan_point_key)


def detach():
    """Restores the tool: Blender drops a running modal operator without calling it."""
    if _held is not None:
        _held.cancel(bpy.context)
