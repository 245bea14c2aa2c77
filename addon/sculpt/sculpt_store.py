"""The sculpt's data inside the .blend: a packed image that the mesh points to.

The *mesh* owns it, so undo, copy, append and linked duplicates treat surface and volume as one thing, and it goes when
the mesh goes. A copy of a mesh shares the image until one of the two is written. Sculpts need no handler of undo and
redo: Blender restores the mesh together with the content id of its volume, and the volume of that id is in the cache or
in the packed image that was restored, too.
"""

import bpy
import riffler

from ..blender import handlers, packed_images
from ..common.contents import Content, ContentCache
from .pure import sculpt_payload

TOKEN = "riffler_token"  # on the image: the state of a live sculpt in it (sculpt/live_registry.py)
_cache = ContentCache()


def clear_cache():
    _cache.clear()


def identity(mesh):
    """The content id, or "" if the mesh is not a sculpt."""
    return packed_images.identity(mesh.riffler.store)


def content(mesh):
    """The mesh's volume and cuts. The volume is shared: copy it before changing it. ValueError if the data is
    damaged."""
    key = identity(mesh)
    if not key:
        raise ValueError(f"{mesh.name} is not a sculpt")
    found = _cache.get(key)
    if found is None:
        block, cuts, mask, shaped = sculpt_payload.decode(packed_images.read(mesh.riffler.store, "the sculpt"), key)
        protected = riffler.Volume.from_bytes(mask, name=f"{mesh.name}, mask") if len(mask) else None
        found = Content(riffler.Volume.from_bytes(block, name=mesh.name), cuts, protected, shaped)
        _cache.put(key, found)
    return found


def token(mesh):
    """The packed state of a live sculpt, or ""."""
    image = mesh.riffler.store
    return image.get(TOKEN, "") if image else ""


def mark_state(mesh, token):
    """Marks the packed data as the state `token`."""
    mesh.riffler.store[TOKEN] = token


def nbytes(mesh):
    """Size of the packed data."""
    file = mesh.riffler.store.packed_file
    return file.size if file else 0


def blocks(content):
    """The bytes of the volume and of the mask."""
    return content.volume.to_bytes(), content.mask.to_bytes() if content.mask is not None else b""


def write(mesh, content, token="", made=None):
    """Makes `content`, a live sculpt's state `token`, the mesh's; returns the bytes stored. It must not be changed
    afterwards. `made`: its blocks, if they are made already."""
    volume, mask = made or blocks(content)
    block = sculpt_payload.encode(volume, content.cuts, mask, content.shaped)
    key = sculpt_payload.content_id(block)
    image = mesh.riffler.store
    if image is None or image.library or _shared(mesh, image):
        image = mesh.riffler.store = packed_images.new(mesh.name)
    packed_images.write(image, block, key)
    image[TOKEN] = token
    _cache.put(key, content)
    return len(block)


def _shared(mesh, image):
    return any(m != mesh and m.riffler.store == image for m in bpy.data.meshes)


@bpy.app.handlers.persistent
def _on_load(*_):
    clear_cache()  # another file: frees the cache's memory


_HANDLERS = {"load_post": _on_load}
CLASSES = ()


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    clear_cache()
