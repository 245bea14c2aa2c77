"""What new stock is made of, and what the mesh of a sculpt keeps."""

import bpy
from bpy.props import (
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from .fields import length

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
        name="Size", default=(100, 60, 30), min=0.001, max=1e5, precision=2, description="Block along x, y and z, in mm"
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
