"""Sculpting with a pen or another device: a session on the device's thread (pen/session.py), polled thirty times a
second. Draws the force on the tool and shows the session's state."""

import time
from pathlib import Path

import bpy
import numpy as np
import riffler

from ..blender import handlers, operator_parts, preferences_access, views
from ..common import problems, units
from ..sculpt import brushes, draw_pace, fixtures, force_view, sculpt_work, sculpts, undo_states
from ..translations import local
from . import properties
from . import session as pen_session

FRAME = 1 / 30  # s between two polls
TELL = 0.2  # s between two updates of the panel's text
READ = 15.0  # s for which a message stays
# The tool that is active while a device sculpts: it binds Esc, and choosing another tool ends the session
# (sculpt/idle_detection.py).
TOOL = "riffler.carve"
MODES = (
    ("TOOL", "Active Tool", "Do what the active tool of the toolbar does; Carve if it is not a sculpting tool"),
    *brushes.entries(brush for brush in brushes.BRUSHES.values() if brush.session),
)

_shown = None  # arrows and gauge (sculpt/force_view.py)
_told, _told_at = (), 0.0  # the panel's text, and the time of its last update


def brush_of(context, choice):
    """The brush of a session. ValueError if the active tool's brush cannot be used in a session."""
    if choice != "TOOL":
        return brushes.of(choice.lower())
    brush = brushes.of_tool(_active_tool(context))
    if brush is None:
        return brushes.of("remove")
    if not brush.session:
        raise ValueError(f"a pen session removes or adds material: use Carve or Add instead of {brush.label}")
    return brush


def _active_tool(context):
    """Identifier of the active tool in the 3D view's toolbar, or ""."""
    tool = context.workspace.tools.from_space_view3d_mode("OBJECT", create=False) if context.workspace else None
    return tool.idname if tool is not None else ""


def session_options(context, ob, settings, brush):
    clean = units.clean
    options = {
        "mode": brush.cuts,
        "stiffness": clean(settings.stiffness),
        "material": riffler.Material(removal_constant=clean(settings.removal_constant)),
        "obstacles": obstacles(context, ob),
        **preferences_access.limits(),
    }
    if settings.device == properties.RECORDING:
        return options  # a recording's poses are in the stock's frame
    options["scale"], options["pivot"] = clean(settings.scale), clean(settings.pivot)
    options["touch"] = settings.touch and not brush.puts_on  # added material is never felt
    if settings.start == "CURSOR":
        world = np.append(context.scene.cursor.location, 1.0)
        tip = (sculpts.from_world(ob) @ world)[:3]
    else:
        lower, upper = np.array(ob.data.riffler.lower), np.array(ob.data.riffler.upper)
        tip = np.append(0.5 * (lower + upper)[:2], upper[2] + clean(settings.gap))
    options["at"] = [*tip, 0, 0, 1]
    return options


def obstacles(context, ob):
    """riffler.Collider of the fixtures, in the sculpt's millimetres, or None."""
    collection = context.scene.riffler.sculpt.fixtures
    if collection is None:
        return None
    return fixtures.collider(context, collection, sculpts.from_world(ob), {ob.name})


def device_of(settings):
    """A kind of riffler.pen.kinds, or properties.RECORDING."""
    return preferences_access.device() if settings.device == properties.PREFERRED else settings.device


def open_device(settings):
    if settings.device != properties.RECORDING:
        kind = device_of(settings)
        one = not settings.which or kind in properties.ONE_OF_A_KIND
        return riffler.pen.open(kind if one else f"{kind}:{settings.which}")
    if not settings.recording.endswith(".rjournal"):
        raise ValueError("choose a recording (.rjournal) to play")
    path = bpy.path.abspath(settings.recording)
    problems.check_source(path)
    return riffler.pen.open(path)


def recordings(settings):
    """The folder for recordings, or None."""
    if not settings.record:
        return None
    if not settings.folder or (settings.folder.startswith("//") and not bpy.data.filepath):
        raise ValueError("choose a folder for the recording, or save the .blend first: // stands for its folder")
    folder = Path(bpy.path.abspath(settings.folder))
    if not folder.is_dir():
        raise ValueError(f"there is no folder {folder} for the recording: choose another")
    problems.check_target(folder / "session.rjournal")
    return folder


