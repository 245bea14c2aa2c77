"""What stands around a part, as plans take it: how fine a fixture's rays are, and a tool with room round its body."""

from __future__ import annotations

import numpy as np

from .._core import Mesh, Tool

PITCH = 0.5  # mm; fixtures are only to be stayed clear of
FINEST = 500  # rays along a fixture's largest side at most


def fixture_pitch(mesh: Mesh) -> float:
    """The pitch (mm) at which a fixture's mesh becomes a volume: 0.5, coarser from 250 mm on."""
    lower, upper = mesh.bounds
    return max(PITCH, float(np.max(upper - lower)) / FINEST)


def with_room(tool: Tool, room: float) -> Tool:
    """The tool with ``room`` (mm) more of shank and holder, those that it has, so that these keep clear by as much
    while the cutter touches what it cuts. The same tool where it has neither, or for no room."""
    wanted = {piece: room for piece in ("shank", "holder") if getattr(tool, piece)}
    return tool.with_margins(**wanted) if room > 0 and wanted else tool
