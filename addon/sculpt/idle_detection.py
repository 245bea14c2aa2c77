"""Whether the artist still works at a live sculpt: called by the timer of sculpt/live_registry.py."""

import bpy

LOOK = 0.25  # s between two checks
AWAY = 0.5  # s of absence before the session ends

TOOLS = "riffler."  # prefix of the sculpt tools' names


def stays(ob):
    """Whether a window has the sculpt as its active object, with one of the sculpt tools active, or the curve of one of
    its kept strokes."""
    return any(_has(window, ob) for window in bpy.context.window_manager.windows)


def _has(window, ob):
    active = window.view_layer.objects.active
    if active is not None and active.type == "CURVE":
        return any(row.curve == active for row in ob.riffler.strokes.rows)
    if active != ob:
        return False
    tool = window.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    return tool is not None and tool.idname.startswith(TOOLS)


class IdleClock:
    """Measures how long one sculpt has been idle."""

    def __init__(self):
        self._since = None

    def long(self, here, now):
        """True if the sculpt has been idle for too long; `here`: whether it is in use now."""
        if here:
            self._since = None
        elif self._since is None:
            self._since = now
        return self._since is not None and now - self._since > AWAY
