"""Measured error of a carve: random rays compared with the independent reference."""

from __future__ import annotations

from typing import Any

import numpy as np
from riffler import Tool, Volume

from . import _bench as core
from .measure import threads


def measured(volume: Volume, tool: Tool, poses: np.ndarray, tolerance: float, rays: int) -> dict[str, Any]:
    """Largest and RMS error in mm over the ends of `rays` rays a direction; how many ends graze; how many of the points
    compared lie on the wrong side. All threads: nothing is timed here."""
    with threads(None):
        result = core.sweep_errors(volume, tool, poses, tolerance, rays)
    error = result["error"]
    return {
        "max_mm": float(error.max(initial=0.0)),
        "rms_mm": float(np.sqrt(np.mean(error**2))) if len(error) else 0.0,
        "ends": len(error),
        "grazing": int(sum(result["grazes"])),
        "points": result["points"],
        "wrong": result["wrong"],
    }
