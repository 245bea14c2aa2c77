"""Fixtures and margins of plans: the pitch of a fixture, and a tool with room around its body."""

from __future__ import annotations

import numpy as np

from .._core import Mesh, Tool

PITCH = 0.5  # mm; coarse, because tools only have to stay clear of fixtures
FINEST = 500  # largest number of rays along a fixture's longest side


def fixture_pitch(mesh: Mesh) -> float:
    """The pitch at which a fixture's mesh becomes a volume: 0.5 mm, coarser from 250 mm on.

    Parameters
    ----------
    mesh : Mesh
        The fixture.

    Returns
    -------
    float
        The pitch, mm.

    Examples
    --------
    >>> riffler.plan.fixture_pitch(riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10))
    0.5
    """
    lower, upper = mesh.bounds
    return max(PITCH, float(np.max(upper - lower)) / FINEST)


def with_room(tool: Tool, room: float) -> Tool:
    """The tool with a larger shank and holder, so that these keep clear while the cutter touches the part.

    Parameters
    ----------
    tool : Tool
        Cutter, with shank and holder or without.
    room : float
        Distance to keep, mm.

    Returns
    -------
    Tool
        The same tool if it has neither, or if the room is 0.

    Examples
    --------
    >>> ball = riffler.Tool.ball(diameter=4, length=20)
    >>> riffler.plan.with_room(ball, 2.0) is ball
    True
    """
    wanted = {piece: room for piece in ("shank", "holder") if getattr(tool, piece)}
    return tool.with_margins(**wanted) if room > 0 and wanted else tool
