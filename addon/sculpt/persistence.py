"""How a live sculpt persists outside memory: packed in the .blend, and in a journal for a crash.

Blender's autosave and quit.blend write the last undo step and call no handler, so their data must be ready when a
stroke ends. A small sculpt is packed then. For a large one the image has the state of the last rest, with its token;
later strokes are in the journal (docs/decisions.md).

A journal is deleted once the file is saved, or is closed on purpose: until then a crash would lose its strokes.
"""

import time

import bpy
import riffler

from ..blender import preferences_access
from ..common.packing import Packing
from . import sculpt_store
from .pure import journal

AGAIN = 10.0  # s from a journal that could not be started to the next attempt

_open = []  # journals of running sessions
_crashed = None  # the journals found, once searched
_parked = []  # journals of ended sessions, and locks on recovered ones, until the file is saved


def folder():
    """The folder for journals; makes the default one. FileNotFoundError if the chosen one no longer exists."""
    return preferences_access.target("journals")


class Persistence:
    """Persistence of the sculpt `name`, whose initial state is `token`."""

    def __init__(self, ob, token):
        self._about = {"mark": ob.riffler.mark}
        self._packing = Packing(sculpt_store.nbytes(ob.data), time.monotonic())
        self._task = None  # (token, tasks) that make the bytes to pack
        self.packed = token if sculpt_store.token(ob.data) == token else ""  # the state in the image
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
        """`session` has not started; until `end_session` its journal is used."""
        before, self.journal, self.problem = self.journal, None, ""
        if before is not None:  # it does not contain the session's strokes
            _park(before)
        self._begin(lambda *about: journal.SessionJournal(session, folder(), content, token, *about), ob, token)
        if self.journal is not None:
            _settle(self.journal)

    def made(self, strokes):
        """Counts further strokes of the session, towards the next state."""
        self._packing.stroke(time.monotonic())
        if isinstance(self.journal, journal.SessionJournal):
            self.journal.made(strokes)

    def end_session(self):
        """Returns the folder of its journal, or None."""
        ended, self.journal = self.journal, None
        if not isinstance(ended, journal.SessionJournal):
            self.journal = ended
            return None
        ended.stopped()
        _park(ended)
        return ended.folder

    def carved(self, tool, poses, mode, token, **options):
        """`options`: Brush.options."""
        self._packing.stroke(time.monotonic())
        if self.journal is not None:
            self.journal.carved(tool, poses, mode, token, **options)

    def cancelled(self):
        if self.journal is not None:
            self.journal.cancel()

    def finished(self, ob, content, token):
        """The stroke has made `content`. A small sculpt is packed at once, so that the undo step includes it."""
        self._packing.stroke(time.monotonic())
        if self.journal is not None:
            self.journal.finish(token)
            self.journal.settled()
            self.problem = self.problem or self.journal.problem
            if not self.journal.whole:  # the next journal begins with this stroke's result
                self.begin_stroke(ob, token, content)
        if self._packing.at_once:
            begin = time.perf_counter()
            self._pack(ob, content, token, sculpt_store.blocks(content), begin)

    def recut(self):
        """The state was made from kept strokes: the next stroke begins a journal with it, and it is packed when the
        hand rests."""
        self._packing.stroke(time.monotonic())
        self._task, self.packed = None, ""
        if self.journal is not None:
            self.journal.whole = False

    def went(self, token):
        """Undo or redo has restored this state."""
        self._task = None
        if self.journal is not None:
            self.journal.go(token)

    # ------------------------------------------------------------------ while the hand rests
    def look(self, ob, content, token):
        """Packs if it is due; True if the image was written."""
        now = time.monotonic()
        if self.journal is not None:
            _settle(self.journal)
        if self._task is None:
            if token == self.packed or not self._packing.due(now):
                return False
            made = [riffler.submit(riffler.Volume.to_bytes, v) for v in (content.volume, content.mask) if v is not None]
            self._task = token, made
            if self.journal is not None:
                self.journal.sync()
        of, made = self._task
        if of != token:
            self._task = None
            return False
        if not all(task.done() for task in made):
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
        """Ends the session. The journal stays until the file, which has its result under `identity`, is saved."""
        self._task = None
        if self.journal is not None:
            self.journal.ended = identity
            _park(self.journal)
            self.journal = None


def crashed(look=False):
    """Journals that no process holds, the newest first: found when a file was opened, or with `look` found
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
    """Drops older journals once this journal's initial state is in its folder."""
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
    """The locked journal was recovered: it is deleted when the file is saved with its result `made`, an identity."""
    lock.made = made
    _park(lock)


def told(token):
    """The content of a state that is no longer in memory, from a journal; None if no journal has it."""
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
    """The file was saved with everything, except recovered sculpts whose recovery was undone: their journals are
    offered again."""
    there = {sculpt_store.identity(mesh) for mesh in bpy.data.meshes if mesh.riffler.store is not None}
    if _drop(lambda lock: lock.made in there):
        crashed(look=True)


def leave():
    """The file was closed on purpose, and its sessions with it; journals of an earlier Blender stay available."""
    _drop(lambda lock: False)


def _drop(done):
    """Deletes the journals, except recovered ones that are not `done`, which become available again. True if there are
    such."""
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
