"""A live sculpt: a volume that changes stroke by stroke, shown in chunks, each stroke one of Blender's own undo steps.

A stroke ends with a new token on the object; the state of that token stays in memory (undo_states.py). Undo and redo
restore the token and the chunks' meshes, and `follow` restores the volume. So a step costs what Blender needs for its
objects, at any size of the sculpt. The sculpt's own mesh and the data in the file are updated when they are
needed: when the session ends, before the file is saved, when an operator uses the sculpt. Packing and journal:
persistence.py.

The session ends by itself once no window has the sculpt and one of its tools active (idle_detection.py). A timer checks
that; nothing modal runs between strokes, since Blender makes no autosave during a modal operator.
"""

import bpy
import numpy as np
import riffler

from ..blender import refusals, versions
from ..common import hand_tools
from ..common.contents import Content
from ..common.poses import moving
from . import brushes, chunks, idle_detection, persistence, sculpt_store, sculpts, surfaces, undo_states
from .pure import reach, symmetry
from .pure.stages import Stages
from .pure.stroke_record import StrokeRecord
from .sculpt_identity import SculptIdentity
from .shown_surface import ShownSurface
from .undo_states import State

lives = {}  # by the mark of the object (sculpts.new_mark); live_registry.py keeps it


class LiveSculpt:
    """The session of the sculpt `ob`. ValueError, MemoryError if it cannot start; then nothing has changed."""

    def __init__(self, context, ob):
        if why := refusals.linked(ob, ob.data):
            raise ValueError(why)
        content = sculpt_store.content(ob.data)
        sculpts.new_mark(ob)
        self._take(ob, content)
        mesher = riffler.Mesher(
            self.volume, tolerance=surfaces.within(ob.data.riffler.detail, self.volume.pitch, self.mask)
        )
        self._show_in(ob, chunks.Chunks(context, ob, mesher.shape, self.mm), mesher)
        try:
            self.chunks.update(mesher, mesher.patches(), self.mask)
        except Exception:
            chunks.sweep(self.mark, self.name)
            raise
        before, kept = sculpt_store.token(ob.data), ob.riffler.strokes
        self._remember(ob)
        if kept.token and kept.token == before:  # the same state, under a new token
            kept.token = self.token
        if not ob.data.riffler.store.library:
            sculpt_store.mark_state(ob.data, self.token)
        self.persistence = persistence.Persistence(ob, self.token)

    @classmethod
    def revived(cls, ob, state):
        """A session of a sculpt whose chunks an undo has restored after its session had ended."""
        self = cls.__new__(cls)
        self._take(ob, state.content)
        self._show_in(ob, chunks.Chunks.found(ob, state.shape, self.mm))
        self.token = ob.riffler.token
        self.persistence = persistence.Persistence(ob, self.token)
        versions.lighten(ob.data)
        self._surface.adopt(state.fillings, self.volume, self.mask)
        self.chunks.hide_tool()
        return self

    def _take(self, ob, content):
        self._identity = SculptIdentity(ob)
        self.stages = Stages()
        self._become(content)
        self.token = ""  # of the current state
        self._facts = None  # (token, facts of its state)
        self.maps, self.centre = symmetry.maps(), sculpts.middle(ob.data, self.volume)
        self.strength, self.depth, self.falloff = 0.5, 0.5, "smooth"  # settings of brushes
        self.pressure, self.step = 1.0, 0.0  # of the moves that are being applied: share of the depth; mm between dabs
        self.keep_out = None  # for symmetric copies, like BrushStroke's
        self.stroke = None  # StrokeRecord of the stroke in progress
        self.lost = 0.0  # mm³ of thin walls that brushes could not keep in this stroke
        self.cut_off = False  # whether the box has clipped material that this stroke, or this session, added
        self._outline = None, None  # a tool, and its cutter's outline
        self.awake, self._idle = True, idle_detection.IdleClock()
        self._objects = -1  # number in the file at the last search for copies
        self.device = None  # pen/session.py: PenSession, while a device sculpts this

    def _show_in(self, ob, chunks, mesher=None):
        within = surfaces.within(ob.data.riffler.detail, self.volume.pitch)
        self.chunks, self._surface = chunks, ShownSurface(chunks, self.stages, within, mesher)

    # ------------------------------------------------------------------ where things are
    @property
    def object(self):
        """The sculpt's object, or None if it was removed or changed by other operations."""
        return self._identity.object

    @property
    def mark(self):
        return self._identity.mark

    @property
    def name(self):
        return self._identity.name

    @property
    def mm(self):
        return self._identity.mm

    @property
    def to_mm(self):
        """(4, 4): Blender units in the world → mm in the sculpt's frame."""
        return sculpts.from_world(self.object)

    @property
    def to_world(self):
        """(4, 4): mm in the sculpt's frame → Blender units in the world."""
        return np.linalg.inv(self.to_mm)

    # ------------------------------------------------------------------ what it is
    def _become(self, content):
        """Takes over a state: volume, mask, cuts, and whether other operations have shaped it."""
        own = content.copy()
        self.volume, self.mask, self.cuts, self.shaped = own.volume, own.mask, own.cuts, own.shaped

    def _content(self):
        return Content(self.volume, self.cuts, self.mask, self.shaped).copy()

    @property
    def facts(self):
        """sculpts.facts of the state at the end of the last stroke: computed once per state."""
        if self._facts is None or self._facts[0] != self.token:
            self._facts = self.token, sculpts.facts(Content(self.volume, self.cuts, self.mask))
        return self._facts[1]

    @property
    def mesher(self):
        return self._surface.mesher(self.volume, self.mask)

    def freeze(self):
        """The current surface, for picking while the stroke changes it."""
        return self.mesher.freeze()

    def show(self):
        self._surface.show(self.volume, self.mask, self.object.matrix_world)

    # ------------------------------------------------------------------ a stroke
    def begin_stroke(self):
        _ = self.mesher  # creates the mesher before the volume changes
        ob = self.object
        if ob is None:
            raise ValueError(f"{self.name} was changed or removed meanwhile")
        self.stroke, self.cut_off, self.lost = StrokeRecord(self._content()), False, 0.0
        versions.lighten(ob.data)
        self.persistence.begin_stroke(ob, self.token, self.stroke.begin)

    def begin_device_stroke(self):
        """Begins a stroke for what a device removes from now on."""
        self.stroke = StrokeRecord(undo_states.snapshots.get(self.token).content.copy())
        versions.lighten(self.object.data)

    @property
    def changed(self):
        """Whether the stroke in progress has changed anything."""
        return self.stroke is not None and self.stroke.begin.differs(self.volume, self.mask)

    @property
    def in_stroke(self):
        return self.stroke is not None

    def give_up(self):
        """Restores what a device has removed since the last state."""
        if not self.in_stroke:
            self.begin_device_stroke()
        self.cancel_stroke()

    def took(self, tool, rows, mode):
        """Records the poses, (n, 6), of a device's stroke with `tool`, a dictionary."""
        brush, tool = brushes.of(mode), riffler.Tool.from_dict(tool)
        if brush.puts_on:
            self._reach_out(tool, rows)
        if self.in_stroke:
            brush.record(self.stroke, 0, tool, rows, True)

    def carve(self, tool, poses, dt=None, mode="remove", new=True):
        """Applies a brush (`mode`: its id) along the poses, (n, 6), or (n, 9) of a hand tool, and along their
        symmetric copies. `new`: they do not continue the last ones. Returns the result of Brush.apply for the poses
        themselves."""
        brush = brushes.of(mode)
        if brush.idle(self):
            return None
        if self.stroke is None:
            self.begin_stroke()
        first, stroke = None, self.stroke
        poses = np.asarray(poses, float)
        self.step = brush.step(self, tool, poses, new)
        poses, dt = brush.moves(poses, dt, new)
        if brush.whole:
            self._restart()
        if not len(poses):
            return None
        image = hand_tools.mirrored(tool) if brush.hand else tool
        given = tool
        with self.stages.of("cut"):
            for k, (copy, mirrors) in enumerate(symmetry.copies(poses, self.maps, self.centre, image is given)):
                tool = image if mirrors else given
                copy = self._kept_out(k, copy)
                if copy is None:
                    continue
                cut = self._apply(brush, tool, copy, dt if k == 0 else None)
                first = first or cut
                options = brush.options(self, tool)
                self.persistence.carved(tool.to_dict(), copy, brush.journal, stroke.token, **options)
                brush.record(stroke, k, tool, copy, new or k in stroke.apart)
                stroke.apart.discard(k)
        self.stages.count(moves=max(len(poses) - 1, 0))
        return first

    def _apply(self, brush, tool, poses, dt):
        if brush.paints:
            extent = self._extent(tool, poses)
            self._surface.masked.append(extent)
            self.stroke.painted.append(extent)
        cut = brush.apply(self, tool, poses, dt)
        if brush.puts_on:
            self._reach_out(tool, poses)
        return cut

    def _extent(self, tool, poses):
        """(lower, upper) of the region that the cutter may touch, in rays."""
        ends = np.vstack([poses[:, :3], poses[:, :3] + tool.length * poses[:, 3:6]])
        lower, upper = ends.min(axis=0) - tool.diameter / 2, ends.max(axis=0) + tool.diameter / 2
        return (lower - self.volume.lower) / self.volume.pitch, (upper - self.volume.lower) / self.volume.pitch

    def _reach_out(self, tool, poses):
        if self._outline[0] is not tool:
            self._outline = tool, reach.outline_of(tool)
        self.cut_off |= reach.is_cut_off(self._outline[1], poses, self.volume)

    def _kept_out(self, k, poses):
        """A copy's poses, clear of the fixtures; None if there are none. The first is the original: it is clear."""
        if k == 0 or self.keep_out is None:
            return poses
        kept = self.keep_out(poses, np.ones(len(poses) - 1))
        if kept is None:
            self.stroke.apart.add(k)
            return None
        return moving(kept[0])[0]

    def finish_stroke(self, context, label=""):
        """Makes what was carved since `begin_stroke` a state of its own. The caller's operator makes the undo step; a
        caller without one gives it a `label`. False if nothing has changed."""
        stroke, self.stroke = self.stroke, None
        if stroke is None or not stroke.begin.differs(self.volume, self.mask):
            return False
        self.cuts = [*self.cuts, *stroke.cuts(self.mask is not None)]
        self.shaped |= stroke.shaped
        self.show()
        ob = self.object
        self._remember(ob, stroke.token)
        self.persistence.finished(ob, undo_states.snapshots.get(self.token).content, self.token)
        self._identity.written(ob)
        if label:
            bpy.ops.ed.undo_push(message=label)
        return True

    def exchange(self, volume):
        """In a stroke: replaces what was carved by a kept stroke's result."""
        self.volume = volume
        self.persistence.cancelled()
        self.stroke.moves.clear()

    def recut(self, content, token=""):
        """Shows a content that follows from kept strokes (kept_strokes.py). Without a `token` the state keeps its
        own: the strokes' curves, which undo restores, decide what it is."""
        self._become(content)
        self.show()
        ob = self.object
        if token:
            self._remember(ob, token)
        else:
            state = State(self._content(), self._surface.shape, dict(self.chunks.fillings))
            undo_states.snapshots.put(self.token, state)
            self._facts = None
        self.persistence.recut()

    def _restart(self):
        """Restores the state before the stroke."""
        begin, self.lost = self.stroke.begin.copy(), 0.0
        self.volume, self.mask = begin.volume, begin.mask
        self.persistence.cancelled()

    def cancel_stroke(self):
        stroke, self.stroke = self.stroke, None
        if stroke is not None:
            self.volume, self.mask = stroke.begin.volume, stroke.begin.mask
            self._surface.masked = stroke.painted
            self.persistence.cancelled()
            self.show()

    # ------------------------------------------------------------------ undo
    def _remember(self, ob, token=""):
        """Stores the current state, which undo and redo may ask for."""
        state = State(self._content(), self._surface.shape, dict(self.chunks.fillings))
        self.token = undo_states.remember(state, token, self.token, {other.token for other in lives.values()})
        ob.riffler.token = self.token

    def follow(self):
        """After an undo or a redo: restores the state that Blender has restored. False if it cannot."""
        ob = self.object
        if ob is None:
            return False
        was, self.awake, self.stroke = self.awake, self.chunks.there, None
        if was != self.awake:
            self.chunks.outline(was)
        if not self.awake:
            if self.device is not None:
                self.device.drop()
            return True  # redo may restore it
        state = undo_states.state_of(ob)
        if state is None:
            return False
        dropped = self.device is not None and not self.chunks.tool_there  # the start of its session was undone
        if dropped:
            self.device.drop()
        if dropped or self.device is not None or ob.riffler.token != self.token:
            self._bring(state.content, ob.riffler.token)
        self.persistence.went(self.token)
        self._surface.adopt(state.fillings, self.volume, self.mask)
        if self.device is None:
            self.chunks.hide_tool()
        return True

    def _bring(self, content, token):
        volume = self.volume
        kept = self.device is not None and self.device.go(content)
        self._become(content)
        if kept:  # the device's session has the volume, and has undone its own strokes in it
            self.volume = volume
        self.token = token
        self._surface.outdate()
        if self.device is not None:
            _ = self.mesher  # creates the mesher before the device continues cutting

    # ------------------------------------------------------------------ the end
    def forget(self):
        """Ends the session, and removes its display."""
        if self.device is not None:
            self.device.drop()
        if self.awake and not self.chunks.there:
            self.chunks.outline(True)
        self.persistence.end()

    def commit(self):
        """Updates the sculpt's mesh and data from the displayed state."""
        ob = self.object
        if ob is None:
            return
        if self._changed(ob):
            content, surface = self._content(), self._surface.whole(self.volume, self.mask)
            sculpts.commit(ob.data, content, self.mm, "" if self.in_stroke else self.token, surface=surface)
            self._identity.written(ob)
        elif sculpts.behind(ob.data) or not ob.data.polygons:
            sculpts.refill(ob.data, self.mm)

    def _changed(self, ob):
        try:
            content = sculpt_store.content(ob.data)
        except ValueError:  # the packed data is damaged: the state in memory replaces it
            return True
        return content.differs(self.volume, self.mask)

    def end(self):
        """Commits, and shows the sculpt itself again. An undo may revive the session."""
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
        """Ends an idle session; otherwise packs the sculpt while the hand rests."""
        if not self.awake or self.in_stroke:
            return
        ob = self.object
        if ob is None or ob.mode != "OBJECT" or self._idle.long(idle_detection.stays(ob), now):
            self.end()
            return
        if self._objects != len(bpy.data.objects):
            self._objects = len(bpy.data.objects)
            self._part_copies(ob)
        self.rest(ob)

    def rest(self, ob):
        state = undo_states.snapshots.get(self.token)
        if state is not None and self.persistence.look(ob, state.content, self.token):
            self._identity.written(ob)

    def _part_copies(self, ob):
        """Makes duplicates sculpts of their own, with the state that was displayed when they were made. Objects that
        share the mesh show it once the session has ended."""
        for other in [o for o in bpy.data.objects if o.riffler.mark == self.mark and o != ob]:
            state = undo_states.snapshots.get(other.riffler.token)
            other.riffler.mark = other.riffler.token = ""
            if not sculpts.is_sculpt(other) or other.data == ob.data:
                continue
            sculpts.commit(other.data, self._content() if state is None else state.content.copy(), self.mm)
            chunks.reveal(other)
