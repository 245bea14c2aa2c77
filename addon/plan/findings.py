"""Lists of findings, and going to a finding: its frame, its place in the views, its line of NC code."""

import hashlib
from itertools import chain, count

import bpy
from mathutils import Vector

from ..blender import scene_units
from . import plan_store, replan, timeline

WRITTEN = "riffler_written"  # of a Text: the hash of the text written to it


def write(collection, entries):
    """Fills a CollectionProperty of RifflerFinding from dictionaries."""
    collection.clear()
    for entry in entries:
        item = collection.add()
        for key, value in entry.items():
            setattr(item, key, value)


def read(collection):
    """The inverse of `write`."""
    keys = ("name", "title", "kind", "path", "point", "row", "line", "frame")
    return [{**{key: getattr(item, key) for key in keys}, "place": tuple(item.place)} for item in collection]


def frame_of(item, plan_ob):
    """The frame of a finding, or None. A plan's point has its frame from the plan's current timeline."""
    if item.path < 0:
        return item.frame if item.row >= 0 else None
    if plan_ob is None or timeline.pair(plan_ob) is None:
        return None
    tracks = replan.layout_of(plan_ob, plan_store.plan(plan_ob)).tracks
    if item.path >= len(tracks) or not 0 <= item.point < tracks[item.path].points:
        return None  # the paths have changed
    return tracks[item.path].frame_of(item.point)


def go(context, item, frame, text):
    """Shows a finding: the scene's frame (None: unchanged), the views about its place, the line of `text`."""
    scene = context.scene
    if text is not None and not 0 < item.line <= len(text.lines):
        text = None  # there is no line, or the user deleted the text
    if frame is not None:
        timeline.go_to(scene, frame)
    place = Vector(item.place) / scene_units.mm_per_unit(scene)
    for screen in _screens(context):
        for area in screen.areas:
            space = area.spaces.active
            if area.type == "VIEW_3D" and space.region_3d is not None:
                space.region_3d.view_location = place
            elif area.type == "TEXT_EDITOR" and text is not None:
                space.text = text
                space.top = max(0, item.line - 1 - max(getattr(space, "visible_lines", 0), 10) // 2)
    if text is not None:
        text.cursor_set(item.line - 1, character=0)
        text.select_set(item.line - 1, 0, item.line - 1, len(text.lines[item.line - 1].body))


def _screens(context):
    return [window.screen for window in context.window_manager.windows]


def text_of(existing, name, code):
    """A Text block with the code: the previous one if it still exists and is unedited; and the name of a previous one
    that the user has edited, which is left unchanged, or ""."""
    if existing is not None and existing.as_string() == code:
        existing[WRITTEN] = _hash(existing)
        return existing, ""
    edited = existing.name if existing is not None and existing.get(WRITTEN) != _hash(existing) else ""
    text = bpy.data.texts.new(name) if existing is None or edited else existing
    _rename(text, name)
    text.clear()
    text.write(code)
    text.cursor_set(0)
    text[WRITTEN] = _hash(text)
    return text, edited


def _rename(text, name):
    """Renames to the name, or to the next free one: some Blenders take the name from the text that has it."""
    names = chain([name], (f"{name}.{k:03}" for k in count(1)))
    text.name = next(n for n in names if bpy.data.texts.get(n) in (None, text))


def _hash(text):
    """Hash of the text as Blender returns it, which may differ in bytes from what was written."""
    return hashlib.sha256(text.as_string().encode()).hexdigest()
