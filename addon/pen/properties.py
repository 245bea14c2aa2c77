"""Which device the hand holds, how it feels, and what its session is doing."""

import bpy
import riffler
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..blender.fields import length, stored_number

RECORDING = "recording"
DEVICES = tuple(
    (kind, kind.replace("-", " ").capitalize(), what, "NONE", stored_number(kind))
    for kind, what in {**riffler.pen.kinds(), RECORDING: "What a hand did before, at its pace"}.items()
)
PREFERRED = "preferred"
CHOICES = ((PREFERRED, "As in Preferences", "The device that Riffler's preferences name", "NONE", 0), *DEVICES)
STARTS = (
    ("ABOVE", "Above the stock", "The tool stands upright above the middle of the stock when the session starts"),
    ("CURSOR", "3D cursor", "The tool's tip stands upright at the 3D cursor when the session starts"),
)


class PenSettings:
    """Shared by the panel's settings and the operator."""

    device: EnumProperty(name="Device", items=CHOICES, default=PREFERRED, description="What the hand holds")
    recording: StringProperty(
        name="Recording", subtype="FILE_PATH", description="A recording (.rjournal) to be played as a device"
    )
    start: EnumProperty(
        name="Start", items=STARTS, default="ABOVE", description="Where the tool stands when the session starts"
    )
    gap: length("Gap", 1.0, "From the stock's top to the tool's tip at the start, in mm", 0.0, 1e4)
    scale: length("Scale", 1.0, "Way of the tool for a way of the hand", 1e-3, 100.0)
    stiffness: length("Stiffness", 1.0, "Of the pull between hand and tool, in N/mm", 1e-3, 100.0)
    removal_constant: FloatProperty(
        name="Resistance",
        default=0.005,
        min=0.0,
        max=100.0,
        precision=4,
        step=0.1,
        description="Of the material: N for every mm³ that is removed in a second",
    )
    record: BoolProperty(name="Record", default=False, description="Write a journal of every stroke into a folder")
    folder: StringProperty(
        name="Folder", subtype="DIR_PATH", default="//", description="For the journal and the stock that it begins with"
    )


class RifflerPen(PenSettings, bpy.types.PropertyGroup):
    pass


class PenProgress:
    """Of the session that runs, for the panel."""

    sculpting: BoolProperty()
    force: StringProperty()
    why: StringProperty()
