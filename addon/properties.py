"""What the add-on keeps on scenes, meshes and the window manager. Lengths in mm, angles in rad."""

import math
import zlib

import bpy
import riffler
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from .core import presets, units

DIRECTIONS = (
    ("xyz", "Three (tri-dexel)", "Rays along x, y and z: sharp edges and clean walls wherever the tool comes from"),
    ("z", "One (Z)", "Rays along z only: about a third of the memory; walls come out within half the pitch"),
)
SOURCES = (
    ("BLOCK", "Block", "A box of material at the 3D cursor"),
    ("OBJECT", "Object", "The active object, with its modifiers, as material"),
    ("RECORDING", "Recording", "The stock that a recording (.rjournal) was made on"),
)
ORIGINS = (
    ("CORNER", "Lower corner", "The object's origin, which is the origin of NC code, lies at the lowest corner"),
    ("TOP", "Top centre", "The object's origin, which is the origin of NC code, lies in the middle of the top"),
    ("CENTRE", "Centre", "The object's origin, which is the origin of NC code, lies in the middle"),
)
AXES = (
    ("UP", "Stock's Z", "The tool stands along the stock's +Z: three-axis work"),
    (
        "TILT",
        "Curve tilt",
        "The tool stands square to the curve and upright, turned about the curve by its tilt (Ctrl T)",
    ),
    ("NORMAL", "Surface normal", "The tool stands along the sculpt's surface normal nearest to the curve"),
)
POSTS = (
    ("3-axis", "3-axis", "X Y Z; every cut must have the tool along the stock's Z"),
    (
        "tcp",
        "5-axis TCP",
        "Tip in part coordinates with A and C, for controllers with tool centre point control (G43.4)",
    ),
)
RECORDING = "recording"
# The numbers are what a .blend keeps: those of a kind stay when another kind is added.
DEVICES = tuple(
    (kind, kind.replace("-", " ").capitalize(), what, "NONE", zlib.crc32(kind.encode()) >> 1)
    for kind, what in {**riffler.pen.kinds(), RECORDING: "What a hand did before, at its pace"}.items()
)
STARTS = (
    ("ABOVE", "Above the stock", "The tool stands upright above the middle of the stock when the session starts"),
    ("CURSOR", "3D cursor", "The tool's tip stands upright at the 3D cursor when the session starts"),
)
KINDS = tuple((kind, *presets.LABELS[kind]) for kind in presets.SIZES)


def length(name, default, description, low=0.0, high=1e5):
    return FloatProperty(name=name, default=default, min=low, max=high, precision=3, step=10, description=description)


class StockSettings:
    """Shared by the panel's settings and the operator."""

    source: EnumProperty(name="From", items=SOURCES, default="BLOCK")
    recording: StringProperty(name="Recording", subtype="FILE_PATH", description="A recording (.rjournal)")
    size: FloatVectorProperty(
        name="Size", default=(100, 60, 30), min=0.001, max=1e5, precision=2, description="Block along x, y and z, in mm"
    )
    origin: EnumProperty(name="Origin", items=ORIGINS, default="CORNER")
    pitch: length("Pitch", 0.5, "Distance between rays, in mm: what the surface can resolve", 1e-4)
    directions: EnumProperty(name="Rays", items=DIRECTIONS, default="xyz")


class CutSettings:
    axis: EnumProperty(name="Axis", items=AXES, default="UP")
    depth: length("Depth", 1.0, "How far below the curve the tip goes, against the tool's axis, in mm", -1e5)
    follow: BoolProperty(
        name="Follow surface",
        default=False,
        description="Take the nearest points of the surface instead of the curve's",
    )
    tolerance: length("Tolerance", 0.01, "Largest distance from the exact curve and the exact sweep, in mm", 1e-5, 10.0)


class NcSettings:
    post: EnumProperty(name="Post", items=POSTS, default="3-axis")
    feed: length("Feed", 600.0, "mm/min at the tip", 0.001, 1e6)
    spindle: length("Spindle", 12000.0, "rev/min", 0.0, 1e6)


class PenSettings:
    device: EnumProperty(name="Device", items=DEVICES, default="simulated", description="What the hand holds")
    recording: StringProperty(
        name="Recording", subtype="FILE_PATH", description="A recording (.rjournal) to be played as a device"
    )
    start: EnumProperty(name="Start", items=STARTS, default="ABOVE")
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


class RifflerStock(StockSettings, bpy.types.PropertyGroup):
    pass


class RifflerCut(CutSettings, bpy.types.PropertyGroup):
    curve: PointerProperty(
        name="Curve", type=bpy.types.Object, poll=lambda _, ob: ob.type == "CURVE", description="Curve to cut along"
    )


class RifflerNc(NcSettings, bpy.types.PropertyGroup):
    pass


class RifflerPen(PenSettings, bpy.types.PropertyGroup):
    pass


class RifflerTool(bpy.types.PropertyGroup):
    preset: StringProperty(name="Preset", default=presets.presets()[0]["name"])
    kind: EnumProperty(name="Shape", items=KINDS, default="ball")
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


class RifflerScene(bpy.types.PropertyGroup):
    stock: PointerProperty(type=RifflerStock)
    tool: PointerProperty(type=RifflerTool)
    cut: PointerProperty(type=RifflerCut)
    nc: PointerProperty(type=RifflerNc)
    pen: PointerProperty(type=RifflerPen)


class RifflerMesh(bpy.types.PropertyGroup):
    """On a sculpt's mesh: where its volume is, and what a panel shows without reading it."""

    store: PointerProperty(type=bpy.types.Image)
    mm_per_unit: FloatProperty(default=1000.0)
    shown: IntVectorProperty(size=2)
    shown_at: FloatVectorProperty(size=24)
    lower: FloatVectorProperty()
    upper: FloatVectorProperty()
    pitch: FloatProperty()
    directions: StringProperty()
    material: FloatProperty()
    nbytes: FloatProperty()
    cuts: IntProperty()
    moves: IntProperty()


class RifflerProgress(bpy.types.PropertyGroup):
    """On the window manager: the cut or the pen's session that runs now; never saved."""

    running: BoolProperty()
    percent: FloatProperty(name="Progress", subtype="PERCENTAGE", min=0, max=100, precision=0)
    text: StringProperty()
    sculpting: BoolProperty()
    force: StringProperty()
    why: StringProperty()


CLASSES = (RifflerStock, RifflerTool, RifflerCut, RifflerNc, RifflerPen, RifflerScene, RifflerMesh, RifflerProgress)
_OWNERS = ((bpy.types.Scene, RifflerScene), (bpy.types.Mesh, RifflerMesh), (bpy.types.WindowManager, RifflerProgress))


def attach():
    for owner, group in _OWNERS:
        owner.riffler = PointerProperty(type=group)


def detach():
    for owner, _ in _OWNERS:
        del owner.riffler
