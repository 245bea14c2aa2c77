"""The hand tool of the sculpt tools: a preset, or a kind with its sizes, and how it is held."""

import math

import bpy
from bpy.props import EnumProperty, StringProperty

from ..blender.fields import angle, length
from ..common import hand_tools, units

ITEMS = tuple((name, kind.label, kind.description) for name, kind in hand_tools.KINDS.items())


def _fit(self, _):
    """A channel's radius is at least half of its width."""
    if self.radius < 0.5 * self.width:
        self.radius = 0.5 * self.width


def _field(size):
    if size.unit == "rad":
        return angle(size.label, size.default, size.description, size.low, size.high)
    field = length(size.label, size.default, size.description, size.low, size.high)
    if size.name in ("width", "radius"):
        field.keywords["update"] = _fit
    return field


FIELDS = {name: _field(size) for name, size in hand_tools.ALL.items()}


class RifflerHandTool(bpy.types.PropertyGroup):
    __annotations__ = {
        "preset": StringProperty(
            name="Preset", description="Preset that the sizes come from", default=hand_tools.presets()[0]["name"]
        ),
        "kind": EnumProperty(name="Kind", items=ITEMS, default="gouge", description="Shape of the blade"),
        **FIELDS,
        "lean": angle(
            "Lean",
            hand_tools.presets()[0]["lean"],
            "Angle by which the handle leans back, away from the cut; 0: the blade stands on the surface",
            0.0,
            hand_tools.STEEPEST,
        ),
        "turn": angle(
            "Turn",
            0.0,
            "Angle between the stroke and the direction in which the blade points, for slicing cuts",
            -math.pi / 2,
            math.pi / 2,
        ),
    }

    def take(self, tool):
        """Sets kind, sizes and lean from a preset."""
        self.preset, self.kind = tool["name"], tool["kind"]
        for key in (*hand_tools.KINDS[self.kind].sizes, "lean"):
            setattr(self, key, tool[key])

    def sizes(self):
        return {key: units.clean(getattr(self, key)) for key in hand_tools.KINDS[self.kind].sizes}

    def from_preset(self):
        """The preset with exactly these sizes and this lean, or None."""
        ours = {**self.sizes(), "lean": self.lean}
        for tool in hand_tools.presets():
            if tool["name"] == self.preset and tool["kind"] == self.kind:
                same = (math.isclose(tool[key], value, rel_tol=1e-6, abs_tol=1e-9) for key, value in ours.items())
                return tool if all(same) else None
        return None

    def dictionary(self):
        """The tool in the form of riffler.Tool.to_dict; for a preset, its own numbers."""
        preset = self.from_preset()
        if preset:
            return hand_tools.tool_dict(self.kind, preset, preset["name"])
        return hand_tools.tool_dict(self.kind, self.sizes(), f"{self.kind} (custom)")
