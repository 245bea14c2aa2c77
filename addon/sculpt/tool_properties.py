"""The cutter: a preset, or a kind with its sizes."""

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..blender.fields import length
from ..common import presets, units

KINDS = tuple((kind, *presets.LABELS[kind]) for kind in presets.SIZES)


class RifflerTool(bpy.types.PropertyGroup):
    preset: StringProperty(
        name="Preset", description="That the sizes were taken from", default=presets.presets()[0]["name"]
    )
    kind: EnumProperty(name="Shape", items=KINDS, default="ball", description="Of the end of the cutter")
    diameter: length("Diameter", 6.0, "Of the cylinder above the end, in mm", 1e-3)
    length: length("Length", 30.0, "Cutting length from the tip, in mm", 1e-3)
    corner_radius: length("Corner radius", 1.0, "Of the rounded edge, in mm", 1e-3)
    tip_radius: length("Tip radius", 0.5, "Of the ball or flat at the tip, in mm", 1e-4)
    tip_height: length("Tip height", 1.0, "Of the first cone, in mm", 1e-3)
    half_angle: FloatProperty(
        name="Half angle",
        default=math.radians(5),
        min=math.radians(0.1),
        max=math.radians(89.9),
        subtype="ANGLE",
        description="Between the axis and the flank",
    )
    tip_half_angle: FloatProperty(
        name="Tip half angle",
        default=math.radians(30),
        min=math.radians(0.1),
        max=math.radians(89.9),
        subtype="ANGLE",
        description="Between the axis and the first cone",
    )
    flat_tip: BoolProperty(name="Flat tip", default=False, description="A flat instead of a ball at the tip")

    def take(self, tool):
        """Sets kind and sizes from a tool's dictionary."""
        self.preset = tool.get("name", "")
        self.kind = tool["kind"]
        self.flat_tip = False
        for key in presets.SIZES[self.kind]:
            if key in tool:
                setattr(self, key, tool[key])

    def sizes(self):
        return {
            k: getattr(self, k) if k == "flat_tip" else units.clean(getattr(self, k)) for k in presets.SIZES[self.kind]
        }

    def from_preset(self):
        """The preset that these sizes still are, or None after one was changed."""
        named = [t for t in presets.presets() if t["name"] == self.preset and t["kind"] == self.kind]
        ours = self.sizes()
        same = named and all(math.isclose(float(named[0].get(k, 0)), float(v), rel_tol=1e-6) for k, v in ours.items())
        return named[0] if same else None

    def dictionary(self):
        """The form of riffler.Tool.to_dict; a preset's own numbers where it is one."""
        preset = self.from_preset()
        return dict(preset) if preset else presets.tool_dict(self.kind, self.sizes(), f"{self.kind} (custom)")
