"""Turns the timeline's keyframes into the plan's key orientations, and the plan into the animation.

The keyframes are the source: the plan's keys and the animation follow from them after every change, by Blender's own
tools, a script, undo or a file that was opened. Nothing here is an undo step: the consequences of an edit belong to
that edit, and after an undo they are computed again from the restored keyframes, cutter locations from memory. So one
Ctrl Z undoes a key and its consequences.

In a window this happens when nothing has changed for a tenth of a second; without a window timers never run, and it
happens at once.
"""

from dataclasses import replace

import bpy
import numpy as np
import riffler

from ..blender import handlers, scene_units
from . import collision_marks, plan_states, plan_store, timeline
from .plan_states import Baked, on_timeline, rendering, scene_of, state
from .pure import key_orientations, motion, path_names, playback
from .pure.clearance import nothing

CLASSES = ()
OTHER_PATHS = "The plan has other paths now: put it on the timeline again"
PAUSE = 0.1  # s without a change
WAIT = 0.5  # s, while something renders
ERRORS = (ValueError, OSError, RuntimeError)


# ------------------------------------------------------------------ keyframes → plan → animation
def geometry(plan):
    """What the keyframes' frames were computed from."""
    return key_orientations.fingerprint(*(a for p in plan.paths for a in (p.centres, np.array([p.closed]))))


def fits(plan_ob, plan):
    """True if the plan has the paths that it was laid out with."""
    return geometry(plan) == timeline.pair(plan_ob)[0][timeline.PATHS]


def layout_of(plan_ob, plan):
    """Layout of a plan on the timeline; cached, since every drawing of the view asks for it."""
    now, (tool, _) = state(plan_ob), timeline.pair(plan_ob)
    rate, first, known = tool[timeline.RATE], tool[timeline.FIRST], now.layout
    if known is None or not known.of(plan.paths, rate, first):
        now.layout = key_orientations.Layout(plan.paths, rate, first, known)
        now.laid += now.layout.made
    return now.layout


def sync(scene, plan_ob):
    """Updates plan and animation from the keyframes; cheap if they are up to date. Problems go into the plan's state; a
    path with one stays unchanged."""
    now, (tool, ghost) = state(plan_ob), timeline.pair(plan_ob)
    now.problems, now.changes = [], {}
    now.synced += 1
    if plan_ob.library or tool.library or ghost.library:
        return  # it belongs to another file
    try:
        plan = plan_store.plan(plan_ob)
        if not fits(plan_ob, plan):
            now.problems.append(OTHER_PATHS)
            _nothing_plays(scene, plan_ob)
            return
        plan = _take_keys(plan_ob, plan, tool, now)
        bake(scene, plan_ob, plan)
    except ERRORS as error:
        now.problems.append(str(error))
    if now.changes:
        plan_states.tell_followers()


def _take_keys(plan_ob, plan, tool, now):
    frames, quats = timeline.read_keys(tool)
    now.seen = key_orientations.fingerprint(frames, quats)
    if tool.animation_data and tool.animation_data.nla_tracks:
        now.problems.append("The tool's keyframes are in the NLA: only those of its active action change the plan")
        return plan
    if tool.rotation_mode != "QUATERNION":
        now.problems.append(f"{tool.name}: set its rotation mode back to Quaternion; other keyframes do not count")
    reading = key_orientations.read(layout_of(plan_ob, plan), frames, quats)
    now.problems += reading.problems
    paths, cl = list(plan.paths), list(plan.cl) or [None] * len(plan.paths)
    mark = plan.provenance.get(plan_store.RESOLVED)
    for k, path in enumerate(plan.paths):
        change = key_orientations.change(path.keys, reading.keys[k])
        if not change:
            continue
        try:
            plan_store.refuse_turning(plan, k)
            before = now.resolved.get(k, path, change.keys, mark)
            paths[k], cl[k] = before or (_oriented(path, change.keys), None)
            now.changes[k] = change
        except ValueError as error:
            now.problems.append(str(error) if k in plan.depths else f"Path {k + 1}, {error}; it stays as it was")
    if now.changes:
        plan = replace(plan, paths=paths, cl=cl)
        plan_ob.riffler.plan.forget(now.changes)
        plan_store.write(plan_ob, plan)
    return plan


def _nothing_plays(scene, plan_ob):
    """The timeline shows paths that no longer exist: clears the messages and the marked frames."""
    now = state(plan_ob)
    now.motions, now.difference = [], playback.Difference()
    name_paths(scene)
    if now.near is not None:
        collision_marks.look(scene, plan_ob)


def _oriented(path, wanted):
    if wanted:
        return path.orient(wanted, interpolation=path.interpolation or "smooth")
    return riffler.plan.PencilPath(path.radius, path.centres, path.contacts, path.normals, closed=path.closed)


def bake(scene, plan_ob, plan):
    """Updates the animation from the plan; only changed paths are computed."""
    now, layout = state(plan_ob), layout_of(plan_ob, plan)
    tool, ghost = timeline.pair(plan_ob)
    if now.tool is not plan.tool:
        now.tool, now.clearances, now.motions = plan.tool, {}, []
    cl = list(plan.cl) or [None] * len(plan.paths)
    entries = []
    for k, (path, rows, track) in enumerate(zip(plan.paths, cl, layout.tracks, strict=True)):
        ends = (track.first, track.last)
        if k < len(now.motions) and now.motions[k].of(path, rows, ends):
            entries.append(now.motions[k])
        else:
            along = _motion(path, rows, track, plan.tool, k in plan.depths)
            entries.append(Baked(path, rows, ends, along, motion.played(along)))
            now.baked += 1
            now.resolved.put(k, path, rows, plan.provenance.get(plan_store.RESOLVED))
    mm = scene_units.mm_per_unit(scene)
    timeline.bake(ghost, *motion.joined([e.played for e in entries]), mm)
    play = timeline.player(ghost, mm) if any(len(e.motion) for e in entries) else None
    now.difference = playback.Difference()
    for entry in entries:
        if play and entry.difference is None:
            entry.difference = playback.compare(entry.motion, play)
        now.difference = now.difference.worse(entry.difference or playback.Difference())
    now.motions = entries
    name_paths(scene)
    timeline.settle(scene, tool, ghost, afresh=True)
    if now.near is not None and collision_marks.asked(plan_ob):
        collision_marks.look(scene, plan_ob)