NO_SECONDS = "seconds: give the duration, as there is no window to end the session in"
NO_COPIES = "Mirror and Radial apply to strokes of the pointer only: a pen session makes no copies"


def seconds_field():
    """The duration of a session without a window."""
    return bpy.props.FloatProperty(
        name="Seconds",
        min=0.0,
        max=86400.0,
        options={"HIDDEN", "SKIP_SAVE"},
        description="Duration of the session when a script calls the operator, in s",
    )


class RIFFLER_OT_pen_sculpt(sculpt_work.TakesTool, properties.PenSettings, bpy.types.Operator):
    """Sculpt with a pen or another device, until Esc or until the operator is called again"""

    bl_idname = "riffler.pen_sculpt"
    bl_label = "Sculpt with Pen"
    bl_options = set()  # it pushes its undo steps itself: one at the beginning, and one for each stroke

    mode: bpy.props.EnumProperty(
        name="Mode",
        items=MODES,
        default="TOOL",
        options={"SKIP_SAVE"},
        description="Whether the session removes or adds material",
    )
    seconds: seconds_field()

    @classmethod
    def poll(cls, context):
        return pen_session.running is not None or sculpt_work.sculpt_poll(cls, context)

    def execute(self, context):
        """Runs the session for `seconds`, in one call."""
        if pen_session.running is not None:
            return stop(self)
        if not self.seconds > 0:
            return operator_parts.fail(self, ValueError(NO_SECONDS))
        if not self._start(context):
            return {"CANCELLED"}
        return run_through(self, pen_session.running)

    def invoke(self, context, event):
        global _shown
        if pen_session.running is not None or self.seconds > 0 or bpy.app.background or context.window is None:
            return self.execute(context)
        if not self._start(context):
            return {"CANCELLED"}
        _take_up_tool(context)
        settings, session = context.scene.riffler.sculpt, pen_session.running
        if session.run.pushes and brush_of(context, self.mode).chips:
            _shown = force_view.begin(units.clean(settings.limit), session.diameter, session.live.to_world)
        draw_pace.begin(session.live.stages)
        bpy.app.timers.register(_look, first_interval=FRAME)
        return {"FINISHED"}

    def _start(self, context):
        ob = sculpts.active(context)
        try:
            brush = brush_of(context, self.mode)
            if len(context.scene.riffler.sculpt.maps()) > 1:
                self.report({"WARNING"}, local(NO_COPIES))
            sculpt_work.check_state(self, context, ob)
            sculpt_work.refuse_edits(ob)
            depth = units.clean(context.scene.riffler.sculpt.depth)
            tool = brush.cutter(riffler.Tool.from_dict(self.tool_dict(context)), depth)
            folder, options = recordings(self), session_options(context, ob, self, brush)
            device = open_device(self)
            pen_session.PenSession(context, ob, device, tool, options, folder, _leave, view=self.axes == "VIEW")
        except (*operator_parts.ERRORS, TypeError) as error:
            operator_parts.fail(self, error)
            return False
        bpy.ops.ed.undo_push(message=self.bl_label)
        _tell(pen_session.running)
        return True


def run_through(operator, session):
    """Polls the session for the operator's `seconds`, ends it, and reports its result."""
    end = time.monotonic() + operator.seconds
    try:
        while time.monotonic() < end and session.look():
            time.sleep(FRAME)
        session.finish()
    except operator_parts.ERRORS as error:
        session.fail(error)
    return tell(operator, session)


def _take_up_tool(context):
    if not _active_tool(context).startswith("riffler."):
        bpy.ops.wm.tool_set_by_id(name=TOOL, space_type="VIEW_3D")


def _look():
    """Timer function while the session runs."""
    session = pen_session.running
    if session is None:
        return None
    try:
        if session.look():
            _tell(session)
            return FRAME
    except operator_parts.ERRORS as error:
        session.fail(error)
    if session.problem:
        undo_states.tell(session.problem)
    return None


