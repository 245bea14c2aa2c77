"""A report on this computer for support requests."""

import bpy
from riffler import pen
from riffler.command import doctor

from ..common import diagnosis
from . import operator_parts, preferences_access, versions

TEXT = "Riffler Doctor"

last = ""  # the newest report, for the preferences


def facts():
    """Pairs of facts that riffler's own report does not contain."""
    found = [("Blender", bpy.app.version_string + (" without a window" if bpy.app.background else ""))]
    found += [("graphics", card)] if (card := versions.graphics()) else []
    found.append(("add-on", preferences_access.ROOT))
    for name in ("journals", "tools"):
        try:
            found.append((name, diagnosis.folder(preferences_access.target(name))))
        except OSError as error:
            found.append((name, operator_parts.said(error)))
    return found


class RIFFLER_OT_doctor(bpy.types.Operator):
    """Check this computer, its folders and its devices, and copy a report to the clipboard and into a text of this
    file
    """

    bl_idname = "riffler.doctor"
    bl_label = "Copy Doctor Report"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return not operator_parts.busy(cls, context)  # a device that is in use must not be queried

    def execute(self, context):
        global last
        try:
            found = pen.devices()
            rows = doctor.rows(doctor.report(found), found)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        ours = facts()
        rows = [row for row in rows if row[0] not in dict(ours)]
        last = diagnosis.table("Riffler in Blender", [*rows, *ours])
        text = bpy.data.texts.get(TEXT) or bpy.data.texts.new(TEXT)
        text.clear()
        text.write(last)
        context.window_manager.clipboard = last
        self.report({"INFO"}, f"Copied to the clipboard and to the text {text.name!r}")
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_doctor,)


def detach():
    global last
    last = ""
