"""Sculpting with a pen, or whatever device: a session runs in the device's thread, and Blender looks thirty times a
second at what has changed.

The session has a copy of the sculpt's volume; the sculpt itself stays as it is, hidden, until the session has ended.
Then what was cut is one undo step. Whatever needs the sculpt before (saving, undo, another file, the add-on's end) ends
the session first.
"""

import shutil
import tempfile
import time
from datetime import datetime
from pathlib import Path

import bpy
import numpy as np
import riffler

from .. import properties
from ..bl import meshes, preview, sculpts, store
from ..core import pen
from ..core import units as names
from . import paths, shared

FRAME = 1 / 30  # s from one look to the next
TELL = 0.2  # s between two changes of what the panel says

_live = None  # the session that runs, if one does: a device is in one hand


class Live:
    """A session with the sculpt `ob`, and what Blender shows of it. ValueError, OSError or PenError where it cannot be;
    then nothing has changed."""

    def __init__(self, context, ob, settings, tool):
        self._begin = time.perf_counter()
        self._object, self._identity = ob.name, store.identity(ob.data)
        self._mm = sculpts.shown_mm_per_unit(ob.data)
        self._matrix = ob.matrix_world.copy()
        self._told = 0.0
        self.asked = self.done = False  # to end; it has
        self.pending = False  # the sculpt has changed, and no undo step has it yet
        self.level, self.message, self.timer = {"INFO"}, "", None
        content = store.content(ob.data)
        self._before = content.cuts
        volume = content.volume.copy()
        cutter = riffler.Tool.from_dict(tool)
        options = session_options(context, ob, settings, volume)
        self._journal, self._temporary = journal_path(ob.name, settings)
        self._device = self._preview = None
        try:
            mesher = riffler.Mesher(volume)
            self._device = open_device(settings)
            session = riffler.Session(volume, cutter, self._device, **options)
            session.journal(self._journal, {"sculpt": ob.name, "blender": bpy.app.version_string})
            self.run = pen.PenRun(self._device, session, mesher, volume)
            solid = pen.solid(cutter.outline(0.02 * cutter.diameter))
            self._preview = preview.Preview(context, ob, mesher, self._mm, solid)
            self.run.start()
        except BaseException:
            if self._device is not None:
                self._device.stop()
            if self._preview is not None:
                self._preview.remove()
            self._forget_journal()
            raise
        context.window_manager.riffler.sculpting = True
        self.tell(context)

    def step(self, context):
        """True while the session goes on."""
        ob = self._sculpt()
        if self.done or self.asked or ob is None or self.run.over:
            return False
        bricks = self.run.step()
        self._matrix = ob.matrix_world.copy()
        self._preview.update(bricks, self._matrix)
        if self.run.tool is not None:
            self._preview.place_tool(self.run.tool)
        if time.perf_counter() - self._told > TELL:
            self.tell(context)
        return True

    def tell(self, context):
        self._told = time.perf_counter()
        state, run = context.window_manager.riffler, self.run
        state.force = f"Force {run.state}, {run.force:.2f} N"
        state.text = f"{names.format_volume(run.removed)} in {run.strokes} strokes"
        state.why = run.why
        if context.workspace is not None:
            why = f"    {run.why}" if run.why else ""
            keys = "Esc: end    Ctrl Z: take a stroke back"
            context.workspace.status_text_set(f"Riffler: {state.force}, {state.text}    {keys}{why}")
        shared.redraw_sidebars(context)

    def go(self, context, what):
        """Takes the last stroke back, or brings it again: `what` is "undo" or "redo". What is to be said."""
        try:
            count = getattr(self.run.session, what)()
        except RuntimeError as error:
            return str(error)
        if self._sculpt() is not None:
            self._preview.update(self.run.mesher.update(self.run.volume), self._matrix)
        return "" if count else f"There is no stroke to {what}"

    def finish(self, context, keep=True):
        """Ends it, once; `keep` makes what was cut the sculpt's."""
        global _live
        if self.done:
            return
        self.done = True
        if _live is self:
            _live = None
        problem = self.run.stop()
        self._preview.remove()
        state = context.window_manager.riffler
        state.sculpting, state.force, state.why = False, "", ""
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        shared.redraw_sidebars(context)
        try:
            self.pending = keep and self._commit(context, problem)
        finally:
            self._forget_journal()

    def drop_timer(self, context):
        """The operator lives by it until it has said what was done."""
        if self.timer is not None:
            context.window_manager.event_timer_remove(self.timer)
            self.timer = None

    def _commit(self, context, problem):
        run, seconds = self.run, time.perf_counter() - self._begin
        where = "" if self._temporary else f"; recorded in {self._journal}"
        if run.removed <= 0:
            self.level = {"WARNING"}
            self.message = f"Nothing was removed in {seconds:.1f} s: {problem or run.why or 'no stroke'}{where}"
            return False
        cuts, lost = self._cuts()
        ob = self._sculpt()
        if ob is not None:
            sculpts.commit(ob.data, run.volume, self._before + cuts, self._mm)
        else:
            name = f"{self._object} Pen"
            ob = sculpts.new_object(context, name, run.volume, self._matrix, self._before + cuts)
            problem = problem or f"the sculpt was changed or removed meanwhile: what was made is {ob.name}"
        removed = names.format_volume(run.removed)
        problem = problem or lost or run.session.journal_problem
        self.level = {"WARNING"} if problem else {"INFO"}
        note = f"; {problem}" if problem else ""
        self.message = f"Removed {removed} in {run.strokes} strokes, {seconds:.1f} s{where}{note}"
        return True

    def _cuts(self):
        """The strokes as they are in the journal, where every step is: frames have those that somebody looked at."""
        try:
            return paths.from_recording(self._journal)[0], ""
        except (ValueError, OSError) as error:
            return [], f"the strokes are missing among the cuts: {error}"

    def _sculpt(self):
        """The sculpt where it is what it was at the start, or None."""
        ob = bpy.data.objects.get(self._object)
        if sculpts.is_sculpt(ob) and ob.users and store.identity(ob.data) == self._identity:
            return ob
        return None

    def _forget_journal(self):
        if self._temporary:
            shutil.rmtree(self._temporary, ignore_errors=True)


