"""What is simulated and verified, and what was found."""

import bpy
from bpy.props import CollectionProperty, EnumProperty, IntProperty, PointerProperty, StringProperty

from ..blender.fields import length
from ..plan.machines import MACHINES
from ..plan.properties import RifflerFinding

SOURCES = (
    ("PLAN", "Plan", "The resolved paths of the active plan"),
    ("FILE", "NC File", "A program in a file"),
    ("CUTS", "Cuts", "What was cut from the stock by strokes and curves, from its full block"),
)
FRAMES = (
    ("WORLD", "Scene", "The program's zero is that of the scene: as a plan is written"),
    ("STOCK", "Stock", "The program's zero is that of the stock: as a sculpt's own cuts are written"),
)


class ProgramSettings:
    """Which program, on which stock: shared by the panel's settings and the operators."""

    source: EnumProperty(name="Program", items=SOURCES, default="PLAN", description="What moves the tool")
    filepath: StringProperty(name="File", subtype="FILE_PATH", description="NC code, or .rprog")
    machine: EnumProperty(name="Machine", items=MACHINES, default="tcp", description="That the NC code is read for")
    frame: EnumProperty(name="Zero", items=FRAMES, default="WORLD", description="Where a file's coordinates begin")


class GivenOptions:
    """Of operators, for scripts; people set the fields of the machine."""

    options: StringProperty(
        name="Options",
        options={"HIDDEN", "SKIP_SAVE"},
        description='Of the machine, as JSON: {"rot_point": [0, 0, -40]}; empty: the fields of the panel Machine',
    )


COLOURED = (
    ("PART", "Part", "At the part's own vertices: of a mesh that is fine enough"),
    ("LEFT", "What is Left", "A mesh of the stock after the program, at the stock's pitch"),
    ("NONE", "Nothing", "The findings only"),
)


class VerifySettings(ProgramSettings):
    gouge: length("Gouge", 0.05, "What is taken from the part deeper than this under its surface is one, in mm", 1e-4)
    rest: length("Rest", 0.0, "What stands higher on the part than this is a finding, in mm; 0: nothing is")
    coloured: EnumProperty(
        name="Colour", items=COLOURED, default="PART", description="By the distance between the part and what is left"
    )
    scale: length("Full at", 0.5, "Distance from which colours are full, in mm", 1e-5)


def _is_sculpt(_, ob):
    return ob.type == "MESH" and ob.data.riffler.store is not None


class RifflerVerify(VerifySettings, bpy.types.PropertyGroup):
    """On a scene."""

    stock: PointerProperty(
        name="Stock", type=bpy.types.Object, poll=_is_sculpt, description="The sculpt that the program begins with"
    )
    findings: CollectionProperty(type=RifflerFinding, description="What verifying the program has found")
    index: IntProperty(name="Finding", default=-1, description="The one that is chosen in the list, from 0")
    text: PointerProperty(type=bpy.types.Text, description="The NC code that the findings' lines are of")
    left: PointerProperty(type=bpy.types.Object, description="The mesh of what is left")
    hidden: StringProperty(description="Names of the objects that are hidden for it, one a line")
    said: StringProperty(description="The verdict; empty: nothing was verified")
