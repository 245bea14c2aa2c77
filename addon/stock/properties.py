"""What new stock is made of, what is done to a sculpt as a whole, what is made of it, and what its mesh keeps."""

import bpy
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

from ..blender.fields import length

# ---------------------------------------------------------------------- new stock
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


class StockSettings:
    """Shared by the panel's settings and the operator."""

    source: EnumProperty(name="From", items=SOURCES, default="BLOCK", description="What is to be the material")
    recording: StringProperty(name="Recording", subtype="FILE_PATH", description="A recording (.rjournal)")
    size: FloatVectorProperty(
        name="Size",
        default=(100, 60, 30),
        min=0.001,
        max=1e5,
        precision=2,
        subtype="XYZ",
        description="Block along x, y and z, in mm",
    )
    origin: EnumProperty(
        name="Origin", items=ORIGINS, default="CORNER", description="Where the block has the zero of its coordinates"
    )
    pitch: length("Pitch", 0.5, "Distance between rays, in mm: what the surface can resolve", 1e-4)
    directions: EnumProperty(
        name="Rays", items=DIRECTIONS, default="xyz", description="Along which axes the material is measured"
    )


class RifflerStock(StockSettings, bpy.types.PropertyGroup):
    pass


# ---------------------------------------------------------------------- cuts and NC code
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


class CutSettings:
    """Shared by the panel's settings and the operator."""

    axis: EnumProperty(name="Axis", items=AXES, default="UP", description="Where the tool points")
    depth: length("Depth", 1.0, "How far below the curve the tip goes, against the tool's axis, in mm", -1e5)
    follow: BoolProperty(
        name="Follow surface",
        default=False,
        description="Take the nearest points of the surface instead of the curve's",
    )
    tolerance: length("Tolerance", 0.01, "Largest distance from the exact curve and the exact sweep, in mm", 1e-5, 10.0)


class NcSettings:
    """Shared by the panel's settings and the operator."""

    post: EnumProperty(name="Post", items=POSTS, default="3-axis", description="The machine that the NC code is for")
    feed: length("Feed", 600.0, "mm/min at the tip", 0.001, 1e6)
    spindle: length("Spindle", 12000.0, "rev/min", 0.0, 1e6)


class RifflerCut(CutSettings, bpy.types.PropertyGroup):
    curve: PointerProperty(
        name="Curve", type=bpy.types.Object, poll=lambda _, ob: ob.type == "CURVE", description="Curve to cut along"
    )


class RifflerNc(NcSettings, bpy.types.PropertyGroup):
    pass


# ---------------------------------------------------------------------- the clay
HOW = (
    ("REPLACE", "Replace", "What is protected is this and nothing else"),
    ("ADD", "Add", "This is protected, too"),
    ("SUBTRACT", "Subtract", "This is not protected any more"),
)
RELIEF = (
    ("RAISE", "Raise", "What is light in the picture stands out of the surface"),
    ("ENGRAVE", "Engrave", "What is light in the picture is cut into the surface"),
)


class ReliefSettings:
    """Shared by the panel's settings and the operator."""

    mode: EnumProperty(name="Mode", items=RELIEF, default="RAISE", description="Which way the picture goes")
    depth: length("Depth", 1.0, "Height of what is white in the picture, in mm", 1e-4)
    width: length("Width", 40.0, "Width of the picture, in mm; its height follows", 1e-3)
    invert: BoolProperty(name="Invert", description="What is dark in the picture is high")
    follow: BoolProperty(
        name="Follow Surface",
        default=True,
        description="Heights are over the sculpt's surface; off: over the plane that the picture lies in",
    )


class RifflerClay(ReliefSettings, bpy.types.PropertyGroup):
    pitch: length("Pitch", 0.25, "Distance between rays, in mm: what the surface can resolve", 1e-4)
    room: length("Room", 5.0, "How much larger the sculpt's box becomes on every side, in mm", 1e-3)
    plane: PointerProperty(
        name="Plane", type=bpy.types.Object, description="Its local plane z = 0 is where the sculpt is cut off"
    )
    form: PointerProperty(
        name="Form", type=bpy.types.Object, description="A mesh, or a curve whose closed splines go through the sculpt"
    )
    image: PointerProperty(name="Picture", type=bpy.types.Image, description="Its brightness is the height")
    place: PointerProperty(
        name="Place",
        type=bpy.types.Object,
        description="The picture lies in its local plane z = 0, its middle at the origin, seen from where z points",
    )


# ---------------------------------------------------------------------- results
class ResultSettings:
    """Shared by the panel's settings and the operator."""

    tolerance: length(
        "Tolerance", 0.01, "How far decimation may take the surface from the volume's, in mm; 0: all", 0.0
    )
    iterations: IntProperty(name="Smooth", default=0, min=0, max=200, description="Passes that smooth, edges stay")
    smooth_tolerance: length("At most", 0.02, "How far smoothing may move a vertex, in mm", 1e-5)
    hide_sculpt: BoolProperty(name="Hide Sculpt", default=True, description="Show the new mesh in the sculpt's place")


class RifflerResult(ResultSettings, bpy.types.PropertyGroup):
    reference: PointerProperty(
        name="Reference", type=bpy.types.Object, description="The surface that distances are measured from"
    )
    scale: length("Full colours at", 0.1, "Distance from which colours are full, in mm", 1e-5)


# ---------------------------------------------------------------------- what a mesh keeps
class RifflerMesh(bpy.types.PropertyGroup):
    """On a sculpt's mesh: where its volume is, and what a panel shows without reading it."""

    store: PointerProperty(type=bpy.types.Image)
    mm_per_unit: FloatProperty(default=1000.0)
    shown: IntVectorProperty(size=2)
    shown_of: StringProperty(description="Content id of the volume that the mesh was made of")
    shown_at: FloatVectorProperty(size=24)
    shown_crc: StringProperty()  # of all coordinates as they were shown; files of older add-ons have none
    lower: FloatVectorProperty()
    upper: FloatVectorProperty()
    off_middle: FloatVectorProperty()  # from where strokes are mirrored to the middle of the box, mm
    pitch: FloatProperty()
    directions: StringProperty()
    material: FloatProperty()
    nbytes: FloatProperty()
    cuts: IntProperty()
    moves: IntProperty()
