"""What is kept of a live sculpt beside memory: its packing in the .blend, and its journal for a crash.

Blender's autosave and quit.blend write the last undo step and call no handler, so what they are to have must be there
when a stroke ends. A small sculpt is packed then. Of a large one the image has the state of the last rest, and says
which that is; the strokes since are in the journal (docs/decisions.md).

A journal goes once the file is saved, or is left on purpose: until then a crash would take what is in it.
"""

import time

import bpy
from riffler import tasks

from ..blender import preferences_access
from ..common.packing import Packing
from . import sculpt_store
from .pure import journal

AGAIN = 10.0  # s from a journal that could not be begun to the next attempt

_open = []  # journals of work that goes on
_crashed = None  # what was found, once somebody has looked
_parked = []  # journals of work that has ended, and locks on those that were recovered, until the file is saved


def folder():
    """Where journals are; the first makes it. FileNotFoundError where the chosen one is gone."""
    return preferences_access.target("journals")


class Persistence:
    """Of the sculpt `name`, whose state at the beginning is `token`."""

    def __init__(self, ob, token):
        self._about = {"mark": ob.riffler.mark}
        self._packing = Packing(sculpt_store.nbytes(ob.data), time.monotonic())
        self._task = None  # (token, tasks): of the bytes that will be packed
        self.packed = token if sculpt_store.token(ob.data) == token else ""  # the state that the image has
        self.journal, self.problem, self._tried = None, "", -AGAIN

    # ------------------------------------------------------------------ strokes
    def begin_stroke(self, ob, token, content):
        """`content` is the state `token`, in which the stroke begins."""
        j = self.journal
        if j is not None and not j.problem and j.whole and j.go(token):
            return
        now = time.monotonic()
        if now - self._tried < AGAIN and self.problem:
            return
        self._tried, self.problem = now, ""
        self._begin(lambda *about: journal.LiveJournal(folder(), content, token, *about), ob, token)

    def _begin(self, make, ob, token):
        about = {**self._about, "name": ob.name, "file": bpy.data.filepath, "blender": bpy.app.version_string}
        about["matrix"] = [list(row) for row in ob.matrix_world]
        about["mm_per_unit"] = ob.data.riffler.mm_per_unit
        identity = sculpt_store.identity(ob.data) if self.packed == token else ""
        try:
            begun = make(identity, about)
        except journal.PROBLEMS as error:
            self.problem = str(error)
            return
        if self.journal is not None:
            _park(self.journal)
        self.journal = begun
        _open.append(begun)

    # ------------------------------------------------------------------ strokes that a device's session writes itself
    def begin_session(self, ob, token, content, session):
        """`session` has not started; until `end_session` its journal is the one."""
        before, self.journal, self.problem = self.journal, None, ""
        if before is not None:  # it does not have what the session does
            _park(before)
        self._begin(lambda *about: journal.SessionJournal(session, folder(), content, token, *about), ob, token)
        if self.journal is not None:
            _settle(self.journal)

    def made(self, strokes):
        """So many more strokes of the session, on the way to the next state."""
        self._packing.stroke(time.monotonic())
        if isinstance(self.journal, journal.SessionJournal):
            self.journal.made(strokes)

    def end_session(self):
        """The folder of its journal, or None."""
        ended, self.journal = self.journal, None
        if not isinstance(ended, journal.SessionJournal):
            self.journal = ended
            return None
        ended.stopped()
        _park(ended)
        return ended.folder

    def carved(self, tool, poses, mode, token, strength):
        self._packing.stroke(time.monotonic())
        if self.journal is not None:
            self.journal.carved(tool, poses, mode, token, strength)

    def cancelled(self):
        if self.journal is not None:
            self.journal.cancel()

    def finished(self, ob, content, token):
        """The stroke has made `content`. What is small is packed with it, so that it is in the step of the undo."""
        self._packing.stroke(time.monotonic())
        if self.journal is not None:
            self.journal.finish(token)
            self.journal.settled()
            self.problem = self.problem or self.journal.problem
            if not self.journal.whole:  # the next begins with what this stroke has made
                self.begin_stroke(ob, token, content)
        if self._packing.at_once:
            begin = time.perf_counter()
            self._pack(ob, content, token, sculpt_store.blocks(content), begin)

    def went(self, token):
        """Undo or redo has brought this state."""
        self._task = None
        if self.journal is not None:
            self.journal.go(token)

    # ------------------------------------------------------------------ while the hand rests
    def look(self, ob, content, token):
        """True where the image was written."""
        now = time.monotonic()
        if self.journal is not None:
            _settle(self.journal)
        if self._task is None:
            if token == self.packed or not self._packing.due(now):
                return False
            made = [tasks.to_bytes(v) for v in (content.volume, content.mask) if v is not None]
            self._task = token, made
            if self.journal is not None:
                self.journal.sync()
        of, made = self._task
        if of != token:
            self._task = None
            return False
        if not all(task.done for task in made):
            return False
        self._task = None
        begin = time.perf_counter()
        volume, mask = [*(task.result() for task in made), b""][:2]
        self._pack(ob, content, token, (volume, mask), begin)
        return True

    def _pack(self, ob, content, token, blocks, begin):
        nbytes = sculpt_store.write(ob.data, content, token, blocks)
        self.packed = token
        self._packing.done(nbytes, time.perf_counter() - begin, time.monotonic())

    # ------------------------------------------------------------------ the end
    def end(self, identity=""):
        """The journal stays until the file, which has what was made under `identity`, is saved."""
        self._task = None
        if self.journal is not None:
            self.journal.ended = identity
            _park(self.journal)
            self.journal = None


