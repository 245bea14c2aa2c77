"""Which live sculpts (live_sculpt.py) there are, and what Blender's events mean for them."""

import time

import bpy

from ..blender import handlers, refusals
from ..common.contents import Content
from ..common.problems import said
from . import chunks, idle_detection, persistence, sculpt_store, sculpts, undo_states
from .live_sculpt import LiveSculpt, lives
from .undo_states import snapshots

ERRORS = (ValueError, OSError, RuntimeError, MemoryError)
_told = {}  # mark of a sculpt → what went wrong with it last


def of(ob):
    """The LiveSculpt of that object, or None where it has none."""
    # To ask an object that has none yet for its settings gives it some, and undo takes it for another one.
    live = lives.get(ob.riffler.mark) if lives and ob is not None else None
    return live if live is not None and live.awake and live.object == ob else None


def content(ob):
    """The sculpt's volume, cuts and mask, as they are now; not to be changed."""
    live = of(ob)
    return sculpt_store.content(ob.data) if live is None else Content(live.volume, live.cuts, live.mask, live.shaped)


def begin(context, ob):
    """The LiveSculpt of that sculpt, made where there is none. One of operator_parts.ERRORS where it cannot be."""
    refusals.refuse(context, ob)
    live = of(ob)
    if live is not None:
        return live
    for other in awake():  # what shares the mesh goes on with what was done to it
        if other.object is not None and other.object.data == ob.data:
            other.end()
    before = lives.get(ob.riffler.mark)
    if before is not None:  # the sculpt was changed by other means, or is the copy of one
        before.end()
    live = LiveSculpt(context, ob)
    lives[live.mark] = live
    _watch()
    return live


def awake():
    return [live for live in lives.values() if live.awake]


def end_all():
    """Whatever needs the sculpts themselves calls it first. One of ERRORS where one cannot be ended; the others are."""
    first = None
    for live in list(lives.values()):
        try:
            live.end()
        except ERRORS as error:
            first = first or error
    if first is not None:
        raise first


def _safely(mark, name, call, *args):
    """Calls what nobody has asked for: it fails for one sculpt only, and that is told once, as it is tried again and
    again. None where it fails."""
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
    """Timers do not run without a window."""
    if lives and not bpy.app.background and not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=idle_detection.LOOK)


def _look():
    """Of the timer, while there is work. A render reads what would be changed."""
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
    """Nobody knows yet whether the other file can be opened: where it cannot, this one stays, and has it all."""
    _end_safely()


@bpy.app.handlers.persistent
def _after_load(*_):
    """The other file is there. It may be an autosave, with work in it."""
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
    """The sculpt is what is packed: the last state, or an older one, which is said."""
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
    """What a device has cut up to now is a step, too: the one that is undone."""
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
    """Chunks that nobody works at came back: the work goes on if its state is still known, and otherwise the sculpt is
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
    handlers.ignore(HANDLERS)  # first: ending the work below changes objects
    handlers.stop(_look)
    try:
        _end_safely()
    finally:
        _told.clear()
        persistence.leave()
        snapshots.clear()


CLASSES = ()
