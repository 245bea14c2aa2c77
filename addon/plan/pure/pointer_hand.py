"""A mouse, or the pen of a tablet, as the hand that holds a plan's tool: its events become poses of a device without
force.

The mouse drags the tool's end over a ball around the point of the path, from anywhere in the view. A pen that senses
its tilt stands on the screen: the tool leans as the pen does, and goes to the point of the path under it.
"""

from __future__ import annotations

import contextlib
import time

import numpy as np
import riffler

from ...common import glyphs
from ...sculpt.pure.stroke_path import leaning
from ...sculpt.pure.view_rays import ViewRays
from . import tool_rotation

SET, DELETE = 0, 1  # buttons, as bits
HELD = 0.02  # s that a button is held at least: the session samples it a thousand times a second


class PointerHand:
    """`device`: a riffler.pen.Pointer for riffler.OrientSession; it begins at a point of the path, with an axis.
    `slides`: whether it can leave that point."""

    def __init__(self, path, tool, index: int, axis, slides: bool = True):
        self.device = riffler.pen.Pointer("tablet")
        self.index, self.axis = index, np.asarray(axis, float)
        self._path, self._tool, self._slides = path, tool, slides
        self._tip = path.centres[index] - path.radius * self.axis
        self._ball = self._seen = None  # the tool's end on the ball, and the view and the point for which it is valid
        self._end = self._last = None  # pixels of the tool's end, and of the mouse
        self._buttons, self._since = 0, 0.0
        self._hold()

    def move(self, view: ViewRays, at, reach: float, tilt=None, along: bool = False) -> None:
        """The pointer is at pixels `at` of a view. `tilt`: of a pen that senses it, as in a Sample; None: a mouse.
        `along`: the mouse takes the tool along the path instead of turning it. `reach`: mm from the point to the tool's
        end."""
        if tilt is not None:
            self.axis = leaning(view.basis(), tilt)
        if self._slides and (along or tilt is not None):
            origin, away = view.ray(*at)
            self.index = self._path.nearest(origin, direction=away).index
            self.leave()
        elif tilt is None:
            self.axis = self._dragged(view, np.asarray(at, float), reach)
        self._hold()

    def leave(self) -> None:
        """The pointer leaves the view: wherever it comes back, the tool does not jump."""
        self._ball = None

    def _dragged(self, view, at, reach):
        """The axis after the mouse has moved the tool's end by as many pixels, up to the ball's edge."""
        centre, seen = self._path.centres[self.index], (view.matrix.tobytes(), self.index)
        if self._ball is None or self._seen != seen:
            (self._end,) = view.project([centre + reach * self.axis])
            self._ball = tool_rotation.Ball(centre, self.axis, reach, view.ray(*self._end))
            self._seen, self._last = seen, at
            return self.axis
        (middle,) = view.project([centre])
        off, most = self._end + at - self._last - middle, reach * view.pixels_per_unit(centre)
        self._end, self._last = middle + off * min(1.0, most / max(np.linalg.norm(off), 1e-9)), at
        return self._ball.move(view.ray(*self._end))

    def press(self, button: int) -> None:
        """SET or DELETE; `rest` releases it."""
        self._buttons |= 1 << button
        self._since = time.perf_counter()
        self._hold()

    def rest(self) -> None:
        """Call it about thirty times a second."""
        if self._buttons and time.perf_counter() - self._since > HELD:
            self._buttons = 0
            self._hold()

    def _hold(self):
        """Gives the device the tool's pose at the point, upright on a plane of its own."""
        with contextlib.suppress(
            ValueError
        ):  # the cutter does not touch there with this axis: the session keeps its own
            self._tip = tool_rotation.stand(self._path, self.index, self.axis, self._tool)[:3]
        right, up, _ = glyphs.frame(self.axis)
        self.device.set_frame(origin=self._tip, right=right, up=up, depth=0.0)
        self.device.give(0, 0, buttons=self._buttons, time=time.perf_counter())
