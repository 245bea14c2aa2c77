"""Keeps the cutter and the settings of strokes unchanged through undo and redo, like brushes of Sculpt Mode."""

import bpy

from ..blender import handlers

GROUPS = ("sculpt", "tool", "hand_tool")  # on scene.riffler
CLASSES = ()
_kept = {}  # (scene, group, field) → value


def _fields(group):
    """Names of the fields that hold a value of their own."""
    return [p.identifier for p in group.bl_rna.properties if p.type != "POINTER" and not p.is_readonly]


def _values():
    for scene in bpy.data.scenes:
        for name in GROUPS:
            group = getattr(scene.riffler, name)
            yield from (((scene.name, name, key), getattr(group, key)) for key in _fields(group) if key != "name")


def _plain(value):
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str | set) else value


@bpy.app.handlers.persistent
def _before(*_):
    _kept.clear()
    _kept.update((place, _plain(value)) for place, value in _values())


@bpy.app.handlers.persistent
def _after(*_):
    for (scene, name, key), value in list(_values()):
        wanted = _kept.get((scene, name, key), value)
        if _plain(value) != wanted:
            setattr(getattr(bpy.data.scenes[scene].riffler, name), key, wanted)
    _kept.clear()


_HANDLERS = {"undo_pre": _before, "redo_pre": _before, "undo_post": _after, "redo_post": _after}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    _kept.clear()
