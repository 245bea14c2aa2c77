"""The session of mouse or tablet with a plan: as that of a pen (plan/pen_orientation.py), without force."""

import numpy as np

from . import current_pose
from .pen_orientation import PenOrientation
from .pure import pointer_hand
from .pure.pointer_hand import PointerHand

BUTTONS = {"LEFTMOUSE": pointer_hand.SET, "RIGHTMOUSE": pointer_hand.DELETE}


class PointerOrientation(PenOrientation):
    """As PenOrientation, with a device of its own, which a modal operator gives the pointer's events."""

    help = "Click: set a key    Right-click: delete it    Ctrl: along the path    Esc: end"
    pen_help = "Touch: set a key    Right-click: delete it    Esc: end"

    def __init__(self, context, spot, near, options, ended=lambda: None):
        self.hand = PointerHand(spot.line, spot.plan.tool, spot.index, spot.axis, options["slide"])
        super().__init__(context, spot, near, self.hand.device, options, ended)
        self._tilts = False  # a pen that senses its tilt was seen

    def look(self):
        self.hand.rest()
        return super().look()

    def move(self, context, region, event):
        """An event of the pointer over a region of a 3D view."""
        view = current_pose.sight(context, region, region.data)
        at = np.array([event.mouse_x - region.x, event.mouse_y - region.y], float)
        tilt = event.tilt[0], -event.tilt[1]  # the second grows towards the user, down the view
        self._tilts = event.is_tablet and (self._tilts or any(tilt))  # an upright pen has no tilt, either
        if self._tilts:
            self.help = self.pen_help
        reach = current_pose.reach(context, view, self._line.centres[self.hand.index])
        self.hand.move(view, at, reach, tilt if self._tilts else None, along=event.ctrl)

    def press(self, kind):
        """A button, by its name in BUTTONS."""
        self.hand.press(BUTTONS[kind])
