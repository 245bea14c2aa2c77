"""The sculpt's data inside the .blend: a packed image that the mesh points to.

Of all datablocks that hold bytes, a packed image is the one that survives every version, undo, save and reopening
without being doubled or cut short. The *mesh* owns it, so undo, copy, append and linked duplicates treat surface and
volume as one thing, and it goes when the mesh goes. A copy of a mesh shares the image until one of the two is written.
"""

import bpy
import riffler

from ..core import record
from ..core.cache import Content, ContentCache

IDENTITY = "riffler_content"  # on the image: the hash of what is packed in it
_cache = ContentCache()


def clear_cache():
    _cache.clear()


def identity(mesh):
    """The content id, or "" where the mesh is no sculpt."""
    image = mesh.riffler.store
    return image.get(IDENTITY, "") if image else ""


def content(mesh):
    """The mesh's volume and cuts. The volume is shared: copy it before changing it. ValueError where the data is not
    what was written."""
    key = identity(mesh)
    if not key:
        raise ValueError(f"{mesh.name} is no sculpt")
    found = _cache.get(key)
    if found is None:
        block, cuts = record.decode(_packed(mesh.riffler.store), key)
        found = Content(riffler.Volume.from_bytes(block, mesh.name), cuts)
        _cache.put(key, found)
    return found


def write(mesh, volume, cuts):
    """Makes `volume` and `cuts` the mesh's content; returns the bytes kept. The volume must not be changed after it."""
    block = record.encode(volume.to_bytes(), cuts)
    key = record.content_id(block)
    image = mesh.riffler.store
    if image is None or image.library or _shared(mesh, image):
        # A name with a dot in front is not listed among images to choose from.
        image = bpy.data.images.new(f".riffler {mesh.name}", 1, 1)
        mesh.riffler.store = image
    image.pack(data=block, data_len=len(block))
    image[IDENTITY] = key
    _cache.put(key, Content(volume, list(cuts)))
    return len(block)


def _shared(mesh, image):
    return any(m != mesh and m.riffler.store == image for m in bpy.data.meshes)


def _packed(image):
    if image.packed_file:
        return bytes(image.packed_file.data)
    # File > External Data > Unpack wrote it to a file of its own.
    path = bpy.path.abspath(image.filepath, library=image.library)
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise ValueError(f"the sculpt's data is not in this .blend, and not at {path}: {error.strerror}") from error
