"""A stroke of the sculpt tool: from the press of a button to its release, of a mouse or a tablet's pen.

Events only queue samples. Blender handles all waiting events before it draws, and sends a timer's event after them:
there the samples are carved, with one update of the display for any number of events. So an update that takes longer
than an event makes no backlog.

A script can make the same stroke: `stroke` is the BrushStroke.text of a finished one (`last`).
"""

import time

import bpy
import riffler

from ..blender import operator_parts
from ..common import units
from ..translations import local
from . import (
    brushes,
    draw_pace,
    fixtures,
    force_view,
    kept_strokes,
    live_registry,
    mesh_edits,
    pointer,
    sculpt_work,
    sculpts,
)
from .pure import brush_stroke, reach
from .pure.stroke_path import Sample

LOOK = 1 / 30  # s between two updates
LOST = "{} of walls thinner than the pitch were lost: undo, and use Change Pitch in Clay for a finer pitch first"
NO_FIXTURES = "Hand tools do not avoid fixtures: clear Fixtures in the panel Stroke, or use Carve"
MODES = brushes.entries(brushes.BRUSHES.values())
MOVES = {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}

_held = None  # the operator of the stroke in progress in a window, or None
last = ""  # the newest stroke made by hand, for riffler.stroke(stroke=…)


class RIFFLER_OT_stroke(sculpt_work.TakesTool, bpy.types.Operator):
    """Sculpt along the pointer's path (Esc or right mouse button: cancel the stroke)"""

    bl_idname = "riffler.stroke"
    bl_label = "Sculpt Stroke"
    bl_options = {"UNDO"}  # not REGISTER: changed settings would need the hand's movement again
    _run, _fresh = None, False  # the live sculpt; whether this stroke has started its session

    mode: bpy.props.EnumProperty(
        name="Mode", items=MODES, default="REMOVE", options={"SKIP_SAVE"}, description="What the tool does"
    )
    stroke: bpy.props.StringProperty(
        name="Stroke",
        options={"HIDDEN", "SKIP_SAVE"},
        description="JSON of a view (matrix: 16 numbers, mm of the sculpt to clip space; size: pixels), rows (x, y, "
        "pressure, tilt_x, tilt_y, time) and looks (after how many rows the tool follows what is cut)",
    )

    @classmethod
    def poll(cls, context):
        return sculpt_work.sculpt_poll(cls, context)

    def execute(self, context):
        if not self.stroke:
            return operator_parts.fail(self, ValueError("stroke: give the path, as there is no pointer to follow"))
        try:
            view, samples, looks = brush_stroke.read(self.stroke)
            self._take_up(context)
            self._start(context, view)
        except (*operator_parts.ERRORS, TypeError) as error:
            self._undone()
            return operator_parts.fail(self, error)
        try:
            brush_stroke.replay(self._stroke, samples, looks)
        except operator_parts.ERRORS as error:
            self._undone()
            return operator_parts.fail(self, error)
        return self._finish(context)

    def invoke(self, context, event):
        global _held
        if self.stroke or bpy.app.background or context.region_data is None:
            return self.execute(context)
        if mesh_edits.made(sculpts.active(context)):  # the user is asked first, and the drag recorded meanwhile
            return bpy.ops.riffler.stroke_elsewhere("INVOKE_DEFAULT", mode=self.mode)
        context.window.cursor_modal_set("WAIT")  # the first stroke builds the sculpt's chunks
        try:
            self._take_up(context)
            self._start(context, pointer.sight(context.region, context.region_data, self._run))
        except (*operator_parts.ERRORS, TypeError) as error:
            self._undone()
            return operator_parts.fail(self, error)
        finally:
            context.window.cursor_modal_restore()
        settings = context.scene.riffler.sculpt
        self._region = context.region.x, context.region.y
        self._begin = self._looked = self._taken = time.perf_counter()
        self._queue = [sample(event, self._region)]
        self._oldest = self._drawn = None  # since when carved samples, and displayed ones, may have waited
        self._shown = None
        if settings.show_force and brushes.of(self.mode.lower()).chips:
            limit = units.clean(settings.limit)
            self._shown = force_view.begin(limit, self._stroke.tool.diameter, self._run.to_world)
        pointer.held = self._stroke
        draw_pace.begin(self._run.stages)
        self._timer = context.window_manager.event_timer_add(LOOK, window=context.window)
        context.window_manager.modal_handler_add(self)
        _held = self
        return self._step(context)

    def modal(self, context, event):
        if live_registry.lives.get(self._run.mark) is not self._run:
            self._leave(context)
            self.report({"WARNING"}, local("The sculpt was saved or ended during a stroke: the stroke was undone"))
            return {"CANCELLED"}
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            return self._give_up(context)
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            return self._end(context)
        if event.type in MOVES:
            self._queue.append(sample(event, self._region))
        elif event.type == "TIMER":
            return self._step(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender calls it when the window closes."""
        self._give_up(context)

    # ------------------------------------------------------------------ the parts of a stroke
    def _take_up(self, context):
        ob = sculpts.active(context)
        self._fresh = live_registry.of(ob) is None
        if self._fresh:
            sculpt_work.check_state(self, context, ob)
            sculpt_work.refuse_edits(ob)
        self._run = live_registry.begin(context, ob)

    def _start(self, context, view):
        ob = sculpts.active(context)
        settings, mode = context.scene.riffler.sculpt, self.mode.lower()
        brush = brushes.of(mode)
        if why := brush.refusal(self._run.volume):
            raise ValueError(why)
        self._run.maps = settings.maps()
        self._choice = settings.choice(mode)
        self._keep = settings.keep and brush.keeps
        if self._keep:
            kept_strokes.check(self._run)
        if brush.hand and settings.fixtures is not None:
            raise ValueError(NO_FIXTURES)
        tool, choice, keep_out = self.tool_dict(context, brush.hand), self._choice, None
        if settings.fixtures is not None and brush.clear:
            obstacle = fixtures.collider(context, settings.fixtures, self._run.to_mm, {ob.name})
            if obstacle is not None:
                keep_out = fixtures.keeper(brush.cutter(riffler.Tool.from_dict(tool), choice.depth), obstacle)
        self._run.keep_out = keep_out
        self._stroke = brush_stroke.BrushStroke(self._run, tool, view, choice, keep_out)

    def _step(self, context):
        """Called once per redraw."""
        try:
            before, now = self._taken, time.perf_counter()
            if self._drawn is not None:  # Blender has drawn since the last update
                self._run.stages.waited(now - self._drawn)
                self._drawn = None
            if self._carve(now) and self._oldest is None:
                self._oldest = before
            if self._oldest is not None and now - self._looked >= LOOK:
                self._looked, self._drawn, self._oldest = now, self._oldest, None
                self._stroke.look()
                self._tell(context)
        except operator_parts.ERRORS as error:
            self._give_up(context)
            return operator_parts.fail(self, error)
        return {"RUNNING_MODAL"}

    def _carve(self, now):
        """Carves all waiting samples. The times of their events are unknown: they are spread evenly since the last
        call."""
        before, queue, carved = self._taken, self._queue, False
        self._taken, self._queue = now, []
        for k, sample in enumerate(queue, 1):
            passed = before + (now - before) * k / len(queue) - self._begin
            carved |= self._stroke.add(sample._replace(time=passed))
        return carved

    def _tell(self, context):
        made = self._stroke
        if self._shown is not None and made.pose is not None:
            self._shown.pose, self._shown.force, self._shown.torque = made.pose, made.force, made.torque
        if context.workspace is not None:
            context.workspace.status_text_set(f"Riffler: {summary(made, made.brush)}    Esc: cancel the stroke")

    def _end(self, context):
        global last
        try:
            self._carve(time.perf_counter())
            self._stroke.end()
        except operator_parts.ERRORS as error:
            self._give_up(context)
            return operator_parts.fail(self, error)
        last = self._stroke.text()
        self._leave(context)
        return self._finish(context)

    def _finish(self, context):
        """Makes the stroke a state; Blender makes the undo step when the operator finishes."""
        kept = 0
        try:
            made, ob = self._stroke, self._run.object
            if self._keep and self._run.stroke is not None and self._run.changed:
                dropped = kept_strokes.keep(context, self._run, made, self._choice)
                kept = 1
                if dropped:
                    self.report({"WARNING"}, local(kept_strokes.DROPPED))
            changed = self._run.finish_stroke(context)
            if kept and not changed:
                kept_strokes.drop_last(ob)
        except operator_parts.ERRORS as error:
            self._undone()
            return operator_parts.fail(self, error)
        if changed:
            if self._run.cut_off:
                self.report({"WARNING"}, local(reach.CUT_OFF))
            if self._run.lost > self._run.volume.pitch**3:  # less than a cell is not visible
                self.report({"WARNING"}, local(LOST).format(units.format_volume(self._run.lost)))
            return {"FINISHED"}
        self._undone()
        self.report({"INFO"}, nothing(self._stroke, self._stroke.brush))
        return {"CANCELLED"}

    def _give_up(self, context):
        self._leave(context)
        self._undone()
        return {"CANCELLED"}

    def _undone(self):
        """Removes the chunks that this stroke has made: no undo step has them, and Blender crashes in the next undo
        over objects that no step has."""
        if self._run is None:
            return
        self._run.cancel_stroke()
        if self._fresh:
            self._run.end()

    def _leave(self, context):
        """Removes what is displayed only during a stroke."""
        global _held
        _held = pointer.held = None
        force_view.end()
        draw_pace.end()
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        if context.area is not None:
            context.area.tag_redraw()  # removes the arrows


def sample(event, corner):
    """The sample of an event in a region with this lower left corner, in pixels of the window. Its time is not known
    yet."""
    pressure, lean = (event.pressure, event.tilt) if event.is_tablet else (1.0, (0.0, 0.0))
    # A tablet's second tilt grows towards the user: down the view (GHOST_TabletData).
    return Sample(event.mouse_x - corner[0], event.mouse_y - corner[1], pressure, lean[0], -lean[1])


def summary(made, brush):
    lifted = f", {units.counted(made.lifted, 'move')} lifted over fixtures" if made.lifted else ""
    return f"{units.format_volume(made.removed)} {brush.done} in {units.counted(made.moves, 'move')}{lifted}"


def nothing(made, brush):
    """Why a stroke changed nothing."""
    if made.moves == 0 and made.lifted:
        return "The fixtures kept the tool out"
    if made.moves == 0:
        return "The stroke did not meet the sculpt"
    return brush.unchanged


CLASSES = (RIFFLER_OT_stroke,)


def detach():
    """Discards a stroke in progress: Blender drops its operator without calling it."""
    try:
        if _held is not None:
            _held._give_up(bpy.context)
    finally:
        force_view.end()
        draw_pace.end()
        pointer.held = None
        pointer.kept.clear()
        force_view.kept.clear()
