"""How long Blender draws its 3D views while somebody sculpts: the stage "draw" of sculpt/pure/stages.py.

From before a view is drawn until after it, so what the processor does for a picture: a graphics card goes on by itself,
while a renderer in software is the processor.
"""

import time

from ..blender import views

_in_views = views.InViews()
_stages, _begun = None, 0.0


def begin(stages):
    """Into these from now on."""
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
