"""Settings of the device and its feel, and the state of its session."""

import bpy
import riffler
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..blender.fields import length, stored_number

RECORDING = "recording"
ONE_OF_A_KIND = (RECORDING, "simulated")
DEVICES = tuple(
    (kind, kind.replace("-", " ").capitalize(), what, "NONE", stored_number(kind))
    for kind, what in {
        **riffler.pen.kinds(),
        RECORDING: "Recorded strokes, played back at their recorded speed",
    }.items()
)
PREFERRED = "preferred"
CHOICES = ((PREFERRED, "As in Preferences", "The device that Riffler's preferences name", "NONE", 0), *DEVICES)
STARTS = (
    ("ABOVE", "Above the Stock", "The tool stands upright above the middle of the stock, or part, at the start"),
    ("CURSOR", "3D Cursor", "The tool's tip stands upright at the 3D cursor when the session starts"),
)


AXES = (
    ("STOCK", "Fixed", "The device's axes are those of the stock, or of the scene for a plan"),
    ("VIEW", "View", "Right, up and away of the hand are those of the 3D view; they follow it between strokes"),
)

# A plan's tool is also turned by what the sculpt tools serve themselves.
POINTER = "pointer"
TURNING = (
    CHOICES[0],
    (
        POINTER,
        "Mouse or Tablet",
        "A tablet's pen leans the tool as it leans itself; the mouse drags the tool's end",
        "NONE",
        stored_number(POINTER),
    ),
    *DEVICES[:-1],
)

DEVICE = EnumProperty(name="Device", items=CHOICES, default=PREFERRED, description="Input device")
SCALE = length("Scale", 1.0, "Distance that the tool moves, per distance of the hand", 1e-3, 100.0)
PIVOT = length(
    "Pivot",
    0.0,
    "Distance from the tip to the point about which the hand turns the tool and feels its torque, in mm; 0: the tip",
    0.0,
    1000.0,
)
WHICH = StringProperty(
    name="Which",
    description="One of several devices of this kind: its number in riffler pen list, its serial number or a part of "
    "its name; empty: the first that opens",
)
TURN = EnumProperty(name="Axes", items=AXES, default="STOCK", description="How the hand's directions move the tool")
RECORDED = StringProperty(
    name="Recording", subtype="FILE_PATH", description="Recording (.rjournal) that plays as a device"
)
START = EnumProperty(
    name="Start", items=STARTS, default="ABOVE", description="Position of the tool when the session starts"
)
GAP = length("Gap", 1.0, "Distance from the top of the stock to the tool tip at the start, in mm", 0.0, 1e4)
TOUCH = BoolProperty(
    name="Touch the Stock",
    default=False,
    description="Keep the tool out of the stock while button 1 is up, and push the hand back with 1.5 N at most: "
    "force then acts without a button, also when a surface is traced",
)
STIFF = length("Stiffness", 1.0, "Stiffness of the coupling between hand and tool, in N/mm", 1e-3, 100.0)


class TurningDevice:
    """The device that turns a plan's tool."""

    device: EnumProperty(name="Device", items=TURNING, default=PREFERRED, description="What turns the tool")


class HandSettings:
    """How the hand leads a tool; the fields are those of PenSettings."""

    which: WHICH
    scale: SCALE
    axes: TURN
    pivot: PIVOT


class PenSettings:
    """Shared by the panel's settings and the operator."""

    device: DEVICE
    which: WHICH
    recording: RECORDED
    start: START
    gap: GAP
    scale: SCALE
    axes: TURN
    pivot: PIVOT
    touch: TOUCH
    stiffness: STIFF
    removal_constant: FloatProperty(
        name="Resistance",
        default=0.005,
        min=0.0,
        max=100.0,
        precision=4,
        step=0.1,
        description="Resistance of the material, in N per mm³ removed in a second",
    )
    record: BoolProperty(name="Record", default=False, description="Record every stroke in a journal")
    folder: StringProperty(
        name="Folder",
        subtype="DIR_PATH",
        default="//",
        description="Folder for the journal and the stock that it starts from",
    )


class TraceSettings:
    """Settings of a session that traces an exact surface."""

    device: DEVICE
    which: WHICH
    recording: RECORDED
    start: START
    gap: GAP
    scale: SCALE
    axes: TURN
    pivot: PIVOT
    touch: TOUCH
    stiffness: STIFF
    keep_trace: BoolProperty(
        name="Keep Trace",
        default=True,
        description="Make a curve of the points of the surface that the tool has touched, when the session ends",
    )


class RifflerPen(PenSettings, TraceSettings, bpy.types.PropertyGroup):
    pass


class PenProgress:
    """State of the running session, for the panel."""

    sculpting: BoolProperty()
    force: StringProperty()
    why: StringProperty()
    thread: StringProperty()  # how the system runs the thread of the forces
