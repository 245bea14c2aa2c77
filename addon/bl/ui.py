"""Where the layout API differs between versions."""

import bpy


def progress(layout, state):
    """A bar for `state.percent`."""
    if bpy.app.version >= (4, 0, 0):
        layout.progress(factor=state.percent / 100, text=f"{state.percent:.0f} %")
    else:  # no bar yet: a slider looks like one
        layout.prop(state, "percent", text="", slider=True)
