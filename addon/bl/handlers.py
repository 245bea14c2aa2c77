"""Application handlers.

Undo and redo need none: Blender brings back the mesh together with the content id of its volume, and the volume of that
id is in the cache or in the packed image that came back too.
"""

import bpy

from . import store


@bpy.app.handlers.persistent
def _on_load(*_):
    store.clear_cache()  # another file: the memory is worth more than what it held


def attach():
    bpy.app.handlers.load_post.append(_on_load)


def detach():
    if _on_load in bpy.app.handlers.load_post:
        bpy.app.handlers.load_post.remove(_on_load)
    store.clear_cache()
