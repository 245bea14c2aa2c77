"""Measures the time that Blender takes to draw its 3D views during a stroke: the stage "draw" of sculpt/pure/stages.py.

The time runs from before a view is drawn until after it: the processor's share. A graphics card continues after that, a
software renderer does not.
"""

import time

from ..blender import views

_in_views = views.InViews()
_stages, _begun = None, 0.0


def begin(stages):
    """Adds measurements to these stages from now on."""
    global _stages
    end()
    _stages = stages
    for draw, when in ((_before, "PRE_VIEW"), (_after, "POST_PIXEL")):
        _in_views.add(draw, when)


def end():
    global _stages
    _stages = None
    _in_views.clear()


def _before():
    global _begun
    _begun = time.perf_counter()


def _after():
    if _stages is not None:
        _stages.add("draw", time.perf_counter() - _begun)
