"""Settings of new stock, of operations on a sculpt as a whole, and of its results; and the data on its mesh."""

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
from ..sculpt.surfaces import DETAIL

# ---------------------------------------------------------------------- new stock
DIRECTIONS = (
    ("xyz", "Three (Tri-Dexel)", "Rays along x, y and z: sharp edges and clean walls from every direction"),
    ("z", "One (Z)", "Rays along z only: about a third of the memory; walls are accurate to half the pitch"),
)
SOURCES = (
    ("BLOCK", "Block", "A box of material at the 3D cursor"),
    ("OBJECT", "Object", "The active object, with its modifiers, as material"),
    ("RECORDING", "Recording", "The stock that a recording (.rjournal) was made on"),
)
ORIGINS = (
    ("CORNER", "Lower Corner", "The object's origin, which is the origin of NC code, lies at the lowest corner"),
    ("TOP", "Top Centre", "The object's origin, which is the origin of NC code, lies in the middle of the top"),
    ("CENTRE", "Centre", "The object's origin, which is the origin of NC code, lies in the middle"),
)


class StockSettings:
    """Shared by the panel's settings and the operator."""

    source: EnumProperty(name="From", items=SOURCES, default="BLOCK", description="What the material is made of")
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
    origin: EnumProperty(name="Origin", items=ORIGINS, default="CORNER", description="Place of the block's origin")
    pitch: length("Pitch", 0.5, "Distance between rays, in mm: the finest detail of the surface", 1e-4)
    directions: EnumProperty(
        name="Rays", items=DIRECTIONS, default="xyz", description="Directions of the rays that measure the material"
    )
    rounded: BoolProperty(
        name="Round Facets",
        default=False,
        description="Make the facets of an object round; its edges of more than 32° stay sharp",
    )


class RifflerStock(StockSettings, bpy.types.PropertyGroup):
    pass


# ---------------------------------------------------------------------- cuts and NC code
AXES = (
    ("UP", "Stock's Z", "The tool stands along the stock's +Z: three-axis work"),
    (
        "TILT",
        "Curve Tilt",
        "The tool stands perpendicular to the curve and upright, turned about the curve by its tilt (Ctrl T)",
    ),
    ("NORMAL", "Surface Normal", "The tool stands along the sculpt's surface normal nearest to the curve"),
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

    axis: EnumProperty(name="Axis", items=AXES, default="UP", description="Direction of the tool's axis")
    depth: length("Depth", 1.0, "How far below the curve the tip goes, against the tool's axis, in mm", -1e5)
    follow: BoolProperty(
        name="Follow Surface",
        default=False,
        description="Use the nearest points of the surface instead of the curve's",
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
    ("REPLACE", "Replace", "Protect only this"),
    ("ADD", "Add", "Add this to the protected region"),
    ("SUBTRACT", "Subtract", "Remove this from the protected region"),
)
RELIEF = (
    ("RAISE", "Raise", "Raise light areas above the surface"),
    ("ENGRAVE", "Engrave", "Cut light areas into the surface"),
)


class ReliefSettings:
    """Shared by the panel's settings and the operator."""

    mode: EnumProperty(
        name="Mode", items=RELIEF, default="RAISE", description="Whether to raise or to engrave the picture"
    )
    depth: length("Depth", 1.0, "Height of white areas of the picture, in mm", 1e-4)
    width: length("Width", 40.0, "Width of the picture, in mm; its height follows", 1e-3)
    invert: BoolProperty(name="Invert", description="Make dark areas high, instead of light ones")
    follow: BoolProperty(
        name="Follow Surface",
        default=True,
        description="Measure heights from the sculpt's surface; off: from the picture's plane",
    )


class RifflerClay(ReliefSettings, bpy.types.PropertyGroup):
    pitch: length("Pitch", 0.25, "Distance between rays, in mm: the finest detail of the surface", 1e-4)
    room: length("Margin", 5.0, "Width added to the sculpt's box on every side, in mm", 1e-3)
    plane: PointerProperty(
        name="Plane", type=bpy.types.Object, description="Object whose local plane z = 0 cuts the sculpt"
    )
    form: PointerProperty(
        name="Form", type=bpy.types.Object, description="A mesh, or a curve whose closed splines go through the sculpt"
    )
    image: PointerProperty(name="Picture", type=bpy.types.Image, description="Picture whose brightness is the height")
    place: PointerProperty(
        name="Place",
        type=bpy.types.Object,
        description=(
            "Object whose local plane z = 0 holds the picture, centred at its origin and seen from its +z side"
        ),
    )


# ---------------------------------------------------------------------- results
class ResultSettings:
    """Shared by the panel's settings and the operator."""

    tolerance: length(
        "Tolerance", 0.01, "Largest distance that decimation may move the surface, in mm; 0: no decimation", 0.0
    )
    iterations: IntProperty(
        name="Smooth", default=0, min=0, max=200, description="Number of smoothing passes; edges stay sharp"
    )
    smooth_tolerance: length("Max Displacement", 0.02, "Largest distance that smoothing may move a vertex, in mm", 1e-5)
    hide_sculpt: BoolProperty(name="Hide Sculpt", default=True, description="Show the new mesh in the sculpt's place")


class RifflerResult(ResultSettings, bpy.types.PropertyGroup):
    reference: PointerProperty(
        name="Reference", type=bpy.types.Object, description="The surface that distances are measured from"
    )
    scale: length("Colour Range", 0.1, "Distance at which colours reach full strength, in mm", 1e-5)


# ---------------------------------------------------------------------- what a mesh keeps
class RifflerMesh(bpy.types.PropertyGroup):
    """On a sculpt's mesh: the image of its volume, and the panel's facts."""

    store: PointerProperty(type=bpy.types.Image)
    mm_per_unit: FloatProperty(default=1000.0)
    shown: IntVectorProperty(size=2)
    shown_of: StringProperty(description="Content id of the volume that the mesh was made from")
    shown_at: FloatVectorProperty(size=24)
    shown_crc: StringProperty()  # of all coordinates as displayed; files of older add-ons have none
    lower: FloatVectorProperty()
    upper: FloatVectorProperty()
    off_middle: FloatVectorProperty()  # from the centre of symmetry to the middle of the box, mm
    pitch: FloatProperty()
    directions: StringProperty()
    material: FloatProperty()
    nbytes: FloatProperty()
    cuts: IntProperty()
    moves: IntProperty()
    detail: EnumProperty(
        name="Triangles", items=DETAIL, default="NEEDED", description="The triangles that the sculpt's mesh has"
    )
    shown_within: FloatProperty(description="Largest distance from the mesh of all triangles, in mm; 0: it has all")
    all_triangles: IntProperty(description="Number of all triangles; 0 in files of older add-ons, which show all")
