"""The cutter: a preset, or a shape with its sizes. Fields are made from the core's table of shapes."""

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from ..blender.fields import angle, length
from ..common import presets, units

KINDS = tuple((kind, *presets.LABELS[kind]) for kind in presets.SIZES)


def _field(size):
    if size.unit == "bool":
        return BoolProperty(name=size.label, default=size.default, description=size.description)
    if size.unit == "rad":
        return angle(size.label, size.default, size.description, size.low, size.high)
    return length(size.label, size.default, size.description, size.low, size.high)


FIELDS = {name: _field(size) for name, size in presets.ALL.items()}


class RifflerTool(bpy.types.PropertyGroup):
    __annotations__ = {
        "preset": StringProperty(
            name="Preset", description="Preset that the sizes come from", default=presets.presets()[0]["name"]
        ),
        "kind": EnumProperty(name="Shape", items=KINDS, default="ball", description="Shape of the cutter's end"),
        **FIELDS,
    }

    def take(self, tool):
        """Sets shape and sizes from a tool's dictionary."""
        self.preset = tool.get("name", "")
        self.kind = tool["kind"]
        for flag in presets.FLAGS:
            setattr(self, flag, False)
        for key in presets.SIZES[self.kind]:
            if key in tool:
                setattr(self, key, tool[key])

    def sizes(self):
        return {
            k: getattr(self, k) if k in presets.FLAGS else units.clean(getattr(self, k))
            for k in presets.SIZES[self.kind]
        }

    def from_preset(self):
        """The preset with exactly these sizes, or None."""
        named = [t for t in presets.presets() if t["name"] == self.preset and t["kind"] == self.kind]
        ours = self.sizes()
        same = named and all(math.isclose(float(named[0].get(k, 0)), float(v), rel_tol=1e-6) for k, v in ours.items())
        return named[0] if same else None

    def dictionary(self):
        """The cutter in the form of riffler.Tool.to_dict; for a preset, its own numbers."""
        preset = self.from_preset()
        return dict(preset) if preset else presets.tool_dict(self.kind, self.sizes(), f"{self.kind} (custom)")
