"""The add-on's preferences: settings of the computer and its user, not of a file."""

import bpy
import riffler
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from . import keymaps
from .blender import doctor, preferences_access
from .common import diagnosis
from .pen import properties as pen_properties
from .translations import local

HID = (
    "Pens and SpaceMouse pucks are HID devices, for which Blender has no permission setting. "
    "Riffler opens a device only while a session runs, and reads the names of known devices for"
    " the report below. If the system refuses access, the report has the line that grants it, "
    "and the file for that line."
)
SERVICES = (
    "Haply's Inverse3 is reached through its maker's service on this computer (127.0.0.1), never through the internet."
)
SPACEMOUSE = (
    "Blender also reads the SpaceMouse: the view may turn while you sculpt. Preferences > Input"
    " > NDOF sets what Blender does with it."
)


def _use_threads(self, _):
    riffler.set_threads(self.threads or None)


def _made_absolute(name):
    """Makes a relative folder absolute: Blender may choose one relative to the open file, but preferences hold for all
    files."""

    def update(self, _):
        text = getattr(self, name)
        if text.startswith("//"):
            setattr(self, name, bpy.path.abspath(text))

    return update


def _folder(name, label, description):
    return StringProperty(name=label, subtype="DIR_PATH", description=description, update=_made_absolute(name))


class RifflerPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    device: EnumProperty(
        name="Device",
        items=[d for d in pen_properties.DEVICES if d[0] != pen_properties.RECORDING],
        default="simulated",
        description="Input device of scenes that do not choose another",
    )
    force: FloatProperty(
        name="Force Limit (N)",
        default=5.0,
        min=0.0,
        max=20.0,
        precision=1,
        step=10,
        description="Largest value that a session passes on to the hand, even if the device can give more; 0: none",
    )
    torque: FloatProperty(
        name="Torque Limit (N·mm)",
        default=300.0,
        min=0.0,
        max=1200.0,
        precision=0,
        step=1000,
        description="Largest value that a session passes on to the hand, even if the device can give more; 0: none",
    )
    power: FloatProperty(
        name="Power Limit (W)",
        default=2.0,
        min=0.0,
        max=20.0,
        precision=1,
        step=10,
        description="Largest power that a session gives to the moving hand; 0: none",
    )
    threads: IntProperty(
        name="Threads",
        default=0,
        min=0,
        max=256,
        update=_use_threads,
        description="Number of threads for long calculations, which does not change results; 0: one per processor",
    )
    journals: _folder(
        "journals",
        "Journals",
        ("Folder of the journals, which keep strokes for recovery until the file is saved; empty: the folder below"),
    )
    tools: _folder("tools", "Tools", "Folder of tool files, for instance a shared one; empty: the folder below")

    cad_python: StringProperty(
        name="Python for CAD Files",
        subtype="FILE_PATH",
        description="Python with the package cadquery-ocp-novtk, to read STEP, IGES and BREP files; empty: search",
        update=_made_absolute("cad_python"),
    )

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        width = max(40, int(context.region.width / (7.2 * context.preferences.system.ui_scale)) - 12)
        self._device(layout, width)
        self._machine(layout)
        keymaps.draw(layout.column(), context)
        self._report(layout, width)

    def _device(self, layout, width):
        column = layout.column()
        column.prop(self, "device")
        most = column.column(align=True)
        for name in ("force", "torque", "power"):
            most.prop(self, name)
        notes = column.column(align=True)
        notes.scale_y = 0.8
        for text in (local(HID), local(SERVICES), local(SPACEMOUSE)):
            for k, line in enumerate(diagnosis.wrap(text, width)):
                notes.label(text=line, icon="INFO" if k == 0 else "BLANK1")

    def _machine(self, layout):
        column = layout.column()
        column.prop(self, "threads")
        column.prop(self, "cad_python")
        for name in ("journals", "tools"):
            column.prop(self, name)
            row = column.split(factor=0.4)
            row.label(text="")
            try:
                there = preferences_access.target(name)
            except FileNotFoundError as error:
                row.label(text=str(error), icon="ERROR")
            else:
                row.label(text=str(there), icon="FILE_FOLDER")

    def _report(self, layout, width):
        layout.operator(doctor.RIFFLER_OT_doctor.bl_idname, icon="COPYDOWN")
        if doctor.last:
            box = layout.box().column(align=True)
            box.scale_y = 0.8
            for entry in doctor.last.splitlines():
                for k, line in enumerate(diagnosis.wrap(entry, width)):
                    box.label(text=line if k == 0 else f"   {line}")


CLASSES = (RifflerPreferences,)


def attach():
    found = preferences_access.preferences()
    if found is not None:
        _use_threads(found, None)


def detach():
    riffler.set_threads(None)
