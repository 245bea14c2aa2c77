"""The live sculpts (live_sculpt.py), and the handlers of Blender's events for them."""

import time

import bpy

from ..blender import handlers, refusals
from ..common.contents import Content
from ..common.problems import said
from . import chunks, idle_detection, persistence, sculpt_store, sculpts, undo_states
from .live_sculpt import LiveSculpt, lives
from .undo_states import snapshots

ERRORS = (ValueError, OSError, RuntimeError, MemoryError)
_told = {}  # mark of a sculpt → its last reported problem


def of(ob):
    """The LiveSculpt of that object, or None."""
    # Reading the settings of an object that has none yet creates them, and undo then treats it as changed.
    live = lives.get(ob.riffler.mark) if lives and ob is not None else None
    return live if live is not None and live.awake and live.object == ob else None


def content(ob):
    """The sculpt's current volume, cuts and mask; not to be changed."""
    live = of(ob)
    return sculpt_store.content(ob.data) if live is None else Content(live.volume, live.cuts, live.mask, live.shaped)


def begin(context, ob):
    """The LiveSculpt of that sculpt, made if there is none. One of operator_parts.ERRORS if it cannot be made."""
    refusals.refuse(context, ob)
    live = of(ob)
    if live is not None:
        return live
    for other in awake():  # a sculpt with the same mesh starts from its result
        if other.object is not None and other.object.data == ob.data:
            other.end()
    before = lives.get(ob.riffler.mark)
    if before is not None:  # other operations changed the sculpt, or it is a copy
        before.end()
    live = LiveSculpt(context, ob)
    lives[live.mark] = live
    _watch()
    return live


def awake():
    return [live for live in lives.values() if live.awake]


def end_all():
    """Ends all sessions; call before using the sculpts' meshes. One of ERRORS if one cannot be ended; the
    others are."""
    first = None
    for live in list(lives.values()):
        try:
            live.end()
        except ERRORS as error:
            first = first or error
    if first is not None:
        raise first


def _safely(mark, name, call, *args):
    """Calls a background task for one sculpt: an error affects that sculpt only, and is reported once, since the task
    is repeated. None if it fails."""
    try:
        result = call(*args)
    except ERRORS as error:
        text = f"{name}: {said(error)}"
        if _told.get(mark) != text:
            _told[mark] = text
            undo_states.tell(text)
        return None
    _told.pop(mark, None)
    return result


def _end_safely():
    for live in list(lives.values()):
        _safely(live.mark, live.name, live.end)


def _watch():
    """Starts the timer; timers do not run without a window."""
    if lives and not bpy.app.background and not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=idle_detection.LOOK)


def _look():
    """Timer function, while there are live sculpts. Pauses during a render, which reads what would change."""
    if not bpy.app.is_job_running("RENDER"):
        for live in list(lives.values()):
            _safely(live.mark, live.name, live.look, time.monotonic())
    return idle_detection.LOOK if lives else None


@bpy.app.handlers.persistent
def _before_save(*_):
    _end_safely()


@bpy.app.handlers.persistent
def _after_save(*_):
    persistence.saved()


@bpy.app.handlers.persistent
def _before_render(*_):
    for live in awake():
        _safely(live.mark, live.name, live.commit)


@bpy.app.handlers.persistent
def _before_load(*_):
    """The other file may fail to open, and then this one stays: everything is kept."""
    _end_safely()


@bpy.app.handlers.persistent
def _after_load(*_):
    """The other file is open. It may be an autosave, with unfinished work."""
    for live in list(lives.values()):
        live.forget()
    persistence.leave()
    lives.clear()
    snapshots.clear()
    _told.clear()
    for ob in bpy.data.objects:
        if ob.riffler.token and sculpts.is_sculpt(ob) and not (ob.library or ob.data.library):
            _settle(ob)
    chunks.sweep()
    persistence.crashed(look=True)


def _settle(ob):
    """Makes the sculpt what is packed: the last state, or an older one, which is reported."""
    token, ob.riffler.token = ob.riffler.token, ""
    try:
        sculpts.refill(ob.data, sculpts.shown_mm_per_unit(ob.data))
    except ValueError as error:
        undo_states.tell(str(error))
        return
    if sculpt_store.token(ob.data) != token:
        undo_states.tell(f"{ob.name} is as last saved: later strokes are in its journal, if there is one")


@bpy.app.handlers.persistent
def _before_undo(*_):
    """Makes what a device has cut so far a step, which this undo then undoes."""
    for live in awake():
        if live.device is not None:
            live.device.before_undo()


@bpy.app.handlers.persistent
def _after_undo(*_):
    for mark, live in list(lives.items()):
        if not _safely(mark, live.name, live.follow):
            live.forget()
            del lives[mark]
    for mark in chunks.shown():
        if mark not in lives:
            _safely(mark, "A sculpt", _revive, mark)
    _watch()


def _revive(mark):
    """Chunks without a session came back: the session continues if its state is still known, otherwise the sculpt is
    what is packed."""
    ob = sculpts.marked(mark)
    if ob is not None:
        state = undo_states.state_of(ob)
        if state is not None:
            lives[mark] = LiveSculpt.revived(ob, state)
            return
        if ob.riffler.token:
            _settle(ob)
    chunks.sweep(mark)


HANDLERS = {
    "save_pre": _before_save,
    "save_post": _after_save,
    "render_init": _before_render,
    "load_pre": _before_load,
    "load_post": _after_load,
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "undo_post": _after_undo,
    "redo_post": _after_undo,
}


def attach():
    handlers.listen(HANDLERS)


def detach():
    handlers.ignore(HANDLERS)  # first: ending the sessions below changes objects
    handlers.stop(_look)
    try:
        _end_safely()
    finally:
        _told.clear()
        persistence.leave()
        snapshots.clear()


CLASSES = ()
