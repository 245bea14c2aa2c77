"""What the sessions of a device share between two polls, without Blender."""

from __future__ import annotations

import numpy as np


class DeviceRun:
    """Mixin: `device` is open, `session` is riffler's, and `state` that of the force as of the last frame."""

    device, session, state = None, None, "off"

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
