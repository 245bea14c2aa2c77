"""Where the layout API differs between versions."""

import bpy


def progress(layout, fraction, text):
    if bpy.app.version >= (4, 0, 0):
        layout.progress(factor=fraction, text=text)
        return
    # 3.x has no bar: a split row whose filled part is a pressed label
    row = layout.row()
    row.label(text=text, icon="TIME")
    row.label(text="█" * round(10 * fraction) + "░" * (10 - round(10 * fraction)))
