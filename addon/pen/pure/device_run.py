"""What the sessions of a device share between two polls, without Blender."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
import riffler

from .view_turn import ViewTurn


class DeviceRun:
    """Mixin: `device` is open, `session` is riffler's, and `state` that of the force as of the last frame."""

    device, session, state = None, None, "off"
    push = np.zeros((2, 3))  # N, N·mm about the tool's tip: on the tool, as of the last frame
    axes = None  # view_turn.ViewTurn; None: the device's axes are those of the tool's frame
    workspace: ClassVar[dict] = {}  # of riffler.Session.set_workspace, for a turn

    @property
    def running(self) -> bool:
        return self.session is not None and self.session.running

    @property
    def pushes(self) -> bool:
        """True if the device has motors, so that the hand feels something."""
        return any(axis.pushes for axis in self.device.limits.values())

    @property
    def gone(self) -> bool:
        """True while the device is not connected. It takes no steps then, and the last frame's force is not one."""
        return self.running and self.device.health().state in ("waiting", "connecting")

    @property
    def thread(self) -> str:
        """How the system runs the thread of a device with motors, and how to have it run better; otherwise ""."""
        if not self.running or not self.pushes:
            return ""
        granted = self.session.priority
        return " — ".join(filter(None, (f"Thread: {granted.text}", granted.remedy)))

    def turns_with(self, view: bool, options: dict) -> None:
        """Call it before the session is made, with its options. `view`: the device's axes follow a view (`turn`). A
        recording, and a pointer, have the frame of the tool."""
        self.workspace = {key: options[key] for key in ("scale", "pivot") if key in options}
        if view and not isinstance(self.device, riffler.pen.Pointer) and self.device.kind != "recording":
            self.axes = ViewTurn(self.device.kind)

    def turn(self, view: np.ndarray | None, to_frame: np.ndarray, touching: bool = False) -> None:
        """The view is now so, as blender/views.py has it; `to_frame`: world → the tool's frame. Takes effect between
        strokes (pen/pure/view_turn.py)."""
        if self.axes is None or view is None:
            return
        held = self.running and (touching or self.device.state().buttons != 0)
        turn = self.axes.follow(view, to_frame, held)
        if turn is not None and self.running:
            self.session.set_workspace(**self.workspace, turn=turn)

    @property
    def over(self) -> bool:
        """True when a recording has been played to its end."""
        return self.device.kind == "recording" and self.device.health().state == "stopped"

    def start(self) -> None:
        self.session.start()

    def look(self):
        """Takes what happened since the last call, and returns what the class takes from a frame."""
        taken = self._take(self.session.frame())
        self.heal()
        return taken

    def halt(self) -> str:
        """Stops the device's forces and the session. Returns the session's problem, or ""."""
        try:
            if self.running:
                self._take(self.session.stop())
        except RuntimeError as error:
            return str(error)
        finally:
            self.push = np.zeros((2, 3))
        return ""

    def close(self) -> None:
        self.device.stop()

    def heal(self) -> None:
        """Clears a trip of a simulated pen: its hand presses no button to confirm an error."""
        if self.state == "tripped" and self.device.kind == "simulated" and not self.device.state().fault:
            self.session.reset()

    def reason(self, frame) -> str:
        """Why the frame's session does not do what the hand wants, or ""."""
        health = self.device.health().problem if self.session.running else None
        cause = frame.cause if frame.state not in ("ready", "ramp", "active") else None
        return frame.problem or health or cause or ""

    @staticmethod
    def mean_push(frame) -> np.ndarray:
        """(2, 3): N and N·mm on the tool, the mean of a frame's steps."""
        return frame.tool_forces.mean(axis=0).reshape(2, 3)
