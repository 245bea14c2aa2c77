"""Settings of the sculpt tools for panels: fields of the window manager that read and write the scene's.

Blender makes an undo step for each field changed in a panel, unless it belongs to a window manager or a screen; brushes
of its own Sculpt Mode make none. With kept_settings.py, which keeps the settings through undo, Ctrl Z undoes strokes
only.
"""

import bpy

from .hand_tool_properties import RifflerHandTool
from .properties import RifflerSculpt
from .tool_properties import RifflerTool

KINDS = (bpy.props.BoolProperty, bpy.props.EnumProperty, bpy.props.FloatProperty, bpy.props.IntProperty)


def passed_on(name, group, place):
    """A class of the name with the fields of `group`, which is `place` in the scene's settings. Without pointers."""
    fields = {key: _field(place, key, field) for key, field in group.__annotations__.items() if _is_plain(field)}
    return type(name, (bpy.types.PropertyGroup,), {"__annotations__": fields, "__module__": __name__})


def _is_plain(field):
    return field.function in KINDS and "HIDDEN" not in field.keywords.get("options", ())


def _field(place, key, field):
    choice = field.function is bpy.props.EnumProperty

    def get(_):
        source = getattr(bpy.context.scene.riffler, place)
        value = getattr(source, key)
        return _number(source, key, value) if choice else value

    def put(_, value):
        source = getattr(bpy.context.scene.riffler, place)
        setattr(source, key, _chosen(source, key, value) if choice else value)

    keywords = {k: v for k, v in field.keywords.items() if k not in ("get", "set", "update")}
    return field.function(**keywords, get=get, set=put)


def _number(source, key, value):
    """Blender's stored number of an enum, or of a set of enum flags."""
    items = source.bl_rna.properties[key].enum_items
    return sum(items[v].value for v in value) if isinstance(value, set) else items[value].value


def _chosen(source, key, number):
    field = source.bl_rna.properties[key]
    if field.is_enum_flag:
        return {item.identifier for item in field.enum_items if item.value & number}
    return next(item.identifier for item in field.enum_items if item.value == number)


RifflerStrokeFields = passed_on("RifflerStrokeFields", RifflerSculpt, "sculpt")
RifflerToolFields = passed_on("RifflerToolFields", RifflerTool, "tool")
RifflerHandToolFields = passed_on("RifflerHandToolFields", RifflerHandTool, "hand_tool")
