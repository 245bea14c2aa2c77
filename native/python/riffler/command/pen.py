"""Pens and other devices: what is plugged in, what it says, whether it is right, and one without hardware.

riffler pen list
riffler pen monitor
riffler pen calibrate
riffler pen simulate
"""

from __future__ import annotations

from . import pen_calibrate, pen_list, pen_monitor, pen_simulate

HELP = "pens and other devices: list, monitor, calibrate, simulate"
PARTS = (pen_list, pen_monitor, pen_calibrate, pen_simulate)
