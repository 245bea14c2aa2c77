"""Stores the calculated moves of a scene's job in a packed image, to which the scene points."""

import bpy

from ..blender import handlers, packed_images
from ..common.contents import ContentCache
from ..sculpt.pure import sculpt_payload
from .pure import operation_payload

CLASSES = ()
_cache = ContentCache(8)
_programs = {}  # the last checked program, by the key of its last operation


class _Kept:
    def __init__(self, operations, nbytes):
        self.operations, self.nbytes = operations, nbytes


def identity(scene):
    """The content id of the stored moves, or ""."""
    return packed_images.identity(scene.riffler.machining.store)


def operations(scene):
    """{key: riffler.plan.Operation} of the stored moves. ValueError if the data is damaged."""
    key = identity(scene)
    if not key:
        return {}
    kept = _cache.get(key)
    if kept is None:
        block = packed_images.read(scene.riffler.machining.store, "the job")
        if sculpt_payload.content_id(block) != key:
            raise ValueError(operation_payload.DAMAGED)
        kept = _Kept(dict(operation_payload.decode(block)), len(block))
        _cache.put(key, kept)
    return kept.operations


def write(scene, found):
    """Stores operations with their keys."""
    block = operation_payload.encode(found)
    settings, key = scene.riffler.machining, sculpt_payload.content_id(block)
    if settings.store is None or settings.store.library or _shared(scene):
        settings.store = packed_images.new(f"{scene.name} job")
    packed_images.write(settings.store, block, key)
    _cache.put(key, _Kept(dict(found), len(block)))


def _shared(scene):
    """True if a copy of the scene has the same image."""
    image = scene.riffler.machining.store
    return any(other != scene and other.riffler.machining.store == image for other in bpy.data.scenes)


def program(key):
    """The checked program whose last operation has this key, in the stock's frame, or None."""
    return _programs.get(key)


def keep_program(key, made):
    """Keeps the checked program whose last operation has this key. `made` None: forgets the program."""
    _programs.clear()
    if made is not None:
        _programs[key] = made


@bpy.app.handlers.persistent
def _on_load(*_):
    _cache.clear()
    _programs.clear()


_HANDLERS = {"load_post": _on_load}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    _cache.clear()
    _programs.clear()
