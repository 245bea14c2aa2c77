"""Settings of simulation and verification, and the findings."""

import bpy
from bpy.props import CollectionProperty, EnumProperty, IntProperty, PointerProperty, StringProperty

from ..blender.fields import length
from ..plan.machines import MACHINES
from ..plan.properties import RifflerFinding
from ..sculpt import sculpts

SOURCES = (
    ("PLAN", "Plan", "The resolved paths of the active plan"),
    ("FILE", "NC File", "A program in a file"),
    ("CUTS", "Cuts", "The cuts made on the stock by strokes and curves, from its full block"),
    ("JOB", "Job", "The calculated operations of the job, on the job's stock"),
)
FRAMES = (
    ("WORLD", "Scene", "The program's zero is the scene's, as in the NC code of a plan"),
    ("STOCK", "Stock", "The program's zero is the stock's, as in the NC code of a sculpt's own cuts"),
)


class ProgramSettings:
    """The program and its stock: shared by the panel's settings and the operators."""

    source: EnumProperty(name="Program", items=SOURCES, default="PLAN", description="Program that moves the tool")
    filepath: StringProperty(name="File", subtype="FILE_PATH", description="NC code, or .rprog")
    machine: EnumProperty(
        name="Machine", items=MACHINES, default="tcp", description="Machine that the NC code is read for"
    )
    frame: EnumProperty(name="Zero", items=FRAMES, default="WORLD", description="Zero of the file's coordinates")


class GivenOptions:
    """Options as JSON, for scripts; the panel has fields of the machine instead."""

    options: StringProperty(
        name="Options",
        options={"HIDDEN", "SKIP_SAVE"},
        description='Options of the machine as JSON: {"rot_point": [0, 0, -40]}; empty: those of the panel Machine',
    )


COLOURED = (
    ("PART", "Part", "At the part's own vertices: of a mesh that is fine enough"),
    ("LEFT", "Remaining Stock", "A mesh of the stock after the program, at the stock's pitch"),
    ("LINE", "Program Lines", "The remaining stock by the lines that cut it, from blue for the first to yellow"),
    ("TOOL", "Tools", "The remaining stock by the tools that cut it"),
    ("NONE", "Nothing", "The findings only"),
)


class VerifySettings(ProgramSettings):
    gouge: length("Gouge", 0.05, "Depth below the part's surface beyond which a cut is a gouge, in mm", 1e-4)
    rest: length(
        "Rest", 0.0, "Height above the part's surface beyond which rest material is a finding, in mm; 0: never"
    )
    coloured: EnumProperty(
        name="Colour",
        items=COLOURED,
        default="PART",
        description="What to colour, by the distance between the part and the remaining material or by what cut it",
    )
    scale: length("Colour Range", 0.5, "Distance at which colours reach full strength, in mm", 1e-5)


def _is_sculpt(_, ob):
    return sculpts.is_sculpt(ob)


class RifflerVerify(VerifySettings, bpy.types.PropertyGroup):
    """On a scene."""

    stock: PointerProperty(
        name="Stock", type=bpy.types.Object, poll=_is_sculpt, description="The sculpt that the program begins with"
    )
    findings: CollectionProperty(type=RifflerFinding, description="Findings of verifying the program")
    index: IntProperty(name="Finding", default=-1, description="Selected finding in the list, from 0")
    text: PointerProperty(type=bpy.types.Text, description="NC code that the findings' line numbers refer to")
    left: PointerProperty(type=bpy.types.Object, description="The mesh of what is left")
    hidden: StringProperty(description="Names of the objects hidden for the colours, one per line")
    said: StringProperty(description="The verdict; empty: nothing was verified")
