"""Recovers or discards the journals of a Blender that has crashed."""

import bpy
import riffler
from mathutils import Matrix

from ..blender import long_work, operator_parts, scene_units
from ..common import units
from ..common.contents import Content
from ..common.job import TaskJob
from ..sculpt import live_registry, persistence, sculpt_store, sculpts
from ..sculpt.pure import journal


class TakesJournal:
    """Mixin of operators on a journal that no process has locked."""

    journal: bpy.props.StringProperty(
        name="Journal", options={"SKIP_SAVE"}, description="Name of the journal's folder; empty: the newest journal"
    )

    @classmethod
    def poll(cls, context):
        if not operator_parts.object_mode(cls, context) or operator_parts.busy(cls, context):
            return False
        return bool(persistence.crashed()) or operator_parts.deny(
            cls, "There is nothing to recover: no session was interrupted"
        )

    def take(self):
        """The journal, locked. ValueError if another process has it."""
        found = [f for f in persistence.crashed(look=True) if self.journal in ("", f.folder.name)]
        if not found:
            raise ValueError(f"no journal {self.journal} can be recovered".replace("  ", " "))
        lock = journal.Lock(found[0].folder)
        if not lock.held:
            raise ValueError(f"the journal of {found[0].name} is being recovered by another Blender")
        return found[0], lock


class RIFFLER_OT_recover(TakesJournal, long_work.LongWork, bpy.types.Operator):
    """Restore a sculpt from its journal after a crash, in this file's sculpt or in a new object"""

    bl_idname = "riffler.recover"
    bl_label = "Recover Sculpt"
    bl_options = {"REGISTER", "UNDO"}

    doing = "Recovering"
    cancelled = "Recovery cancelled: the journal is still there"
    _lock = None

    def begin(self, context):
        live_registry.end_all()
        self._found, self._lock = self.take()
        try:
            strokes, self._cuts, self._shaped, self._states = _prepared(self._found)
            task = riffler.submit(riffler.Journal.replay_with_mask, strokes, self._found.folder)
        except BaseException:
            self._lock.release()
            raise
        return TaskJob(task, units.counted(len(strokes.strokes), "stroke"))

    def cancel(self, context):
        super().cancel(context)
        if self._lock is not None:
            self._lock.release()

    def finish(self, context, job):
        volume, mask = job.result
        content = Content(volume, self._cuts, mask, self._shaped)
        about = self._found.about
        ob = _target(about, self._states)
        try:
            if ob is not None:
                sculpts.commit(ob.data, content, sculpts.shown_mm_per_unit(ob.data))
            else:
                ob = _new(context, self._found.name, content, about)
        except BaseException:
            self._lock.release()
            raise
        persistence.park(self._lock, sculpt_store.identity(ob.data))
        persistence.crashed(look=True)
        context.window_manager.riffler.notice = ""
        self.report({"INFO"}, f"{ob.name} is restored to its state before the crash: save the file")
        return {"FINISHED"}


def _prepared(found):
    """(journal of the strokes still to be made, which start from a snapshot in its folder; all cuts; whether other
    operations have changed the sculpt too; tokens of the journal's states from first to last)."""
    try:
        strokes, cuts = journal.part_of(found.folder)
    except ValueError as error:
        raise ValueError(f"the journal of {found.name} is kept, but cannot be read: {error}") from error
    if not strokes.strokes:
        raise ValueError(f"the journal of {found.name} has no strokes: discard it")
    shaped, states = journal.shaped(found.folder, strokes), journal.states(found.folder, found.about, strokes)
    if not (found.folder / journal.STOCK).exists() and strokes.stock and strokes.stock.snapshot == journal.STOCK:
        strokes = _on_what_the_file_has(found, strokes, states)
    return strokes, cuts, shaped, states


def _on_what_the_file_has(found, strokes, states):
    """Used if the crash came before the journal's initial state was written: this file may have it or a later one."""
    for ob in filter(sculpts.is_sculpt, bpy.data.objects):
        state = _state(ob, found.about, states)
        if state:
            done = len(states) - 1 - states[::-1].index(state)
            return _rest(found.folder, strokes, done, sculpt_store.content(ob.data))
    raise ValueError(
        f"the journal of {found.name} has no stock: open the file that it belongs to, {found.about.get('file') or '?'}"
    )


def _rest(folder, strokes, done, content):
    """The strokes after the first `done`, on `content`."""
    content.volume.save(folder / journal.STOCK)
    if content.mask is not None:
        content.mask.save(folder / journal.MASK)
    v, out = content.volume, riffler.Journal()
    mask = journal.MASK if content.mask is not None else ""
    out.set_stock(v.lower, v.upper, v.pitch, v.directions, snapshot=journal.STOCK, mask=mask)
    for number, tool in strokes.tools.items():
        out.add_tool(number, tool)
    for stroke in strokes.strokes[done:]:
        journal.add_again(out, stroke)
    return out


def _state(ob, about, states):
    """Token of the journal's state in which the sculpt is in this file, or ""."""
    if about.get("base") and sculpt_store.identity(ob.data) == about["base"]:
        return states[0]
    return sculpt_store.token(ob.data) if sculpt_store.token(ob.data) in states else ""


def _target(about, states):
    """The sculpt that is in one of the journal's states in this file, or None if other operations have changed it
    since. Copies that share the state are ignored if the original exists."""
    found = [ob for ob in bpy.data.objects if sculpts.is_sculpt(ob) and _state(ob, about, states)]
    found = [ob for ob in found if not (ob.library or ob.data.library)]
    return next((ob for ob in found if ob.riffler.mark == about.get("mark")), found[0] if found else None)


def _new(context, name, content, about):
    here = scene_units.mm_per_unit(context.scene)
    matrix = Matrix(about.get("matrix") or Matrix.Identity(4))
    matrix.translation *= about.get("mm_per_unit", here) / here
    return sculpts.new_object(context, name, content, matrix, here)


class RIFFLER_OT_discard_journal(TakesJournal, bpy.types.Operator):
    """Delete the journal of an interrupted session; its strokes are lost"""

    bl_idname = "riffler.discard_journal"
    bl_label = "Discard"
    bl_options = {"INTERNAL"}

    def invoke(self, context, event):
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, context):
        try:
            found, lock = self.take()
            lock.delete()
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        persistence.crashed(look=True)
        self.report({"INFO"}, f"The journal of {found.name} is deleted")
        return {"FINISHED"}


class RIFFLER_OT_dismiss(bpy.types.Operator):
    """Hide this notice"""

    bl_idname = "riffler.dismiss"
    bl_label = "Dismiss"
    bl_options = {"INTERNAL"}

    def execute(self, context):
        context.window_manager.riffler.notice = ""
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_recover, RIFFLER_OT_discard_journal, RIFFLER_OT_dismiss)