def name_paths(scene):
    """Sets markers for the paths of all plans that the scene plays."""
    wanted, plans = [], [p for p in on_timeline() if scene.objects.get(p.name) == p]
    for plan_ob in plans if scene.riffler.plan.frame_names else ():
        plan = plan_store.plan(plan_ob)
        if not fits(plan_ob, plan):
            continue
        tracks, whose = layout_of(plan_ob, plan).tracks, plan_ob.name if len(plans) > 1 else ""
        for k, (path, track) in enumerate(zip(plan.paths, tracks, strict=True)):
            wanted.append((path_names.name(k, path.length, k in plan.off, whose), round(track.first)))
    timeline.name_paths(scene, wanted)


def _unname():
    """Removes markers of scenes whose plans are gone."""
    for scene in bpy.data.scenes:
        if not any(scene.objects.get(p.name) == p for p in on_timeline()):
            timeline.name_paths(scene, [])


def _motion(path, rows, track, tool, kept):
    """Motion of a path without keys, along the middle between its contacts, which has no program. `kept`: its poses are
    fixed."""
    if kept:
        return motion.along(track, riffler.plan.poses_of(path), np.arange(len(path)), rows)
    shown = path if len(path.axes) else path.with_axes(path.frames[:, 2])
    start, report = riffler.plan.cutter_locations(shown, tool, nothing(), max_lift=0)
    if not len(start):
        raise ValueError(f"the tool does not stand on it: {report.blocked[0][1]}")
    return motion.along(track, start, report.points, rows)


# ------------------------------------------------------------------ what Blender tells
def flush():
    """Makes all pending updates from the keyframes now."""
    handlers.stop(_due)
    for plan_ob in on_timeline():
        sync(scene_of(plan_ob), plan_ob)
    _unname()


def _due():
    """Timer function."""
    if rendering():
        return WAIT
    for plan_ob in on_timeline():
        sync(scene_of(plan_ob), plan_ob)
    _unname()
    _look_later(on_timeline())
    return None


def _soon():
    if bpy.app.background:
        flush()
        return
    _later(_due)


def _later(function):
    """Schedules an update in PAUSE, counted from the last request."""
    handlers.stop(function)
    bpy.app.timers.register(function, first_interval=PAUSE)


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    plans = on_timeline()
    if depsgraph.mode == "RENDER":
        return
    if not plans:
        if any(path_names.is_name(m.name) for m in scene.timeline_markers):
            _soon()
        return
    if not all(state(p).synced for p in plans):  # renamed, or appended
        _soon()
        return
    ids = [u.id.original for u in depsgraph.updates]
    if any(isinstance(i, bpy.types.Action) for i in ids) and _changed(plans):
        _soon()
        return
    for plan_ob in plans:
        tool, ghost = timeline.pair(plan_ob)
        if tool in ids:
            timeline.settle(scene, tool, ghost)
    _look_later(plans)


def _look_later(plans):
    """Schedules a collision check after something may have moved. Scripts, which have no timers, ask explicitly:
    fixtures that a script moves one by one are not checked each time."""
    if bpy.app.background:
        return
    if any(collision_marks.outdated(p) for p in plans):
        _later(collision_marks.look_again)


def _changed(plans):
    """True if the keyframes differ from those seen last."""
    tools = [(state(p), timeline.pair(p)[0]) for p in plans]
    return any(now.seen != key_orientations.fingerprint(*timeline.read_keys(tool)) for now, tool in tools)


@bpy.app.handlers.persistent
def _on_frame(scene, depsgraph=None):
    """After a change of frame, a turn without a key is lost, as everywhere in Blender. A value written to an animated
    property here is overwritten at once, so a timer prepares the tool for the next turn."""
    if depsgraph is not None and depsgraph.mode != "VIEWPORT":
        return  # a render's copy, in which the user does not turn the tool
    plans = on_timeline()
    for plan_ob in plans:
        timeline.hold(timeline.pair(plan_ob)[0])
    if plans and not bpy.app.background:
        _later(_settle_all)


def _settle_all():
    """Timer function."""
    if rendering():
        return WAIT
    for plan_ob in on_timeline():
        timeline.settle(scene_of(plan_ob), *timeline.pair(plan_ob), afresh=True)
    return None


@bpy.app.handlers.persistent
def _on_history(*_):
    """After undo and redo; names and numbers of objects may have changed."""
    plan_states.search_again()
    if on_timeline():
        _soon()


@bpy.app.handlers.persistent
def _on_load(*_):
    plan_states.forget()
    if on_timeline():
        _soon()


@bpy.app.handlers.persistent
def _on_save(*_):
    if not bpy.app.background and bpy.app.timers.is_registered(_due):
        flush()


_HANDLERS = {
    "depsgraph_update_post": _on_update,
    "frame_change_post": _on_frame,
    "undo_post": _on_history,
    "redo_post": _on_history,
    "load_post": _on_load,
    "save_pre": _on_save,
}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    handlers.stop(_due, _settle_all, collision_marks.go_on, collision_marks.look_again)
    plan_states.forget()
