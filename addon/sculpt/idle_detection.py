"""Whether the artist is still at a live sculpt: asked by the timer that looks after them (sculpt/live_registry.py)."""

import bpy

LOOK = 0.25  # s from one look to the next
AWAY = 0.5  # s that somebody has to be away before the work ends

TOOLS = "riffler."  # how the names of the sculpt tools begin


def stays(ob):
    """Whether some window has the sculpt as its active object, with one of the sculpt tools at hand."""
    return any(_has(window, ob) for window in bpy.context.window_manager.windows)


def _has(window, ob):
    if window.view_layer.objects.active != ob:
        return False
    tool = window.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    return tool is not None and tool.idname.startswith(TOOLS)


class IdleClock:
    """How long nobody has been at one sculpt."""

    def __init__(self):
        self._since = None

    def long(self, here, now):
        """True where nobody has been for too long; `here` is whether somebody is now."""
        if here:
            self._since = None
        elif self._since is None:
            self._since = now
        return self._since is not None and now - self._since > AWAY
