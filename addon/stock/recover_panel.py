"""Messages about sculpts that no operator reports: interrupted sessions, journals that cannot be written."""

from datetime import datetime

import bpy

from ..blender.panel_parts import Sidebar, lines, wrapped
from ..sculpt import live_registry, persistence
from . import recover


class RIFFLER_PT_recover(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_recover"
    bl_label = "Recovery"

    @classmethod
    def poll(cls, context):
        return bool(persistence.crashed() or context.window_manager.riffler.notice or _problems())

    def draw(self, context):
        layout, notice = self.layout, context.window_manager.riffler.notice
        if notice:
            box = layout.box()
            lines(box, *wrapped(context, notice), icon="INFO")
            box.operator(recover.RIFFLER_OT_dismiss.bl_idname)
        for name, problem in _problems():
            box = layout.box()
            lines(box, *wrapped(context, f"{name} has no journal: {problem}. Save the file often."), icon="ERROR")
        for found in persistence.crashed():
            box = layout.box()
            when = datetime.fromtimestamp(found.when)
            lines(box, found.name, f"Interrupted on {when:%d %b, %H:%M}", icon="RECOVER_LAST")
            row = box.row(align=True)
            for cls in (recover.RIFFLER_OT_recover, recover.RIFFLER_OT_discard_journal):
                row.operator(cls.bl_idname, text=cls.bl_label.split()[0]).journal = found.folder.name


def _problems():
    return [(run.name, run.persistence.problem) for run in live_registry.awake() if run.persistence.problem]


CLASSES = (RIFFLER_PT_recover,)