def session_options(context, ob, settings, volume):
    clean = names.clean
    options = {
        "stiffness": clean(settings.stiffness),
        "material": riffler.Material(removal_constant=clean(settings.removal_constant)),
    }
    if settings.device == properties.RECORDING:
        return options  # its poses are in the stock's frame
    options["scale"] = clean(settings.scale)
    if settings.start == "CURSOR":
        world = np.append(context.scene.cursor.location, 1.0)
        tip = (np.linalg.inv(meshes.matrix(ob.matrix_world)) @ world)[:3] * sculpts.shown_mm_per_unit(ob.data)
    else:
        lower, upper = volume.lower, volume.upper
        tip = np.append(0.5 * (lower + upper)[:2], upper[2] + clean(settings.gap))
    options["at"] = [*tip, 0, 0, 1]
    return options


def open_device(settings):
    if settings.device != properties.RECORDING:
        return riffler.pen.open(settings.device)
    if not settings.recording.endswith(".rjournal"):
        raise ValueError("choose a recording (.rjournal) to be played")
    return riffler.pen.open(bpy.path.abspath(settings.recording))


def journal_path(name, settings):
    """Where the journal goes, and the folder that goes away with the session, or None."""
    if not settings.record:  # it is needed all the same: the sculpt's cuts are made of it
        folder = Path(tempfile.mkdtemp(prefix="riffler-", dir=bpy.app.tempdir or None))
        return folder / "session.rjournal", folder
    if not settings.folder or (settings.folder.startswith("//") and not bpy.data.filepath):
        raise ValueError("choose a folder for the journal, or save the .blend first: // is the folder that it is in")
    folder = Path(bpy.path.abspath(settings.folder))
    if not folder.is_dir():
        raise ValueError(f"there is no folder {folder} for the journal")
    return folder / pen.journal_name(name, datetime.now()), None


