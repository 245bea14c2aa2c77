"""Pictures of tools for panels, made at their first display."""

import json

import bpy.utils.previews
import riffler

from .pure import tool_picture

CLASSES = ()
SIZE = 128
MANY = 64  # cached pictures
_pictures = None  # the preview collection, once it exists


def icon(tool):
    """The icon of a tool's dictionary; 0, no icon, if Blender has no window. ValueError for an invalid tool."""
    global _pictures
    if bpy.app.background:
        return 0
    if _pictures is None:
        _pictures = bpy.utils.previews.new()
    key = json.dumps(tool, sort_keys=True)
    if key not in _pictures:
        pixels = tool_picture.profile(riffler.Tool.from_dict(tool).outline(), SIZE)
        if len(_pictures) >= MANY:
            _pictures.clear()
        made = _pictures.new(key)
        made.image_size = (SIZE, SIZE)
        made.image_pixels_float.foreach_set(pixels.ravel())
    return _pictures[key].icon_id


def cutter(tool):
    """The tool without shank and holder."""
    return {key: value for key, value in tool.items() if key not in ("shank", "holder")}


def detach():
    global _pictures
    if _pictures is not None:
        bpy.utils.previews.remove(_pictures)
        _pictures = None
