"""A live sculpt: a volume that changes stroke by stroke, shown in chunks, each stroke one of Blender's own undo steps.

A stroke ends with a new token on the object; the state that it names stays in memory (undo_states.py). Undo and redo
bring back the token and the chunks' meshes, and `follow` brings the volume. So a step costs what Blender takes for its
objects, whatever the size of the sculpt. The sculpt's own mesh and the data in the file follow when they are needed:
when the work ends, before the file is saved, when an operator wants the sculpt. Packing and journal: persistence.py.

The work ends by itself once no window has the sculpt and one of its tools (idle_detection.py). A timer looks; nothing
modal runs between strokes, since Blender makes no autosave while something does.
"""

import uuid

import bpy
import numpy as np
import riffler

from ..blender import refusals, versions
from ..common import blocks
from ..common.contents import Content
from ..common.job import cuts_of
from ..common.poses import moving
from . import chunks, idle_detection, persistence, sculpt_store, sculpts
from .pure import reach, symmetry
from .pure.stages import Stages
from .undo_states import SPARE, State, snapshots, state_of

lives = {}  # by the mark of the object (sculpts.new_mark); sculpt/live_registry.py keeps it


class LiveSculpt:
    """Of the sculpt `ob`. ValueError, MemoryError where it cannot be; then nothing has changed."""

    def __init__(self, context, ob):
        if why := refusals.linked(ob, ob.data):
            raise ValueError(why)
        content = sculpt_store.content(ob.data)
        sculpts.new_mark(ob)
        self._take(ob, content)
        self._mesher = riffler.Mesher(self.volume)
        self.chunks = chunks.Chunks(context, ob, self._mesher.shape, self.mm)
        try:
            self.chunks.update(self._mesher, self._mesher.patches(), self.mask)
        except Exception:
            chunks.sweep(self.mark, self.name)
            raise
        self._remember(ob)
        if not ob.data.riffler.store.library:
            sculpt_store.mark_state(ob.data, self.token)
        self.persistence = persistence.Persistence(ob, self.token)

    @classmethod
    def revived(cls, ob, state):
        """Of a sculpt whose chunks an undo has brought back after the work at it had ended."""
        self = cls.__new__(cls)
        self._take(ob, state.content)
        self.chunks = chunks.Chunks.found(ob, state.shape, self.mm)
        self.token = ob.riffler.token
        self.persistence = persistence.Persistence(ob, self.token)
        versions.lighten(ob.data)
        self._show(state)
        self.chunks.hide_tool()
        return self

    def _take(self, ob, content):
        self.mark, self.name, self.mm = ob.riffler.mark, ob.name, sculpts.shown_mm_per_unit(ob.data)
        self._identities = {sculpt_store.identity(ob.data)}  # under which the file has states of this work
        self.stages = Stages()
        self.volume, self.mask, self.cuts = content.volume.copy(), _copy(content.mask), list(content.cuts)
        self.shaped = content.shaped  # by other means than cuts
        self._mesher, self._stale = None, False  # stale: it has another state than the volume
        self.maps, self.centre = symmetry.maps(), sculpts.middle(ob.data, self.volume)
        self.strength = 0.5  # of dabs that soften
        self.keep_out = None  # of the copies by symmetry, as BrushStroke's
        self._apart = set()  # copies whose last moves were kept out
        self.awake, self._away = True, idle_detection.IdleClock()
        self._strokes, self._begin = [], None  # of the stroke that is being made
        self.cut_off = False  # whether the box has cut off what this stroke, or this session, put on
        self._outline = None, None  # a tool, and its cutter's
        self._masked, self._painted = [], []  # where the mask has changed since the last look, and in this stroke
        self._reached, self._swept = [], []  # what tools have swept since the last look, and in this stroke
        self.token = ""
        self._facts = None  # (token, of it)
        self._objects = -1  # in the file, when copies were last looked for
        self.device = None  # pen/session.PenSession, while one sculpts this

    # ------------------------------------------------------------------ where things are
    @property
    def object(self):
        """The sculpt, as long as it is the one that this was begun with and nothing else has changed it; otherwise
        None."""
        ob = sculpts.marked(self.mark, self.name)
        if ob is None or not ob.users or sculpt_store.identity(ob.data) not in self._identities:
            return None
        self.name = ob.name
        return ob

    @property
    def to_mm(self):
        """(4, 4): Blender units in the world → mm in the sculpt's frame."""
        return sculpts.from_world(self.object)

    @property
    def to_world(self):
        """(4, 4): mm in the sculpt's frame → Blender units in the world."""
        return np.linalg.inv(self.to_mm)

    @property
    def mesher(self):
        """riffler.Mesher of the volume as it is: undo alone does not need it, the next stroke does."""
        if self._mesher is None:
            self._mesher = riffler.Mesher(self.volume)
        elif self._stale:
            self._mesher.update(self.volume)
        self._stale = False
        return self._mesher

    @property
    def facts(self):
        """sculpts.facts of the state at the end of the last stroke: counted once for each."""
        if self._facts is None or self._facts[0] != self.token:
            self._facts = self.token, sculpts.facts(Content(self.volume, self.cuts, self.mask))
        return self._facts[1]

    # ------------------------------------------------------------------ a stroke
    def freeze(self):
        """The surface as it is now, for picking while the stroke changes it."""
        return self.mesher.freeze()

    def begin_stroke(self):
        _ = self.mesher  # has to know what is shown before it changes
        ob = self.object
        if ob is None:
            raise ValueError(f"{self.name} was changed or removed meanwhile")
        self._strokes, self._painted, self._swept, self.cut_off = [], [], [], False
        self._apart.clear()
        self._begin = self.volume.copy(), _copy(self.mask)
        self._next = uuid.uuid4().hex  # the token of the state that the stroke makes
        versions.lighten(ob.data)
        self.persistence.begin_stroke(ob, self.token, Content(self._begin[0], self.cuts, self._begin[1], self.shaped))

    def begin_device_stroke(self):
        """What a device has begun to take belongs to a stroke."""
        content = snapshots.get(self.token).content
        self._strokes, self._painted = [], []
        self._begin, self._next = (content.volume.copy(), _copy(content.mask)), uuid.uuid4().hex
        versions.lighten(self.object.data)

    @property
    def in_stroke(self):
        return self._begin is not None

    def give_up(self):
        """What a device has taken since the last state is there again."""
        if not self.in_stroke:
            self.begin_device_stroke()
        self.cancel_stroke()

    def took(self, tool, rows, mode):
        """The poses, (n, 6), of a stroke with `tool`, a dictionary, that a device has made."""
        if mode == "add":
            self._reach_out(riffler.Tool.from_dict(tool), rows)
        self._strokes.append((0, tool, mode, [rows]))

    def carve(self, tool, poses, dt=None, mode="remove", new=True):
        """Carves the poses, (n, 6), and their copies by symmetry. `new`: they do not go on from the last ones. Returns
        riffler.Cut of the poses themselves, but for those that stand; of "soften", dabs at the tips as wide as the
        tool, None."""
        if mode == "unmask" and self.mask is None:
            return None
        if self._begin is None:
            self.begin_stroke()
        first, poses = None, np.asarray(poses, float)
        if mode == "soften":
            poses = poses[0 if new else 1 :]  # the first was dabbed with the last ones
            if not len(poses):
                return None
        else:
            poses, dt = moving(poses, dt)
        with self.stages.of("cut"):
            for k, copy in enumerate(symmetry.copies(poses, self.maps, self.centre)):
                copy = self._kept_out(k, copy)
                if copy is None:
                    continue
                cut = self._cut(tool, copy, dt if k == 0 else None, mode)
                if mode == "add":
                    self._reach_out(tool, copy)
                first = first or cut
                self.persistence.carved(tool.to_dict(), copy, mode, self._next, self.strength)
                self._note(tool, copy, mode, new or k in self._apart, k)
                self._apart.discard(k)
        self.stages.count(moves=max(len(poses) - 1, 0))
        return first

    def _reach_out(self, tool, poses):
        if self._outline[0] is not tool:
            self._outline = tool, reach.outline_of(tool)
        self.cut_off |= reach.is_cut_off(self._outline[1], poses, self.volume)

    def _kept_out(self, k, poses):
        """A copy's poses, clear of the fixtures; None where nothing of it is. The first is no copy: it is clear."""
        if k == 0 or self.keep_out is None:
            return poses
        kept = self.keep_out(poses, np.ones(len(poses) - 1))
        if kept is None:
            self._apart.add(k)
            return None
        return moving(kept[0])[0]

    def _cut(self, tool, poses, dt, mode):
        if mode in ("mask", "unmask"):
            if self.mask is None:
                v = self.volume
                self.mask = riffler.Volume.empty(v.lower, v.upper, v.pitch, v.directions)
            self._masked.append(self._reach(tool, poses))
            self._painted.append(self._masked[-1])
            return self.mask.carve(tool, poses, dt=dt, mode="add" if mode == "mask" else "remove")
        self._reached.append(self._reach(tool, poses))
        self._swept.append(self._reached[-1])
        if mode == "soften":
            self.volume.soften(poses[:, :3], 0.5 * tool.diameter, self.strength, self.mask)
            return None
        return self.volume.carve(tool, poses, dt=dt, mode=mode, protect=self.mask)

    def _reach(self, tool, poses):
        """(lower, upper) of what the cutter may touch, in rays."""
        ends = np.vstack([poses[:, :3], poses[:, :3] + tool.length * poses[:, 3:]])
        lower, upper = ends.min(axis=0) - tool.diameter / 2, ends.max(axis=0) + tool.diameter / 2
        return (lower - self.volume.lower) / self.volume.pitch, (upper - self.volume.lower) / self.volume.pitch

    def _note(self, tool, poses, mode, new, copy):
        """Among the cuts, where it can be cut again: what is protected is in the mask."""
        if mode == "soften":  # which no cut tells
            self._strokes.append((copy, {}, mode, []))
        if mode not in ("remove", "add"):
            return
        if not new:
            for stroke in reversed(self._strokes):
                if stroke[0] == copy and stroke[2] == mode:
                    stroke[3].append(poses[1:])
                    return
        self._strokes.append((copy, tool.to_dict(), mode, [poses]))

    def show(self):
        """Meshes what has changed since the last time, and fills the chunks that it is in."""
        with self.stages.of("mesh"):
            bricks = self.mesher.update(self.volume)
        for rays in self._masked:  # the surface is the same there, but not its colour
            bricks = sorted({*bricks, *blocks.within(self._mesher.shape, *rays)})
        bricks = self._with_borders(bricks)
        self._masked, self._reached = [], []
        with self.stages.of("transfer"):
            self.chunks.update(self._mesher, bricks, self.mask, self.stages)
            self.chunks.place(self.object.matrix_world)
        self.stages.looked()

    def _with_borders(self, bricks):
        """And those whose triangles are the same, but whose normals at the border to a changed one are others."""
        if not versions.OWN_NORMALS or not len(bricks):
            return bricks
        shape = self._mesher.shape
        swept = {b for reach in self._reached for b in blocks.within(shape, *reach)}
        return sorted({*bricks, *(swept & blocks.beside(shape, bricks))})

    def finish_stroke(self, context, label=""):
        """What was carved since `begin_stroke` is a state of its own. The caller's operator makes the undo step; a
        caller that has none gives it a `label`. False where nothing has changed."""
        begin, self._begin = self._begin, None
        if begin is None or (begin[0].revision == self.volume.revision and _revision(begin[1]) == _revision(self.mask)):
            return False
        self.cuts = [*self.cuts, *cuts_of(self._strokes, self.mask is not None)]
        self.shaped |= any(mode == "soften" for _, _, mode, _ in self._strokes)
        self.show()
        ob = self.object
        self._remember(ob, self._next)
        self.persistence.finished(ob, snapshots.get(self.token).content, self.token)
        self._identities.add(sculpt_store.identity(ob.data))
        if label:
            bpy.ops.ed.undo_push(message=label)
        return True

    def cancel_stroke(self):
        begin, self._begin = self._begin, None
        if begin is not None:
            self.volume, self.mask = begin
            self._masked, self._reached = self._painted, self._swept
            self.persistence.cancelled()
            self.show()

    def _content(self):
        return Content(self.volume.copy(), self.cuts, _copy(self.mask), self.shaped)

    def _remember(self, ob, token=""):
        before, self.token = self.token, token or uuid.uuid4().hex
        content = self._content()
        state = State(content, tuple(self._mesher.shape), dict(self.chunks.fillings))
        snapshots.most = bpy.context.preferences.edit.undo_steps + SPARE
        snapshots.hold({other.token for other in lives.values()})
        snapshots.put(self.token, state, replaces=before)
        ob.riffler.token = self.token

    # ------------------------------------------------------------------ undo
    def follow(self):
        """After an undo or a redo: this shows what Blender has brought back. False where it cannot."""
        ob = self.object
        if ob is None:
            return False
        was, self.awake, self._begin = self.awake, self.chunks.there, None
        if was != self.awake:
            self.chunks.outline(was)
        if not self.awake:
            if self.device is not None:
                self.device.drop()
            return True  # redo may bring it again
        state = state_of(ob)
        if state is None:
            return False
        dropped = self.device is not None and not self.chunks.tool_there  # its beginning was undone
        if dropped:
            self.device.drop()
        if dropped or self.device is not None or ob.riffler.token != self.token:
            self._bring(state.content, ob.riffler.token)
        self.persistence.went(self.token)
        self._show(state)
        if self.device is None:
            self.chunks.hide_tool()
        return True

    def _bring(self, content, token):
        if self.device is None or not self.device.go(content):
            self.volume = content.volume.copy()
        self.mask, self.cuts, self.shaped = _copy(content.mask), list(content.cuts), content.shaped
        self.token, self._stale = token, True
        if self.device is not None:
            _ = self.mesher  # has to know what is shown before the device cuts on

    def forget(self):
        """Somebody works at it no more, and nothing of it is to be seen."""
        if self.device is not None:
            self.device.drop()
        if self.awake and not self.chunks.there:
            self.chunks.outline(True)
        self.persistence.end()

    def _show(self, state):
        """Blender has brought the chunks' meshes back, too; what it has not is filled."""
        stale = self.chunks.adopt(state.fillings)
        if stale:
            self.chunks.update(self.mesher, stale, self.mask, self.stages)

    # ------------------------------------------------------------------ the end
    def commit(self):
        """The sculpt's mesh and data are what is shown."""
        ob = self.object
        if ob is None:
            return
        if self._changed(ob):
            content = self._content()
            sculpts.commit(ob.data, content, self.mm, "" if self._begin else self.token)
            self._identities.add(sculpt_store.identity(ob.data))
        elif sculpts.behind(ob.data) or not ob.data.polygons:
            sculpts.refill(ob.data, self.mm)

    def _changed(self, ob):
        try:
            content = sculpt_store.content(ob.data)
        except ValueError:  # what is packed is damaged: what is in memory takes its place
            return True
        return content.volume.revision != self.volume.revision or _revision(content.mask) != _revision(self.mask)

    def end(self):
        """Commits, and shows the sculpt itself again. An undo may bring the work back."""
        if self.device is not None:
            self.device.finish()
        ob = self.object
        if ob is not None and self.awake:
            self.cancel_stroke()
            self._part_copies(ob)
            with sculpts.in_object_mode(ob):
                self.commit()
            ob.riffler.token = ""
        self.persistence.end(sculpt_store.identity(ob.data) if ob is not None else "")
        if self.awake and not self.chunks.there:
            self.chunks.give_back(self.name)
        chunks.sweep(self.mark, self.name)
        lives.pop(self.mark, None)

    # ------------------------------------------------------------------ between strokes
    def look(self, now):
        """Ends the work that nobody is at any more; otherwise packs it while the hand rests."""
        if not self.awake or self._begin is not None:
            return
        ob = self.object
        if ob is None or ob.mode != "OBJECT" or self._away.long(idle_detection.stays(ob), now):
            self.end()
            return
        if self._objects != len(bpy.data.objects):
            self._objects = len(bpy.data.objects)
            self._part_copies(ob)
        self.rest(ob)

    def rest(self, ob):
        state = snapshots.get(self.token)
        if state is not None and self.persistence.look(ob, state.content, self.token):
            self._identities.add(sculpt_store.identity(ob.data))

    def _part_copies(self, ob):
        """What was duplicated meanwhile is a sculpt of its own, with the state that is shown. What shares the mesh
        shows it once the work has ended."""
        for other in [o for o in bpy.data.objects if o.riffler.mark == self.mark and o != ob]:
            other.riffler.mark = other.riffler.token = ""
            if not sculpts.is_sculpt(other) or other.data == ob.data:
                continue
            sculpts.commit(other.data, self._content(), self.mm)
            chunks.reveal(other)


def _copy(volume):
    return None if volume is None else volume.copy()


def _revision(volume):
    return None if volume is None else volume.revision