def crashed(look=False):
    """Journals that no process holds, the newest first: as they were when a file was opened, or with `look` as they are
    now."""
    global _crashed
    if look or _crashed is None:
        try:
            found = [f for place in preferences_access.folders("journals") for f in journal.crashed(place)]
            _crashed = sorted(found, key=lambda f: f.when, reverse=True)
        except OSError as error:
            print(f"Riffler: cannot search for journals: {error}")
            _crashed = []
    return _crashed


def _settle(begun):
    """Once what a journal began on is in its folder, those before it are not needed."""
    if begun.settled() and not begun.problem:
        for other in [p for p in _parked if isinstance(p, journal.StrokeJournal)]:
            if other.token == begun.first or (other.ended and other.ended == begun.base):
                _parked.remove(other)
                other.delete()


def _park(thing):
    if thing in _open:
        _open.remove(thing)
    _parked.append(thing)


def park(lock, made):
    """The journal that is locked was recovered: it goes when the file is saved with what it `made`, an identity."""
    lock.made = made
    _park(lock)


def told(token):
    """The content of a state that memory does not have any more, from a journal; None where none knows it."""
    for begun in [k for k in (*_open, *_parked) if isinstance(k, journal.StrokeJournal)]:
        try:
            content = begun.state(token)
        except journal.PROBLEMS as error:
            print(f"Riffler: a journal could not be read: {error}")
            continue
        if content is not None:
            return content
    return None


def saved():
    """The file has it all. What was recovered and then undone it has not: that is offered again."""
    there = {sculpt_store.identity(mesh) for mesh in bpy.data.meshes if mesh.riffler.store is not None}
    if _drop(lambda lock: lock.made in there):
        crashed(look=True)


def leave():
    """The file was left on purpose, and its work with it; what an earlier Blender has left is still nobody's."""
    _drop(lambda lock: False)


def _drop(done):
    """Deletes the journals, but for those that were recovered and are not `done`: they are anybody's again. True where
    there are such."""
    released = False
    while _parked:
        thing = _parked.pop()
        try:
            if isinstance(thing, journal.Lock) and not done(thing):
                thing.release()
                released = True
            else:
                thing.delete()
        except OSError as error:
            print(f"Riffler: a journal could not be deleted: {error}")
    return released