def _tell(session):
    global _told, _told_at
    run = session.run
    if _shown is not None and run.pose is not None:
        _shown.pose, _shown.to_world = run.pose, session.live.to_world
        _shown.force, _shown.torque = run.push
    brush = brushes.of(session.mode)
    what = f" {brush.done}" if brush.puts_on else ""
    hand = f"Hand: {run.state}, {run.force:.2f} N"
    text = f"{units.format_volume(session.changed)}{what} in {_strokes(session)}"
    told = hand, text, run.why, run.thread
    if told == _told or time.perf_counter() - _told_at < TELL:
        return
    _told, _told_at = told, time.perf_counter()
    state = bpy.context.window_manager.riffler
    state.force, state.text, state.why, state.thread = told
    why = f"    {run.why}" if run.why else ""
    say(f"Riffler: {hand}, {text}    Esc: end    Ctrl Z: undo a stroke{why}")
    views.redraw_sidebars(bpy.context)


def _strokes(session):
    return units.counted(session.count, "stroke")


def say(text):
    """Sets the status text of every window: a timer has no window of its own."""
    for window in bpy.context.window_manager.windows:
        window.workspace.status_text_set(text)


def look_at(kind, show):
    """What the timer function of a session of this kind does and returns; `show(session)` shows its state. A session
    that ends by itself leaves its message in the status bar, since outside an operator there are no reports."""
    session = pen_session.running
    if not isinstance(session, kind):
        return None
    try:
        if session.look():
            show(session)
            return FRAME
    except operator_parts.ERRORS as error:
        session.fail(error)
    level, text, _ = session.summary()
    if level == "WARNING":
        say(f"Riffler: {text}")
        bpy.app.timers.register(hush, first_interval=READ)
    return None


def hush():
    """Timer function: removes the message of a session that has ended by itself."""
    if pen_session.running is None:
        say(None)


def _leave():
    """Called when the session has ended, for any reason."""
    global _shown, _told
    _told = ()
    if _shown is not None:
        _shown = None
        force_view.end()
    draw_pace.end()
    say(None)
    views.redraw_sidebars(bpy.context)


def stop(operator):
    session = pen_session.running
    try:
        session.finish()
    except operator_parts.ERRORS as error:
        session.fail(error)
    return tell(operator, session)


def tell(operator, session):
    """Reports the session's result, or that it changed nothing."""
    level, text, done = session.summary()
    operator.report({level}, text)
    return {"FINISHED"} if done else {"CANCELLED"}


class PenRuns:
    """Mixin of operators that need a running session."""

    @classmethod
    def poll(cls, context):
        return pen_session.running is not None or operator_parts.deny(cls, "No pen session is running")


class RIFFLER_OT_pen_stop(PenRuns, bpy.types.Operator):
    """End the pen session and keep its strokes"""

    bl_idname = "riffler.pen_stop"
    bl_label = "End Session"
    bl_options = set()

    def execute(self, context):
        stop(self)
        return {"FINISHED"}


class RIFFLER_OT_pen_home(PenRuns, bpy.types.Operator):
    """Set the pen's counters to those of its home posture, in which it stands now"""

    bl_idname = "riffler.pen_home"
    bl_label = "Home"
    bl_options = {"INTERNAL"}

    def execute(self, context):
        device = pen_session.running.run.device
        if not device.home():
            return operator_parts.fail(self, ValueError(f"{device.kind} has nothing to home"))
        return {"FINISHED"}


class RIFFLER_OT_pen_reset(PenRuns, bpy.types.Operator):
    """Allow force again after a safety trip, once its cause is fixed"""

    bl_idname = "riffler.pen_reset"
    bl_label = "Clear Trip"
    bl_options = {"INTERNAL"}

    def execute(self, context):
        pen_session.running.run.session.reset()
        return {"FINISHED"}


def detach():
    handlers.stop(_look)
    pen_session.end()


CLASSES = (RIFFLER_OT_pen_sculpt, RIFFLER_OT_pen_stop, RIFFLER_OT_pen_home, RIFFLER_OT_pen_reset)