class RIFFLER_OT_pen_sculpt(shared.TakesTool, properties.PenSettings, bpy.types.Operator):
    """Sculpt with a pen or another device, until Esc or until this is called again"""

    bl_idname = "riffler.pen_sculpt"
    bl_label = "Sculpt with Pen"
    bl_options = {"UNDO"}  # not REGISTER: changed settings would make the hand's work again, without the hand

    seconds: bpy.props.FloatProperty(
        name="Seconds",
        min=0.0,
        max=86400.0,
        options={"HIDDEN", "SKIP_SAVE"},
        description="How long it sculpts when it is called from a script",
    )

    @classmethod
    def poll(cls, context):
        return _live is not None or shared.sculpt_poll(cls, context)

    def execute(self, context):
        """For `seconds`, in one go."""
        if _live is not None:
            _live.asked = True
            return {"CANCELLED"}
        if not self.seconds > 0:
            return shared.fail(self, ValueError("seconds: say how long, as there is no window to end it in"))
        if not self._start(context):
            return {"CANCELLED"}
        live, end = _live, time.monotonic() + self.seconds
        try:
            while time.monotonic() < end and live.step(context):
                time.sleep(FRAME)
        except (ValueError, RuntimeError, MemoryError) as error:
            self.report({"WARNING"}, f"The session was ended: {error}")
        finally:
            changed = self._finish(context, live)
        return {"FINISHED"} if changed else {"CANCELLED"}

    def invoke(self, context, event):
        if _live is not None or self.seconds > 0 or bpy.app.background or context.window is None:
            return self.execute(context)
        if not self._start(context):
            return {"CANCELLED"}
        self._session = _live
        _live.timer = context.window_manager.event_timer_add(FRAME, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        live = self._session
        if event.type == "ESC" and event.value == "PRESS":
            live.asked = True
        elif event.type == "Z" and event.value == "PRESS" and (event.ctrl or event.oskey) and not live.done:
            if said := live.go(context, "redo" if event.shift else "undo"):
                self.report({"WARNING"}, said)
            return {"RUNNING_MODAL"}
        elif event.type != "TIMER":
            free = event.type in shared.NAVIGATION or _over_sidebar(context, event)
            return {"PASS_THROUGH"} if free else {"RUNNING_MODAL"}
        try:
            if live.step(context):
                return {"PASS_THROUGH"}
        except (ValueError, RuntimeError, MemoryError) as error:
            self.report({"WARNING"}, f"The session was ended: {error}")
        changed = self._finish(context, live)
        live.drop_timer(context)
        return {"FINISHED"} if changed else {"CANCELLED"}

    def cancel(self, context):
        """Blender calls it when the window closes."""
        self._session.finish(context)
        self._session.drop_timer(context)

    def _start(self, context):
        global _live
        ob = sculpts.active(context)
        try:
            if sculpts.edited(ob.data):
                self.report({"WARNING"}, "The mesh had been edited: the pen starts from the volume, the edits are gone")
            _live = Live(context, ob, self, self.tool_dict(context))
        except (ValueError, TypeError, OSError, RuntimeError, MemoryError) as error:
            shared.fail(self, error)
            return False
        return True

    def _finish(self, context, live):
        try:
            live.finish(context)
        except (ValueError, OSError, RuntimeError, MemoryError) as error:
            shared.fail(self, error)
        if live.message:
            self.report(live.level, live.message)
        return live.pending


def _over_sidebar(context, event):
    """Where the panel's buttons are: they stay usable."""
    for area in context.screen.areas:
        if area.type == "VIEW_3D":
            for r in area.regions:
                if r.type == "UI" and 0 <= event.mouse_x - r.x < r.width and 0 <= event.mouse_y - r.y < r.height:
                    return True
    return False


class RIFFLER_OT_pen_home(bpy.types.Operator):
    """The pen stands in its home posture now: its counters are set"""

    bl_idname = "riffler.pen_home"
    bl_label = "Home"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context):
        return _live is not None or shared.deny(cls, "No pen is sculpting")

    def execute(self, context):
        if not _live.run.device.home():
            return shared.fail(self, ValueError(f"{_live.run.device.kind} has nothing to home"))
        return {"FINISHED"}


class RIFFLER_OT_pen_reset(bpy.types.Operator):
    """Let force through again after it was taken away, once what was wrong is mended"""

    bl_idname = "riffler.pen_reset"
    bl_label = "Clear Trip"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context):
        return _live is not None or shared.deny(cls, "No pen is sculpting")

    def execute(self, context):
        _live.run.session.reset()
        return {"FINISHED"}


@bpy.app.handlers.persistent
def _before_save(*_):
    if _live is not None:
        _live.finish(bpy.context)  # the operator makes the undo step with its next event


@bpy.app.handlers.persistent
def _before_undo(*_):
    """The session becomes a step of its own, which is then the one that is undone, and redone."""
    live = _live
    if live is not None:
        live.finish(bpy.context)
        if live.pending and bpy.ops.ed.undo_push.poll():
            bpy.ops.ed.undo_push(message=RIFFLER_OT_pen_sculpt.bl_label)
            live.pending = False


@bpy.app.handlers.persistent
def _before_load(*_):
    if _live is not None:
        _live.finish(bpy.context, keep=False)


@bpy.app.handlers.persistent
def _after(*_):
    """Undo steps and files that were made while a session ran have its picture."""
    if _live is None:
        preview.sweep()


HANDLERS = {
    "save_pre": _before_save,
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "load_pre": _before_load,
    "undo_post": _after,
    "redo_post": _after,
    "load_post": _after,
}


def attach():
    for when, function in HANDLERS.items():
        getattr(bpy.app.handlers, when).append(function)


def detach():
    live = _live
    if live is not None:
        live.finish(bpy.context)
        live.drop_timer(bpy.context)
    for when, function in HANDLERS.items():
        if function in getattr(bpy.app.handlers, when):
            getattr(bpy.app.handlers, when).remove(function)


CLASSES = (RIFFLER_OT_pen_sculpt, RIFFLER_OT_pen_home, RIFFLER_OT_pen_reset)
