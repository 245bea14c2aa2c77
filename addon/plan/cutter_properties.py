"""The cutter of the plan's tool as fields of a panel."""

import bpy
from bpy.props import EnumProperty

from ..common import presets, tool_sizes, units
from ..sculpt.tool_properties import FIELDS, KINDS


def _cutter(group):
    """The dictionary of the plan's tool, whose fields `group` has; None if it cannot be read."""
    try:
        return group.id_data.riffler.plan.tool_dict()
    except ValueError:
        return None


def _change(group, key, value):
    """Changes the tool's dictionary; a change that gives no valid tool is ignored."""
    tool = _cutter(group)
    try:
        if tool is not None and tool.get(key) != value:
            group.id_data.riffler.plan.take(tool_sizes.changed(tool, key, value))
    except ValueError:
        return


def _kind(group):
    kind = (_cutter(group) or {}).get("kind")
    return next((k for k, (known, *_) in enumerate(KINDS) if known == kind), 0)


def _size(key, field):
    """A field like that of RifflerTool, for the plan's tool."""
    first, is_flag = field.keywords["default"], key in presets.FLAGS

    def get(group):
        return (_cutter(group) or {}).get(key, first)

    def put(group, value):
        _change(group, key, value if is_flag else units.clean(value))

    return field.function(**{**field.keywords, "get": get, "set": put})


class RifflerCutter(bpy.types.PropertyGroup):
    """The cutter of the plan's tool as fields, stored in RifflerPlan.tool."""

    __annotations__ = {
        "kind": EnumProperty(
            name="Shape",
            items=KINDS,
            get=_kind,
            set=lambda group, number: _change(group, "kind", KINDS[number][0]),
            description="Shape of the cutter's end",
        ),
        **{k: _size(k, field) for k, field in FIELDS.items()},
    }
